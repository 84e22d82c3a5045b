#include "scene/gltf/buffers.h"

#include "core/error.h"
#include "core/input_file.h"
#include "core/text.h"
#include "scene/gltf/document.h"
#include "scene/gltf/uri.h"
#include "scene/named_file.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace lambert {

namespace {

using nlohmann::json;

/// A buffer whose views are all compressed has no data of its own.
bool isFallback(const json& buffer) {
    for (const char* name : {"EXT_meshopt_compression", "KHR_meshopt_compression"}) {
        const json::json_pointer pointer(fmt::format("/extensions/{}/fallback", name));
        if (buffer.contains(pointer) && buffer[pointer] == true) return true;
    }
    return false;
}

std::vector<unsigned char> fileContent(const std::string& file, const std::string& member,
                                       const std::filesystem::path& folder, const std::string& uri,
                                       const ReadOptions& options) {
    std::filesystem::path target;
    try {
        target = namedFile(folder, pathOfUri(uri), options);
    } catch (const InputError& error) {
        throw InputError(fmt::format("{}: {}: {}", file, member, error.what()));
    }
    options.onFile(target);
    std::error_code error;
    if (uri.empty() || !std::filesystem::is_regular_file(target, error))
        failAtMember(file, member, inQuotes(uri), "the name of a file that exists");
    const std::string content = readInputFile(target);
    return {content.begin(), content.end()};
}

} // namespace

std::vector<gltf::Buffer> readGltfBuffers(const std::string& file, const std::filesystem::path& folder,
                                          const GltfContainer& container, const json& document,
                                          const ReadOptions& options) {
    std::vector<gltf::Buffer> buffers;
    if (!document.contains("buffers")) return buffers;
    for (const json& source : document["buffers"]) {
        gltf::Buffer& buffer = buffers.emplace_back();
        if (isFallback(source)) continue;
        const std::size_t index = buffers.size() - 1;
        const std::string place = fmt::format("/buffers/{}", index);
        if (source.contains("uri")) {
            const auto uri = source["uri"].get<std::string>();
            if (isDataUri(uri)) {
                auto data = dataOfUri(uri);
                if (!data) failAtMember(file, place + "/uri", inQuotes(uri), "a data URI in base64");
                buffer = std::move(*data);
            } else {
                buffer = fileContent(file, place + "/uri", folder, uri, options);
            }
        } else if (container.isBinary && index == 0) {
            buffer.assign(container.binary.begin(), container.binary.end());
        } else {
            failAtMember(file, place + "/uri", "nothing", "a file or data URI");
        }
        const auto length = source["byteLength"].get<std::uint64_t>();
        if (length < 1 || length > buffer.size())
            failAtMember(file, place + "/byteLength", std::to_string(length),
                         fmt::format("1 to {}, the bytes that are there", buffer.size()));
    }
    return buffers;
}

std::span<const unsigned char> gltfBytes(const std::string& file, const gltf::Model& model, int buffer,
                                         std::size_t offset, std::size_t length, const std::string& place) {
    const auto& data = gltfElement(file, model.buffers, "buffers", buffer, place + "/buffer");
    if (offset > data.size())
        failAtMember(file, place + "/byteOffset", std::to_string(offset),
                     fmt::format("at most {} (buffer {} has so many bytes)", data.size(), buffer));
    if (length > data.size() - offset)
        failAtMember(file, place + "/byteLength", std::to_string(length),
                     fmt::format("at most {} (buffer {} has {} bytes)", data.size() - offset, buffer, data.size()));
    return std::span(data).subspan(offset, length);
}

std::span<const unsigned char> gltfViewBytes(const std::string& file, const gltf::Model& model, int view,
                                             const std::string& referrer) {
    const auto& source = gltfElement(file, model.bufferViews, "bufferViews", view, referrer);
    return gltfBytes(file, model, source.buffer, source.byteOffset, source.byteLength,
                     fmt::format("/bufferViews/{}", view));
}

} // namespace lambert
