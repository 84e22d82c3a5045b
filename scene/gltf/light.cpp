// KHR_lights_punctual: https://github.com/KhronosGroup/glTF/tree/main/extensions/2.0/Khronos/KHR_lights_punctual

#include "scene/gltf/light.h"

#include "core/text.h"
#include "scene/gltf/document.h"

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <glm/gtc/constants.hpp>

#include <algorithm>
#include <cmath>

namespace lambert {

namespace {

PunctualLight::Kind kindOf(const std::string& file, const std::string& member, const std::string& type) {
    if (type == "point") return PunctualLight::Kind::Point;
    if (type == "spot") return PunctualLight::Kind::Spot;
    if (type == "directional") return PunctualLight::Kind::Directional;
    failAtMember(file, member, inQuotes(type), "\"point\", \"spot\" or \"directional\"");
}

/// The light as the file defines it, for all nodes.
PunctualLight definitionOf(const std::string& file, const gltf::Light& source, const std::string& place) {
    PunctualLight light;
    light.name = source.name;
    light.kind = kindOf(file, place + "/type", source.type);
    checkedGltfNumber(file, place + "/intensity", source.intensity);
    for (int k = 0; k < 3; ++k) {
        const std::string member = fmt::format("{}/color/{}", place, k);
        checkedGltfNumber(file, member, source.color[k]);
        light.intensity[k] = checkedGltfNumber(file, member, source.color[k] * source.intensity);
    }
    if (light.kind != PunctualLight::Kind::Spot) return light;
    // Files round π/2 up as well as down.
    const double right = glm::half_pi<double>() + 1e-6;
    const double outer = source.outerConeAngle;
    light.outerConeAngle =
        std::min(checkedGltfNumber(file, place + "/spot/outerConeAngle", outer, right), glm::half_pi<float>());
    light.innerConeAngle = std::min(
        checkedGltfNumber(file, place + "/spot/innerConeAngle", source.innerConeAngle, outer), light.outerConeAngle);
    return light;
}

} // namespace

void addGltfLight(const std::string& file, const gltf::Model& model, const GltfNode& node, SceneBuilder& builder) {
    const gltf::Node& source = model.nodes[static_cast<std::size_t>(node.index)];
    if (source.light < 0) return;
    const auto& definition = gltfElement(file, model.lights, "lights", source.light,
                                         fmt::format("/nodes/{}/extensions/KHR_lights_punctual/light", node.index));
    PunctualLight light =
        definitionOf(file, definition, fmt::format("/extensions/KHR_lights_punctual/lights/{}", source.light));
    if (light.name.empty()) light.name = source.name;
    if (light.name.empty()) light.name = fmt::format("light_{}", source.light);

    light.position = builder.local(glm::dvec3(node.toWorld[3]));
    light.direction = glm::vec3(glm::normalize(-glm::dvec3(node.toWorld[2])));
    const bool hasPosition = light.kind != PunctualLight::Kind::Directional;
    const bool hasDirection = light.kind != PunctualLight::Kind::Point;
    if ((hasPosition && !std::isfinite(glm::dot(light.position, light.position))) ||
        (hasDirection && !std::isfinite(glm::dot(light.direction, light.direction)))) {
        builder.warn(fmt::format("the light {} was ignored: its transform is singular", inQuotes(light.name)));
        return;
    }
    if (!hasPosition) light.position = glm::vec3(0.0F);
    if (!hasDirection) light.direction = glm::vec3(0.0F, 0.0F, -1.0F);
    builder.addLight(std::move(light));
}

} // namespace lambert
