#include "scene/gltf/texture.h"

#include "scene/gltf/buffers.h"
#include "scene/gltf/document.h"
#include "scene/gltf/uri.h"

#include <fmt/format.h>

#include <cmath>

namespace lambert {

namespace {

TextureWrap wrapOf(const std::string& file, const std::string& member, int number) {
    if (number == 10497) return TextureWrap::Repeat;
    if (number == 33648) return TextureWrap::Mirror;
    if (number == 33071) return TextureWrap::Clamp;
    failAtMember(file, member, std::to_string(number), "10497, 33648 or 33071");
}

/// KHR_texture_transform: the offset after the rotation after the scale. The rotation is the one of the specification's
/// first example (the lower left quarter, turned): its shader code has it the other way round.
glm::mat3x2 matrixOf(const gltf::TextureInfo& info) {
    const double cosine = std::cos(info.rotation), sine = std::sin(info.rotation);
    return glm::mat3x2(glm::vec2(info.scale.x * glm::dvec2(cosine, -sine)),
                       glm::vec2(info.scale.y * glm::dvec2(sine, cosine)), glm::vec2(info.offset));
}

} // namespace

std::optional<GltfTexture> GltfTextures::find(const gltf::TextureInfo& info, const std::string& place,
                                              const std::string& replacement) {
    if (info.index < 0) return std::nullopt;
    const auto& source = gltfElement(file_, model_.textures, "textures", info.index, place + "/index");
    GltfTexture result;
    result.image = imageOf(info.index, replacement);
    if (result.image < 0) return std::nullopt;
    result.coordinates = {.set = info.texCoord, .toUv = matrixOf(info)};
    if (source.sampler >= 0) {
        const std::string sampler = fmt::format("/samplers/{}", source.sampler);
        const auto& wraps = gltfElement(file_, model_.samplers, "samplers", source.sampler,
                                        fmt::format("/textures/{}/sampler", info.index));
        result.wrapU = wrapOf(file_, sampler + "/wrapS", wraps.wrapS);
        result.wrapV = wrapOf(file_, sampler + "/wrapT", wraps.wrapT);
    }
    return result;
}

/// The image of a texture, -1 if there is none that could be read.
int GltfTextures::imageOf(int texture, const std::string& replacement) {
    const gltf::Texture& source = model_.textures[static_cast<std::size_t>(texture)];
    std::string member = fmt::format("/textures/{}/source", texture);
    int image = source.source;
    if (image < 0 && source.webpSource >= 0) {
        image = source.webpSource;
        member = fmt::format("/textures/{}/extensions/EXT_texture_webp/source", texture);
    }
    if (image < 0) {
        builder_.warnUnlessStrict(fmt::format("/textures/{}: {}; {}", texture,
                                              source.hasBasis ? "its image is in KTX 2, which Lambert does not read"
                                                              : "has no image that Lambert reads",
                                              replacement));
        return -1;
    }
    gltfElement(file_, model_.images, "images", image, member);
    return image;
}

std::shared_ptr<const Texture> GltfTextures::colours(const GltfTexture& texture, const std::string& replacement) {
    const auto [entry, isNew] = colours_.try_emplace(texture.image);
    if (isNew) entry->second = read(texture.image, TextureContent::Colour, replacement);
    return entry->second;
}

std::shared_ptr<const Texture> GltfTextures::numbers(const GltfTexture& texture, const std::string& replacement) {
    return read(texture.image, TextureContent::Linear, replacement);
}

std::uint32_t GltfTextures::addColours(const GltfTexture& texture) {
    const auto [entry, isNew] = added_.try_emplace(texture.image, kNone);
    if (isNew) entry->second = builder_.addTexture(colours_.at(texture.image));
    return entry->second;
}

std::shared_ptr<const Texture> GltfTextures::read(int index, TextureContent content, const std::string& replacement) {
    const gltf::Image& image = model_.images[static_cast<std::size_t>(index)];
    const std::string place = fmt::format("/images/{}", index);
    if (image.bufferView < 0 && !isDataUri(image.uri))
        return builder_.readTextureFile(folder_, pathOfUri(image.uri), content, replacement);

    const std::string name = image.name.empty() ? place : image.name;
    if (image.bufferView >= 0)
        return builder_.readTextureBytes(gltfViewBytes(file_, model_, image.bufferView, place + "/bufferView"), name,
                                         content, replacement);
    const auto data = dataOfUri(image.uri);
    return builder_.readTextureBytes(data.value_or(std::vector<unsigned char>{}), name, content, replacement);
}

} // namespace lambert
