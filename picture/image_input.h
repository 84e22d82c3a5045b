#pragma once

#include "core/memory_file.h"
#include "picture/image_module.h"

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace lambert {

/// An image file that is read some rows at a time: a header that promises more than the file holds costs no memory.
class ImageInput {
public:
    /// Opens a file. `mostPixels`: a power of 2. Throws InputError with one reason, which does not name the file, if it is
    /// missing, of a format unknown or refused (see refuseHostileImage), of no or too many pixels, of more than 64 channels, or
    /// not flat.
    ImageInput(const std::filesystem::path& path, std::uint64_t mostPixels);
    /// Opens a file's content, PNG or JPEG, as inside a scene. Throws SystemError also, if there is no memory for it.
    ImageInput(std::span<const std::uint8_t> content, std::uint64_t mostPixels);

    const ImageHeader& header() const;

    /// Calls `use(pixels, values)` for some rows after the other, from the top: with `pixels` times `header().channels` values,
    /// as ImageDecoder::read gives them. Throws InputError where the file is broken.
    template <typename Value, typename Use>
    void forRows(Use&& use) {
        const ImageHeader& h = header();
        std::vector<Value> buffer;
        for (int row = 0; row < h.height; row += rowsAtOnce()) {
            const int rows = std::min(rowsAtOnce(), h.height - row);
            const auto pixels = static_cast<std::size_t>(h.width) * static_cast<std::size_t>(rows);
            buffer.resize(pixels * static_cast<std::size_t>(h.channels));
            readRows(row, rows, buffer.data());
            use(pixels, buffer);
        }
    }

private:
    void open(const std::string& format, std::uint64_t mostPixels);
    int rowsAtOnce() const;
    template <typename Value>
    void readRows(int first, int rows, Value* values);

    std::unique_ptr<MemoryFile> memory_; //!< what `file_` names, if it lies in memory; Debian's OpenImageIO reads JPEG only by name
    std::string file_;
    std::unique_ptr<ImageDecoder> decoder_;
};

} // namespace lambert
