#pragma once

#include "scene/gltf/model.h"

#include <glm/mat4x4.hpp>

#include <string>
#include <vector>

namespace lambert {

/// A node of the scene that is read, with the transform from its own space to the world's.
struct GltfNode {
    int index; //!< into the model's nodes
    glm::dmat4 toWorld;
};

/// The nodes of the default scene (else the first, else everything below the nodes without a parent), each
/// before its children, in the file's order. Throws InputError with `file` and the JSON path if an index is
/// out of range, if a node is reached twice (a cycle, or two parents), or if a rotation is 0.
std::vector<GltfNode> collectGltfNodes(const std::string& file, const gltf::Model& model);

/// How much longer a transform makes the axis that it stretches most.
double largestScale(const glm::dmat4& transform);

} // namespace lambert
