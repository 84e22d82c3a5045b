#pragma once

#include "core/byte_writer.h"

#include <nlohmann/json.hpp>

#include <cstdint>
#include <functional>
#include <ostream>
#include <string>
#include <vector>

namespace lambert {

/// A glTF 2.0 asset with one buffer that is never in memory whole: what an accessor holds is computed while the file is
/// written. Every accessor has its own buffer view.
class GltfWriter {
public:
    using Json = nlohmann::ordered_json;
    /// Puts all elements of an accessor; called once, by `write`.
    using Content = std::function<void(ByteWriter&)>;
    enum class Target { None = 0, Vertices = 34962, Indices = 34963 }; ///< of buffer views

    /// `version` is Lambert's, which is named as the generator.
    explicit GltfWriter(const std::string& version);

    /// All but accessors, buffer views and the buffer.
    Json& document() { return document_; }

    // Each returns the accessor's index.
    std::size_t addVectors(std::size_t count, Content content, Target target = Target::None); //!< of three floats
    std::size_t addNumbers(std::size_t count, Content content);                               //!< floats
    std::size_t addIndices(std::size_t count, Content content, Target target = Target::None); //!< 32 bits, unsigned
    /// Of a positions' accessor, which must have them.
    void setBounds(std::size_t accessor, const glm::vec3& lower, const glm::vec3& upper);

    /// One node at `place` (metres) with one mesh of these primitives, if there are any.
    void addScene(Json primitives, const glm::dvec3& place);

    /// A GLB container if `binary`, else JSON with the buffer as a data URI (for which it is in memory after all). Throws
    /// SystemError with `file` above 2^32 bytes, and what contents throw.
    void write(std::ostream& stream, bool binary, const std::string& file);

private:
    std::size_t add(std::size_t count, std::size_t elementBytes, Json accessor, Content content, Target target);
    void putContents(std::ostream& stream) const;

    Json document_;
    std::vector<Content> contents_;
    std::uint64_t bytes_ = 0; ///< of the buffer
};

} // namespace lambert
