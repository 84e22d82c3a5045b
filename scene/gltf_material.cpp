#include "scene/gltf_material.h"

#include "scene/gltf_document.h"
#include "scene/input_file.h"

#include <fmt/format.h>
#include <tiny_gltf.h>

#include <limits>

namespace lambert {

namespace {

/// `number` in single precision; `member` is its JSON path.
float checkedNumber(const std::string& file, const std::string& member, double number,
                    double largest = std::numeric_limits<float>::max()) {
    if (!(number >= 0.0 && number <= largest))
        failAtMember(file, member, fmt::format("{:g}", number), fmt::format("0 to {:g}", largest));
    return static_cast<float>(number);
}

Rgb checkedColour(const std::string& file, const std::string& member, const std::vector<double>& numbers) {
    Rgb colour(0.0F);
    for (int k = 0; k < 3; ++k)
        colour[k] = checkedNumber(file, fmt::format("{}/{}", member, k), numbers[static_cast<std::size_t>(k)]);
    return colour;
}

double emissiveStrength(const tinygltf::Material& source) {
    const auto extension = source.extensions.find("KHR_materials_emissive_strength");
    if (extension == source.extensions.end() || !extension->second.Has("emissiveStrength")) return 1.0;
    return extension->second.Get("emissiveStrength").GetNumberAsDouble();
}

} // namespace

std::vector<std::uint32_t> addGltfMaterials(const std::string& file, const tinygltf::Model& model,
                                            SceneBuilder& builder) {
    std::vector<std::uint32_t> indices;
    for (std::size_t k = 0; k < model.materials.size(); ++k) {
        const tinygltf::Material& source = model.materials[k];
        const auto& pbr = source.pbrMetallicRoughness;
        const std::string place = fmt::format("/materials/{}", k);
        const std::string pbrPlace = place + "/pbrMetallicRoughness";

        Material material;
        material.name = source.name.empty() ? fmt::format("material_{}", k) : source.name;
        material.twoSided = source.doubleSided;
        const Rgb baseColour = checkedColour(file, pbrPlace + "/baseColorFactor", pbr.baseColorFactor);
        const float metallic = checkedNumber(file, pbrPlace + "/metallicFactor", pbr.metallicFactor, 1.0);
        material.reflectance = baseColour * (1.0F - metallic);
        material.diffusePartOnly = metallic > 0.5F || source.extensions.contains("KHR_materials_transmission");

        const double strength = emissiveStrength(source);
        checkedNumber(file, place + "/extensions/KHR_materials_emissive_strength/emissiveStrength", strength);
        checkedColour(file, place + "/emissiveFactor", source.emissiveFactor);
        std::vector<double> radiance = source.emissiveFactor;
        for (double& channel : radiance) channel *= strength;
        material.emittedRadiance = checkedColour(file, place + "/emissiveFactor", radiance);

        const auto warn = [&](const char* text) {
            builder.warn(fmt::format("material {}: {}", inQuotes(material.name), text));
        };
        if (metallic == 1.0F)
            warn("is fully metallic (metallicFactor 1, the default): it has no diffuse part, its reflectance "
                 "is 0");
        if (pbr.baseColorTexture.index >= 0) warn("baseColorTexture is not read, baseColorFactor is used");
        if (source.emissiveTexture.index >= 0) warn("emissiveTexture is not read, emissiveFactor is used");
        indices.push_back(builder.addMaterial(std::move(material)));
    }
    return indices;
}

} // namespace lambert
