#include "scene/gltf/material.h"

#include "core/text.h"
#include "scene/gltf/document.h"
#include "scene/gltf/metalness.h"

#include <fmt/format.h>

#include <algorithm>
#include <tuple>

namespace lambert {

namespace {

constexpr const char* kConstantColour = "the material's constant colour is used";
constexpr const char* kConstantEmission = "the material's constant emission is used";
constexpr const char* kNoMetal = "the material is taken to have no metal";

Rgb checkedColour(const std::string& file, const std::string& member, const glm::dvec3& numbers) {
    Rgb colour(0.0F);
    for (int k = 0; k < 3; ++k) colour[k] = checkedGltfNumber(file, fmt::format("{}/{}", member, k), numbers[k]);
    return colour;
}

TextureUse useOf(const GltfTexture& texture, std::uint32_t index) { return {index, texture.wrapU, texture.wrapV}; }

/// The least and the largest opacity of an image.
std::pair<float, float> opacityRange(const Texture& image) {
    std::pair<float, float> range{1.0F, 0.0F};
    for (int y = 0; y < image.height(); ++y)
        for (int x = 0; x < image.width(); ++x) {
            const float opacity = image.texel(x, y).w;
            range = {std::min(range.first, opacity), std::max(range.second, opacity)};
        }
    return range;
}

/// What a material says of its colour, whichever of the models of glTF it uses.
struct BaseColour {
    Rgb factor{1.0F};
    float opacity = 1.0F;
    std::optional<GltfTexture> texture;
};

class MaterialReader {
public:
    MaterialReader(const std::string& file, const std::filesystem::path& folder, const gltf::Model& model,
                   SceneBuilder& builder)
        : file_(file), model_(model), builder_(builder), textures_(file, folder, model, builder) {}

    std::vector<GltfMaterial> readAll() {
        std::vector<GltfMaterial> result;
        for (std::size_t k = 0; k < model_.materials.size(); ++k) result.push_back(read(k));
        if (blended_ > 0)
            builder_.warn(fmt::format("{} materials of alphaMode BLEND are taken to be opaque", blended_));
        return result;
    }

private:
    GltfMaterial read(std::size_t index) {
        const gltf::Material& source = model_.materials[index];
        place_ = fmt::format("/materials/{}", index);
        material_ = {};
        material_.name = source.name.empty() ? fmt::format("material_{}", index) : source.name;
        material_.twoSided = source.doubleSided;
        result_ = {};

        const BaseColour base = baseColourOf(source);
        setOpacity(source, base);
        setReflectance(source, base);
        setEmission(source);
        result_.index = builder_.addMaterial(std::move(material_));
        return result_;
    }

    void warn(const std::string& text) {
        builder_.warn(fmt::format("material {}: {}", inQuotes(material_.name), text));
    }

    BaseColour baseColourOf(const gltf::Material& source) {
        BaseColour base;
        const bool isGlossy = usesSpecularGlossiness(source);
        const std::string member = place_ + (isGlossy ? "/extensions/KHR_materials_pbrSpecularGlossiness/diffuse"
                                                      : "/pbrMetallicRoughness/baseColor");
        const glm::dvec4& factor = isGlossy ? source.specularGlossiness->diffuseFactor : source.baseColorFactor;
        base.factor = checkedColour(file_, member + "Factor", glm::dvec3(factor));
        base.opacity = checkedGltfNumber(file_, member + "Factor/3", factor.w);
        base.texture = textures_.find(isGlossy ? source.specularGlossiness->diffuseTexture : source.baseColorTexture,
                                      member + "Texture", kConstantColour);
        return base;
    }

    /// The older model, where no other goes before it.
    static bool usesSpecularGlossiness(const gltf::Material& source) {
        return source.specularGlossiness && !source.isUnlit;
    }

    void setOpacity(const gltf::Material& source, const BaseColour& base) {
        if (source.alphaMode == "BLEND") ++blended_;
        if (source.alphaMode == "BLEND" || source.alphaMode == "OPAQUE") return;
        if (source.alphaMode != "MASK")
            failAtMember(file_, place_ + "/alphaMode", inQuotes(source.alphaMode), "OPAQUE, MASK or BLEND");
        const float cutoff = checkedGltfNumber(file_, place_ + "/alphaCutoff", source.alphaCutoff);
        const auto image = base.texture ? textures_.colours(*base.texture, kConstantColour) : nullptr;
        if (image == nullptr || base.opacity == 0.0F) {
            result_.isInvisible = base.opacity < cutoff;
            return;
        }
        const float imageCutoff = cutoff / base.opacity;
        const auto [least, largest] = opacityRange(*image);
        result_.isInvisible = largest < imageCutoff;
        if (result_.isInvisible || least >= imageCutoff) return;
        material_.opacityTexture = useOf(*base.texture, textures_.addColours(*base.texture));
        material_.opacityCutoff = imageCutoff;
        result_.uv = base.texture->coordinates;
    }

    void setReflectance(const gltf::Material& source, const BaseColour& base) {
        float share = 1.0F; // of the base colour that is reflected diffusely
        const float transmitted =
            checkedGltfNumber(file_, place_ + "/extensions/KHR_materials_transmission/transmissionFactor",
                              source.transmissionFactor, 1.0);
        share -= transmitted;
        material_.diffusePartOnly = transmitted > 0.0F;
        if (transmitted > 0.0F)
            warn(fmt::format("transmits {:g} of the light (transmissionFactor): this part is lost", transmitted));
        std::optional<GltfTexture> metal;
        std::shared_ptr<const Texture> metalness;
        if (!source.isUnlit && !usesSpecularGlossiness(source))
            share *= 1.0F - constantMetalness(source, metal, metalness);

        auto image = base.texture && share > 0.0F ? textures_.colours(*base.texture, kConstantColour) : nullptr;
        if (metalness != nullptr && image != nullptr && !base.texture->coversTheSameAs(*metal)) {
            warn("metallicRoughnessTexture lies otherwise than baseColorTexture: its mean metalness is used");
            share *= 1.0F - metalFactor_ * meanMetalness(*metalness);
            metalness = nullptr;
        }
        material_.reflectance = base.factor * share;
        if (image != nullptr || metalness != nullptr) material_.reflectance = notAboveLargest(material_.reflectance);
        if (metalness != nullptr) {
            const GltfTexture& texture = image != nullptr ? *base.texture : *metal;
            material_.reflectanceTexture = useOf(texture, addWithoutMetal(image != nullptr ? base.texture->image : -1,
                                                                          image.get(), metal->image, *metalness));
            result_.uv = texture.coordinates;
        } else if (image != nullptr) {
            material_.reflectanceTexture = useOf(*base.texture, textures_.addColours(*base.texture));
            result_.uv = base.texture->coordinates;
        }
    }

    /// The metalness if it is the same everywhere; else 0, with the texture and its image.
    float constantMetalness(const gltf::Material& source, std::optional<GltfTexture>& metal,
                            std::shared_ptr<const Texture>& metalness) {
        const std::string place = place_ + "/pbrMetallicRoughness";
        metalFactor_ = checkedGltfNumber(file_, place + "/metallicFactor", source.metallicFactor, 1.0);
        float constant = metalFactor_;
        if (source.metallicRoughnessTexture.index >= 0 && metalFactor_ > 0.0F) {
            metal = textures_.find(source.metallicRoughnessTexture, place + "/metallicRoughnessTexture", kNoMetal);
            metalness = metal ? textures_.numbers(*metal, kNoMetal) : nullptr;
            if (metalness == nullptr) return 0.0F;
            const auto uniform = uniformMetalness(*metalness);
            if (!uniform) return 0.0F;
            metalness = nullptr;
            constant *= *uniform;
        }
        material_.diffusePartOnly |= constant > 0.5F;
        if (constant == 1.0F)
            warn("is fully metallic (metallicFactor 1, the default): it has no diffuse part, its reflectance is 0");
        return constant;
    }

    /// The texture of a colour's diffuse share, in the scene; many materials may use the same.
    std::uint32_t addWithoutMetal(int colourImage, const Texture* colour, int metalImage, const Texture& metalness) {
        const auto [entry, isNew] = withoutMetal_.try_emplace({colourImage, metalImage, metalFactor_}, kNone);
        if (isNew) entry->second = builder_.addTexture(withoutMetal(colour, metalness, metalFactor_));
        return entry->second;
    }

    void setEmission(const gltf::Material& source) {
        checkedGltfNumber(file_, place_ + "/extensions/KHR_materials_emissive_strength/emissiveStrength",
                          source.emissiveStrength);
        checkedColour(file_, place_ + "/emissiveFactor", source.emissiveFactor);
        material_.emittedRadiance =
            checkedColour(file_, place_ + "/emissiveFactor", source.emissiveFactor * source.emissiveStrength);

        const auto texture = textures_.find(source.emissiveTexture, place_ + "/emissiveTexture", kConstantEmission);
        if (!texture || material_.emittedRadiance == Rgb(0.0F)) return;
        if (textures_.colours(*texture, kConstantEmission) == nullptr) return;
        material_.emissionTexture = useOf(*texture, textures_.addColours(*texture));
        result_.emissionUv = texture->coordinates;
    }

    const std::string& file_;
    const gltf::Model& model_;
    SceneBuilder& builder_;
    GltfTextures textures_;
    std::map<std::tuple<int, int, float>, std::uint32_t> withoutMetal_; //!< by colour, metal and factor: in the scene
    std::size_t blended_ = 0;
    // Of the material at work:
    std::string place_; //!< its JSON path
    Material material_;
    GltfMaterial result_;
    float metalFactor_ = 0.0F;
};

} // namespace

std::vector<GltfMaterial> addGltfMaterials(const std::string& file, const std::filesystem::path& folder,
                                           const gltf::Model& model, SceneBuilder& builder) {
    return MaterialReader(file, folder, model, builder).readAll();
}

} // namespace lambert
