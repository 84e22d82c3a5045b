// EXT_mesh_gpu_instancing: https://github.com/KhronosGroup/glTF/tree/main/extensions/2.0/Vendor/EXT_mesh_gpu_instancing

#include "scene/gltf/instances.h"

#include "scene/gltf/document.h"

#include <fmt/format.h>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/quaternion.hpp>

namespace lambert {

GltfInstances::GltfInstances(const std::string& file, const gltf::Model& model, int node) {
    const auto& attributes = model.nodes[static_cast<std::size_t>(node)].instances;
    bool isFirst = true;
    const auto read = [&](std::optional<GltfAccessor>& accessor, const char* name, GltfAccessor::Use use) {
        const auto found = attributes.find(name);
        if (found == attributes.end()) return;
        const std::string place = fmt::format("/nodes/{}/extensions/EXT_mesh_gpu_instancing/attributes/{}", node, name);
        accessor.emplace(file, model, found->second, use, place);
        if (!isFirst && accessor->count() != count_)
            failAtMember(file, place, fmt::format("{} elements", accessor->count()),
                         fmt::format("{}, as in the other attributes", count_));
        count_ = accessor->count();
        isFirst = false;
    };
    read(translations_, "TRANSLATION", GltfAccessor::Use::Vectors);
    read(rotations_, "ROTATION", GltfAccessor::Use::Rotations);
    read(scales_, "SCALE", GltfAccessor::Use::Vectors);
}

glm::dmat4 GltfInstances::toNode(std::size_t k) const {
    glm::dmat4 transform(1.0);
    if (translations_) transform = glm::translate(transform, glm::dvec3(translations_->element(k)));
    if (rotations_) {
        const glm::dvec4 q(rotations_->element(k)); // x, y, z, w
        // Of length 0: normalize makes it the identity.
        transform *= glm::mat4_cast(glm::normalize(glm::dquat(q.w, q.x, q.y, q.z)));
    }
    if (scales_) transform = glm::scale(transform, glm::dvec3(scales_->element(k)));
    return transform;
}

} // namespace lambert
