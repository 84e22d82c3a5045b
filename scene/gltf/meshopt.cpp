// EXT_meshopt_compression: https://github.com/KhronosGroup/glTF/tree/main/extensions/2.0/Vendor/EXT_meshopt_compression

#include "scene/gltf/meshopt.h"

#include "core/text.h"
#include "scene/gltf/buffers.h"
#include "scene/gltf/document.h"

#include <fmt/format.h>
#include <meshoptimizer.h>

#include <span>
#include <vector>

namespace lambert {

namespace {

/// No mode makes more of a byte: a group of 16 vertices takes at least 2 bits for each byte of a vertex.
constexpr std::size_t kLargestRatio = 64;

struct Compressed : gltf::Meshopt {
    std::string place; //!< JSON path of the extension
    std::span<const unsigned char> bytes;
};

/// The filters' stride and what the decoders only assert.
void checkStride(const std::string& file, const Compressed& source) {
    const auto require = [&](bool holds, const char* allowed) {
        if (!holds) failAtMember(file, source.place + "/byteStride", std::to_string(source.byteStride), allowed);
    };
    if (source.mode != "ATTRIBUTES") {
        require(source.byteStride == 2 || source.byteStride == 4, "2 or 4 for indices");
        return;
    }
    require(source.byteStride >= 4 && source.byteStride <= 256 && source.byteStride % 4 == 0,
            "a multiple of 4 from 4 to 256");
    if (source.filter == "OCTAHEDRAL") require(source.byteStride <= 8, "4 or 8 for OCTAHEDRAL");
    if (source.filter == "QUATERNION") require(source.byteStride == 8, "8 for QUATERNION");
}

void checkSizes(const std::string& file, const Compressed& source) {
    if (source.mode != "ATTRIBUTES" && source.mode != "TRIANGLES" && source.mode != "INDICES")
        failAtMember(file, source.place + "/mode", inQuotes(source.mode), "ATTRIBUTES, TRIANGLES or INDICES");
    const bool isFilter = source.filter == "OCTAHEDRAL" || source.filter == "QUATERNION" ||
                          source.filter == "EXPONENTIAL" || source.filter == "NONE";
    if (!isFilter || (source.filter != "NONE" && source.mode != "ATTRIBUTES"))
        failAtMember(file, source.place + "/filter", inQuotes(source.filter),
                     "NONE, or for ATTRIBUTES also OCTAHEDRAL, QUATERNION or EXPONENTIAL");
    checkStride(file, source);
    const std::size_t most = kLargestRatio * source.bytes.size() / source.byteStride;
    if (source.count > most)
        failAtMember(file, source.place + "/count", std::to_string(source.count),
                     fmt::format("at most {}, what {} bytes can hold", most, source.bytes.size()));
    if (source.mode == "TRIANGLES" && source.count % 3 != 0)
        failAtMember(file, source.place + "/count", std::to_string(source.count), "a multiple of 3 for TRIANGLES");
}

std::vector<unsigned char> decompressed(const std::string& file, const Compressed& source) {
    checkSizes(file, source);
    std::vector<unsigned char> result(source.count * source.byteStride);
    int error = 0;
    if (source.mode == "ATTRIBUTES") {
        error = meshopt_decodeVertexBuffer(result.data(), source.count, source.byteStride, source.bytes.data(),
                                           source.bytes.size());
    } else if (source.mode == "TRIANGLES") {
        error = meshopt_decodeIndexBuffer(result.data(), source.count, source.byteStride, source.bytes.data(),
                                          source.bytes.size());
    } else {
        error = meshopt_decodeIndexSequence(result.data(), source.count, source.byteStride, source.bytes.data(),
                                            source.bytes.size());
    }
    if (error != 0)
        failAtMember(file, source.place, fmt::format("data that cannot be decompressed (error {})", error),
                     fmt::format("{} elements compressed as {}", source.count, source.mode));
    if (source.filter == "OCTAHEDRAL") meshopt_decodeFilterOct(result.data(), source.count, source.byteStride);
    if (source.filter == "QUATERNION") meshopt_decodeFilterQuat(result.data(), source.count, source.byteStride);
    if (source.filter == "EXPONENTIAL") meshopt_decodeFilterExp(result.data(), source.count, source.byteStride);
    return result;
}

} // namespace

void decompressMeshopt(const std::string& file, gltf::Model& model) {
    for (std::size_t k = 0; k < model.bufferViews.size(); ++k) {
        gltf::BufferView& view = model.bufferViews[k];
        if (!view.meshopt) continue;
        Compressed source{*view.meshopt, fmt::format("/bufferViews/{}/extensions/{}", k, view.meshopt->extension), {}};
        source.bytes = gltfBytes(file, model, source.buffer, source.byteOffset, source.byteLength, source.place);
        std::vector<unsigned char> bytes = decompressed(file, source);
        view = {.buffer = static_cast<int>(model.buffers.size()),
                .byteLength = bytes.size(),
                .byteStride = view.byteStride};
        model.buffers.push_back(std::move(bytes));
    }
}

} // namespace lambert
