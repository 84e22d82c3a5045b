#include "scene/gltf/writer.h"

#include "core/data_uri.h"
#include "core/error.h"

#include <fmt/format.h>

#include <initializer_list>
#include <limits>
#include <sstream>
#include <utility>

namespace lambert {

namespace {

constexpr int kFloat = 5126, kUnsignedInt = 5125; ///< component types

/// Four characters as the word that marks a GLB or one of its chunks.
constexpr std::uint32_t mark(const char (&name)[5]) {
    std::uint32_t word = 0;
    for (unsigned k = 0; k < 4; ++k) word |= static_cast<std::uint32_t>(static_cast<unsigned char>(name[k])) << 8 * k;
    return word;
}
constexpr std::uint32_t kBinaryChunk = 0x004E4942; ///< "BIN" and a zero

} // namespace

GltfWriter::GltfWriter(const std::string& version) {
    document_["asset"] = {{"version", "2.0"}, {"generator", version.empty() ? "Lambert" : "Lambert " + version}};
}

std::size_t GltfWriter::addVectors(std::size_t count, Content content, Target target) {
    return add(count, 12, {{"componentType", kFloat}, {"type", "VEC3"}}, std::move(content), target);
}

std::size_t GltfWriter::addNumbers(std::size_t count, Content content) {
    return add(count, 4, {{"componentType", kFloat}, {"type", "SCALAR"}}, std::move(content), Target::None);
}

std::size_t GltfWriter::addIndices(std::size_t count, Content content, Target target) {
    return add(count, 4, {{"componentType", kUnsignedInt}, {"type", "SCALAR"}}, std::move(content), target);
}

std::size_t GltfWriter::add(std::size_t count, std::size_t elementBytes, Json accessor, Content content,
                            Target target) {
    Json view = {{"buffer", 0}, {"byteOffset", bytes_}, {"byteLength", count * elementBytes}};
    if (target != Target::None) view["target"] = static_cast<int>(target);
    bytes_ += count * elementBytes;
    accessor["bufferView"] = contents_.size();
    accessor["count"] = count;
    document_["bufferViews"].push_back(std::move(view));
    document_["accessors"].push_back(std::move(accessor));
    contents_.push_back(std::move(content));
    return contents_.size() - 1;
}

void GltfWriter::setBounds(std::size_t accessor, const glm::vec3& lower, const glm::vec3& upper) {
    const auto json = [](const glm::vec3& v) {
        return Json::array({v.x + 0.0F, v.y + 0.0F, v.z + 0.0F}); // no negative zeros
    };
    document_["accessors"][accessor]["min"] = json(lower);
    document_["accessors"][accessor]["max"] = json(upper);
}

void GltfWriter::addScene(Json primitives, const glm::dvec3& place) {
    if (primitives.empty()) return;
    document_["meshes"] = Json::array({{{"primitives", std::move(primitives)}}});
    Json node = {{"mesh", 0}};
    if (place != glm::dvec3(0.0)) node["translation"] = Json::array({place.x, place.y, place.z});
    document_["nodes"] = Json::array({std::move(node)});
    document_["scenes"] = Json::array({{{"nodes", Json::array({0})}}});
    document_["scene"] = 0;
}

void GltfWriter::putContents(std::ostream& stream) const {
    ByteWriter out(stream);
    for (const Content& content : contents_) content(out);
}

void GltfWriter::write(std::ostream& stream, bool binary, const std::string& file) {
    if (bytes_ > 0) document_["buffers"] = Json::array({{{"byteLength", bytes_}}});
    std::string text = binary ? document_.dump() : std::string();
    text.resize((text.size() + 3) / 4 * 4, ' ');
    const std::uint64_t total = 12 + 8 + text.size() + (bytes_ > 0 ? 8 + bytes_ : 0);
    if (total > std::numeric_limits<std::uint32_t>::max())
        throw SystemError(
            fmt::format("{}: not written: glTF files end at 4294967295 bytes, and this one needs {}", file, total));
    if (!binary) {
        if (bytes_ > 0) {
            std::ostringstream buffer;
            putContents(buffer);
            document_["buffers"][0]["uri"] = dataUri("application/octet-stream", buffer.view());
        }
        stream << document_.dump(2) << '\n';
        return;
    }
    const auto put = [&](std::initializer_list<std::uint64_t> words) {
        ByteWriter out(stream);
        for (const std::uint64_t word : words) out.put(static_cast<std::uint32_t>(word));
    };
    put({mark("glTF"), 2, total, text.size(), mark("JSON")});
    stream << text;
    if (bytes_ == 0) return;
    put({bytes_, kBinaryChunk});
    putContents(stream);
}

} // namespace lambert
