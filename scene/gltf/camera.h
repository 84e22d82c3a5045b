#pragma once

#include "scene/gltf/nodes.h"
#include "scene/scene_builder.h"

namespace lambert {

/// Adds the camera at a node, if there is one. Throws InputError with `file` and the JSON path if a number is out of
/// range; orthographic cameras and singular transforms are left out with a warning.
void addGltfCamera(const std::string& file, const gltf::Model& model, const GltfNode& node, SceneBuilder& builder);

} // namespace lambert
