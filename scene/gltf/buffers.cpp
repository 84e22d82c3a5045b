#include "scene/gltf/buffers.h"

#include "core/error.h"
#include "core/input_file.h"
#include "core/text.h"
#include "scene/gltf/document.h"
#include "scene/gltf/uri.h"
#include "scene/named_file.h"

#include <fmt/format.h>

namespace lambert {

namespace {

std::vector<unsigned char> fileContent(const std::string& file, const std::string& member,
                                       const std::filesystem::path& folder, const std::string& uri,
                                       const ReadOptions& options) {
    std::filesystem::path target;
    try {
        target = namedFile(folder, pathOfUri(uri), options);
    } catch (const InputError& error) {
        throw InputError(fmt::format("{}: {}: {}", file, member, error.what()));
    }
    std::error_code error;
    if (uri.empty() || !std::filesystem::is_regular_file(target, error))
        failAtMember(file, member, inQuotes(uri), "the name of a file that exists");
    const std::string content = readInputFile(target);
    return {content.begin(), content.end()};
}

} // namespace

std::vector<gltf::Buffer> readGltfBuffers(const std::string& file, const std::filesystem::path& folder,
                                          const GltfContainer& container,
                                          const std::vector<gltf::BufferSource>& sources, const ReadOptions& options) {
    std::vector<gltf::Buffer> buffers;
    for (const gltf::BufferSource& source : sources) {
        gltf::Buffer& buffer = buffers.emplace_back();
        if (source.isFallback) continue;
        const std::size_t index = buffers.size() - 1;
        const std::string place = fmt::format("/buffers/{}", index);
        if (source.uri) {
            const std::string& uri = *source.uri;
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
        if (source.byteLength < 1 || source.byteLength > buffer.size())
            failAtMember(file, place + "/byteLength", std::to_string(source.byteLength),
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
