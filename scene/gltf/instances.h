#pragma once

#include "scene/gltf/accessor.h"

#include <glm/mat4x4.hpp>

#include <optional>

namespace lambert {

/// The copies of a node's mesh (EXT_mesh_gpu_instancing); a single one without the extension.
class GltfInstances {
public:
    /// `node` is an index of the model. Throws InputError with `file` and the JSON path if the accessors are wrong or
    /// differ in their numbers of elements.
    GltfInstances(const std::string& file, const gltf::Model& model, int node);

    std::size_t count() const { return count_; }
    /// From copy `k` < count() to the node's space.
    glm::dmat4 toNode(std::size_t k) const;

private:
    std::size_t count_ = 1;
    std::optional<GltfAccessor> translations_, rotations_, scales_;
};

} // namespace lambert
