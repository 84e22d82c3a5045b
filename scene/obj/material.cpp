#include "scene/obj/material.h"

#include "core/error.h"
#include "core/text.h"
#include "scene/named_file.h"
#include "scene/words.h"

#include <fmt/format.h>
#include <glm/common.hpp>

#include <algorithm>
#include <limits>
#include <system_error>
#include <utility>

namespace lambert {

namespace {

constexpr float kOpacityCutoff = 0.5F;
constexpr float kLargest = std::numeric_limits<float>::max();
constexpr std::size_t kMostUndefinedNamed = 20;

/// Mirrors, glass and what reflects more as a mirror than diffusely.
bool isMoreThanDiffuse(const MtlMaterial& source) {
    const auto largest = [](const Rgb& colour) { return std::max({colour.x, colour.y, colour.z}); };
    const bool shiny = !source.diffuseMap && source.illumination >= 2 &&
                       largest(source.specular) > largest(source.diffuse.value_or(Rgb(0.0F)));
    const bool transparent = source.opacity < 1.0F && !source.opacityMap;
    return (source.illumination >= 3 && source.illumination <= 9) || transparent || shiny;
}

/// `material "a"`, or `materials "a", "b" and 3 others`.
std::string namesOf(const std::vector<std::string>& names) {
    constexpr std::size_t kMostNamed = 5;
    std::string result = names.size() > 1 ? "materials " : "material ";
    const std::size_t named = names.size() > kMostNamed + 1 ? kMostNamed : names.size();
    for (std::size_t k = 0; k < named; ++k) {
        if (k > 0) result += k + 1 == names.size() ? " and " : ", ";
        result += inQuotes(names[k]);
    }
    if (named < names.size()) result += fmt::format(" and {} others", names.size() - named);
    return result;
}

TextureUse useOf(std::uint32_t texture, const MtlMap& map) {
    const TextureWrap wrap = map.clamp ? TextureWrap::Clamp : TextureWrap::Repeat;
    return {texture, wrap, wrap};
}

} // namespace

ObjMaterials::ObjMaterials(SceneBuilder& builder, const ReadOptions& options, std::filesystem::path folder,
                           bool vertexColours)
    : builder_(builder), options_(options), folder_(std::move(folder)), vertexColours_(vertexColours) {}

void ObjMaterials::addLibraries(const std::string& argument) {
    const std::vector<std::string_view> names = wordsOf(argument);
    if (names.size() > 1 && isFile(argument)) return addLibrary(argument);
    for (const std::string_view name : names) addLibrary(std::string(name));
}

/// Whether the scene's folder has this file, as namedFile finds it.
bool ObjMaterials::isFile(const std::string& name) const {
    std::error_code error;
    try {
        return std::filesystem::is_regular_file(namedFile(folder_, name, options_), error);
    } catch (const InputError&) {
        return false; // outside the folder
    }
}

void ObjMaterials::addLibrary(const std::string& name) {
    std::optional<ObjLines> lines;
    try {
        const std::filesystem::path path = namedFile(folder_, name, options_);
        if (!libraries_.insert(path).second) return;
        lines.emplace(path);
    } catch (const InputError& error) {
        builder_.warnUnlessStrict(fmt::format("mtllib {}", error.what()));
        return;
    }
    const MtlFile library = readMtl(*lines);
    for (const std::string& warning : library.warnings) builder_.warn(warning);
    for (const MtlMaterial& source : library.materials) {
        if (!materials_.contains(source.name)) {
            addMaterial(source);
        } else {
            builder_.warn(fmt::format("material {} is defined again in {}: the first counts", inQuotes(source.name),
                                      lines->file()));
        }
    }
}

void ObjMaterials::addMaterial(const MtlMaterial& source) {
    Material material;
    material.name = source.name;
    ObjMaterial use;
    setReflectance(source, material, use);
    setEmission(source, material, use);
    setOpacity(source, material, use);
    material.diffusePartOnly = isMoreThanDiffuse(source);
    if (material.diffusePartOnly) notDiffuse_.push_back(source.name);
    use.textured = material.isTextured();
    use.index = builder_.addMaterial(std::move(material));
    materials_.emplace(source.name, use);
}

void ObjMaterials::setReflectance(const MtlMaterial& source, Material& material, ObjMaterial& use) {
    if (!source.diffuseMap) {
        material.reflectance = source.diffuse.value_or(Rgb(0.0F));
        if (!source.diffuse && !source.emission)
            builder_.warn(fmt::format("material {}: has no Kd: its reflectance is 0", inQuotes(source.name)));
        return;
    }
    const bool useKd = source.diffuse && *source.diffuse != Rgb(0.0F);
    material.reflectance = useKd ? *source.diffuse : Rgb(kUnknownReflectance);
    const std::uint32_t texture = builder_.addTextureFile(
        folder_, source.diffuseMap->file, TextureContent::Colour,
        useKd ? "Kd alone is used" : fmt::format("the reflectance {} is used", kUnknownReflectance));
    if (texture == kNone) return;
    material.reflectance = notAboveLargest(mapFactor(source, source.diffuse, *source.diffuseMap, blackReflectance_));
    material.reflectanceTexture = useOf(texture, *source.diffuseMap);
    use.uv = {source.diffuseMap->scale, source.diffuseMap->offset};
}

void ObjMaterials::setEmission(const MtlMaterial& source, Material& material, ObjMaterial& use) {
    material.emittedRadiance = source.emission.value_or(Rgb(0.0F));
    if (!source.emissionMap) return;
    const std::uint32_t texture =
        builder_.addTextureFile(folder_, source.emissionMap->file, TextureContent::Colour, "Ke alone is used");
    if (texture == kNone) return;
    material.emittedRadiance = mapFactor(source, source.emission, *source.emissionMap, blackEmission_);
    material.emissionTexture = useOf(texture, *source.emissionMap);
    use.emissionUv = {source.emissionMap->scale, source.emissionMap->offset};
}

void ObjMaterials::setOpacity(const MtlMaterial& source, Material& material, ObjMaterial& use) {
    if (!source.opacityMap) return;
    const std::uint32_t texture =
        builder_.addTextureFile(folder_, source.opacityMap->file, TextureContent::GreyAlpha, "the material is opaque");
    if (texture == kNone) return;
    material.opacityTexture = useOf(texture, *source.opacityMap);
    material.opacityCutoff = kOpacityCutoff;
    const ObjUvTransform uv{source.opacityMap->scale, source.opacityMap->offset};
    if (!material.reflectanceTexture) {
        use.uv = uv;
    } else if (uv.scale != use.uv.scale || uv.offset != use.uv.offset) {
        otherOpacityUv_.push_back(source.name);
    }
}

/// What multiplies the image's values. Many exporters write a black Kd or Ke, or none, where an image takes its place.
Rgb ObjMaterials::mapFactor(const MtlMaterial& source, const std::optional<Rgb>& colour, const MtlMap& map,
                            std::vector<std::string>& blackOnes) {
    Rgb factor = colour.value_or(Rgb(1.0F));
    if (factor == Rgb(0.0F)) {
        blackOnes.push_back(source.name);
        factor = Rgb(1.0F);
    }
    if (map.base != 0.0F) shiftedMaps_.push_back(source.name);
    return glm::clamp(factor * map.gain, -kLargest, kLargest);
}

const ObjMaterial& ObjMaterials::find(const std::string& name) {
    const auto known = materials_.find(name);
    return known != materials_.end() ? known->second : materials_.emplace(name, addSubstitute(name)).first->second;
}

ObjMaterial ObjMaterials::addSubstitute(const std::string& name) {
    if (name != kNoMaterial && ++undefined_ <= kMostUndefinedNamed) {
        const char* reflectance = vertexColours_ ? "that of the vertex colours" : "0.5";
        builder_.warnUnlessStrict(
            fmt::format("material {} is not defined: its reflectance is {}", inQuotes(name), reflectance));
    }
    Material material{.name = name, .reflectance = Rgb(vertexColours_ ? kMaxReflectance : kUnknownReflectance)};
    return {.index = builder_.addMaterial(std::move(material)), .tinted = vertexColours_};
}

void ObjMaterials::warnOfReplacements() {
    const auto warn = [&](const std::vector<std::string>& names, const char* text) {
        if (!names.empty()) builder_.warn(fmt::format("{}: {}", namesOf(names), text));
    };
    warn(notDiffuse_, "only the diffuse part (Kd) of mirrors, glass and shiny surfaces is used");
    warn(blackReflectance_, "Kd is black beside map_Kd, the image alone is used");
    warn(blackEmission_, "Ke is black beside map_Ke, the image alone is used");
    warn(shiftedMaps_, "the base of -mm is not supported, 0 is used");
    warn(otherOpacityUv_, "-s and -o of map_d differ from those of map_Kd, which are used");
    if (undefined_ > kMostUndefinedNamed)
        builder_.warn(fmt::format("{} more materials are not defined", undefined_ - kMostUndefinedNamed));
}

} // namespace lambert
