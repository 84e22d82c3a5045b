#include "scene/gltf_texture.h"

#include "scene/gltf_buffers.h"
#include "scene/gltf_document.h"
#include "scene/gltf_uri.h"
#include "scene/input_file.h"

#include <fmt/format.h>
#include <tiny_gltf.h>

#include <cmath>

namespace lambert {

namespace {

TextureWrap wrapOf(const std::string& file, const std::string& member, int number) {
    if (number == TINYGLTF_TEXTURE_WRAP_REPEAT) return TextureWrap::Repeat;
    if (number == TINYGLTF_TEXTURE_WRAP_MIRRORED_REPEAT) return TextureWrap::Mirror;
    if (number == TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE) return TextureWrap::Clamp;
    failAtMember(file, member, std::to_string(number), "10497, 33648 or 33071");
}

glm::dvec2 pairOf(const tinygltf::Value& extension, const char* member, double missing) {
    if (!extension.Has(member)) return glm::dvec2(missing);
    const tinygltf::Value& pair = extension.Get(member);
    return {pair.Get(0).GetNumberAsDouble(), pair.Get(1).GetNumberAsDouble()};
}

/// KHR_texture_transform: the offset after the rotation after the scale. The rotation is the one of the specification's
/// first example (the lower left quarter, turned): its shader code has it the other way round.
glm::mat3x2 matrixOf(const tinygltf::Value& transform) {
    const glm::dvec2 offset = pairOf(transform, "offset", 0.0);
    const glm::dvec2 scale = pairOf(transform, "scale", 1.0);
    const double angle = gltfNumber(transform, "rotation", 0.0);
    const double cosine = std::cos(angle), sine = std::sin(angle);
    return glm::mat3x2(glm::vec2(scale.x * glm::dvec2(cosine, -sine)), glm::vec2(scale.y * glm::dvec2(sine, cosine)),
                       glm::vec2(offset));
}

GltfTextureCoordinates coordinatesOf(const tinygltf::TextureInfo& info) {
    GltfTextureCoordinates result{.set = info.texCoord};
    if (const tinygltf::Value* transform = gltfExtension(info, "KHR_texture_transform")) {
        result.toUv = matrixOf(*transform);
        if (transform->Has("texCoord")) result.set = transform->Get("texCoord").Get<int>();
    }
    return result;
}

} // namespace

std::optional<GltfTexture> GltfTextures::find(const tinygltf::TextureInfo& info, const std::string& place,
                                              const std::string& replacement) {
    if (info.index < 0) return std::nullopt;
    const auto& source = gltfElement(file_, model_.textures, "textures", info.index, place + "/index");
    GltfTexture result;
    result.image = imageOf(info.index, replacement);
    if (result.image < 0) return std::nullopt;
    result.coordinates = coordinatesOf(info);
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
    const tinygltf::Texture& source = model_.textures[static_cast<std::size_t>(texture)];
    std::string member = fmt::format("/textures/{}/source", texture);
    int image = source.source;
    const tinygltf::Value* webp = gltfExtension(source, "EXT_texture_webp");
    if (image < 0 && webp != nullptr && webp->Has("source")) {
        image = webp->Get("source").Get<int>();
        member = fmt::format("/textures/{}/extensions/EXT_texture_webp/source", texture);
    }
    if (image < 0) {
        const bool isBasis = gltfExtension(source, "KHR_texture_basisu") != nullptr;
        builder_.warnUnlessStrict(fmt::format("/textures/{}: {}; {}", texture,
                                              isBasis ? "its image is in KTX 2, which Lambert does not read"
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
    const tinygltf::Image& image = model_.images[static_cast<std::size_t>(index)];
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
