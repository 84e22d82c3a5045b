#include "scene/gltf/camera.h"

#include "core/text.h"
#include "scene/gltf/document.h"

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <glm/gtc/constants.hpp>

#include <cmath>

namespace lambert {

void addGltfCamera(const std::string& file, const gltf::Model& model, const GltfNode& node, SceneBuilder& builder) {
    const gltf::Node& source = model.nodes[static_cast<std::size_t>(node.index)];
    if (source.camera < 0) return;
    const gltf::Camera& definition =
        gltfElement(file, model.cameras, "cameras", source.camera, fmt::format("/nodes/{}/camera", node.index));
    Camera camera;
    camera.name = definition.name.empty() ? source.name : definition.name;
    if (camera.name.empty()) camera.name = fmt::format("camera_{}", source.camera);
    if (definition.type != "perspective") {
        builder.warn(fmt::format("the orthographic camera {} was ignored", inQuotes(camera.name)));
        return;
    }
    const double fov = definition.yfov;
    if (!(fov > 0.0 && fov < glm::pi<double>()))
        failAtMember(file, fmt::format("/cameras/{}/perspective/yfov", source.camera), fmt::format("{:g}", fov),
                     "radians above 0 and below pi");
    const glm::dvec3 eye(node.toWorld[3]);
    const glm::dvec3 direction = glm::normalize(-glm::dvec3(node.toWorld[2]));
    const glm::dvec3 up = glm::normalize(glm::dvec3(node.toWorld[1]));
    const double sine = glm::length(glm::cross(direction, up));
    if (!(sine > 1e-6) || !std::isfinite(glm::dot(eye, eye))) {
        builder.warn(fmt::format("the camera {} was ignored: its transform is singular", inQuotes(camera.name)));
        return;
    }
    camera.eye = builder.local(eye);
    camera.direction = glm::vec3(direction);
    camera.up = glm::vec3(up);
    camera.verticalFov = static_cast<float>(fov);
    builder.addCamera(std::move(camera));
}

} // namespace lambert
