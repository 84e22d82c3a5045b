// EXT_meshopt_compression: https://github.com/KhronosGroup/glTF/tree/main/extensions/2.0/Vendor/EXT_meshopt_compression

#include "scene/gltf_meshopt.h"

#include "scene/gltf_buffers.h"
#include "scene/gltf_document.h"
#include "scene/input_file.h"

#include <fmt/format.h>
#include <meshoptimizer.h>
#include <tiny_gltf.h>

#include <span>
#include <vector>

namespace lambert {

namespace {

/// No mode makes more of a byte: a group of 16 vertices takes at least 2 bits for each byte of a vertex.
constexpr std::size_t kLargestRatio = 64;

struct Compressed {
    std::string place; //!< JSON path of the extension
    std::string mode, filter;
    std::size_t count = 0, stride = 0;
    std::span<const unsigned char> bytes;
};

std::string textOf(const tinygltf::Value& extension, const char* member, const char* missing) {
    return extension.Has(member) ? extension.Get(member).Get<std::string>() : missing;
}

/// The filters' stride and what the decoders only assert.
void checkStride(const std::string& file, const Compressed& source) {
    const auto require = [&](bool holds, const char* allowed) {
        if (!holds) failAtMember(file, source.place + "/byteStride", std::to_string(source.stride), allowed);
    };
    if (source.mode != "ATTRIBUTES") {
        require(source.stride == 2 || source.stride == 4, "2 or 4 for indices");
        return;
    }
    require(source.stride >= 4 && source.stride <= 256 && source.stride % 4 == 0, "a multiple of 4 from 4 to 256");
    if (source.filter == "OCTAHEDRAL") require(source.stride <= 8, "4 or 8 for OCTAHEDRAL");
    if (source.filter == "QUATERNION") require(source.stride == 8, "8 for QUATERNION");
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
    const std::size_t most = kLargestRatio * source.bytes.size() / source.stride;
    if (source.count > most)
        failAtMember(file, source.place + "/count", std::to_string(source.count),
                     fmt::format("at most {}, what {} bytes can hold", most, source.bytes.size()));
    if (source.mode == "TRIANGLES" && source.count % 3 != 0)
        failAtMember(file, source.place + "/count", std::to_string(source.count), "a multiple of 3 for TRIANGLES");
}

std::vector<unsigned char> decompressed(const std::string& file, const Compressed& source) {
    checkSizes(file, source);
    std::vector<unsigned char> result(source.count * source.stride);
    int error = 0;
    if (source.mode == "ATTRIBUTES") {
        error = meshopt_decodeVertexBuffer(result.data(), source.count, source.stride, source.bytes.data(),
                                           source.bytes.size());
    } else if (source.mode == "TRIANGLES") {
        error = meshopt_decodeIndexBuffer(result.data(), source.count, source.stride, source.bytes.data(),
                                          source.bytes.size());
    } else {
        error = meshopt_decodeIndexSequence(result.data(), source.count, source.stride, source.bytes.data(),
                                            source.bytes.size());
    }
    if (error != 0)
        failAtMember(file, source.place, fmt::format("data that cannot be decompressed (error {})", error),
                     fmt::format("{} elements compressed as {}", source.count, source.mode));
    if (source.filter == "OCTAHEDRAL") meshopt_decodeFilterOct(result.data(), source.count, source.stride);
    if (source.filter == "QUATERNION") meshopt_decodeFilterQuat(result.data(), source.count, source.stride);
    if (source.filter == "EXPONENTIAL") meshopt_decodeFilterExp(result.data(), source.count, source.stride);
    return result;
}

} // namespace

void decompressMeshopt(const std::string& file, tinygltf::Model& model) {
    const std::size_t views = model.bufferViews.size();
    for (std::size_t k = 0; k < views; ++k) {
        const tinygltf::BufferView& view = model.bufferViews[k];
        const char* name = "EXT_meshopt_compression";
        const tinygltf::Value* extension = gltfExtension(view, name);
        if (extension == nullptr) extension = gltfExtension(view, name = "KHR_meshopt_compression");
        if (extension == nullptr) continue;

        Compressed source;
        source.place = fmt::format("/bufferViews/{}/extensions/{}", k, name);
        source.mode = textOf(*extension, "mode", "");
        source.filter = textOf(*extension, "filter", "NONE");
        source.count = gltfSize(*extension, "count");
        source.stride = gltfSize(*extension, "byteStride");
        source.bytes = gltfBytes(file, model, extension->Get("buffer").Get<int>(), gltfSize(*extension, "byteOffset"),
                                 gltfSize(*extension, "byteLength"), source.place);
        std::vector<unsigned char> bytes = decompressed(file, source);

        const std::size_t stride = view.byteStride;
        const auto added = static_cast<std::size_t>(addGltfView(model, std::move(bytes)));
        model.bufferViews[k] = model.bufferViews[added];
        model.bufferViews[k].byteStride = stride;
    }
}

} // namespace lambert
