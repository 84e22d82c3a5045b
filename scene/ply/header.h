#pragma once

#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace lambert {

/// How a PLY file writes a number.
enum class PlyType : std::uint8_t { Int8, Uint8, Int16, Uint16, Int32, Uint32, Float32, Float64 };

std::size_t sizeInBytes(PlyType type);
inline bool isInteger(PlyType type) { return type < PlyType::Float32; }

struct PlyProperty {
    std::string name;
    PlyType type = PlyType::Float32;  //!< of the number, or of a list's entries
    std::optional<PlyType> countType; //!< of a list's length; none: one number
};

/// A table of the file: `count` records that have the same properties.
struct PlyElement {
    std::string name;
    std::uint64_t count = 0;
    std::vector<PlyProperty> properties;
    std::size_t line = 0; //!< of the header, from 1

    /// The property, one number or a list, that has the first of these names that exists.
    std::optional<std::size_t> findNumber(std::initializer_list<std::string_view> names) const;
    std::optional<std::size_t> findList(std::initializer_list<std::string_view> names) const;
};

enum class PlyFormat : std::uint8_t { Ascii, BinaryLittleEndian, BinaryBigEndian };

struct PlyHeader {
    PlyFormat format = PlyFormat::Ascii;
    std::vector<PlyElement> elements;      //!< in the file's order
    std::vector<std::string> textureFiles; //!< of the comments `TextureFile`, as MeshLab writes them
    std::size_t bytes = 0;                 //!< with the end of its last line
    std::size_t lines = 0;

    const PlyElement* element(std::string_view name) const; //!< null: there is none
};

/// Reads the header of a PLY file's `content`. Throws InputError with `file` and line if it is malformed, or promises more
/// records than the file has bytes for.
PlyHeader parsePlyHeader(const std::string& file, std::string_view content);

} // namespace lambert
