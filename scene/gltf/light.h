#pragma once

#include "scene/gltf/nodes.h"
#include "scene/scene_builder.h"

namespace lambert {

/// Adds the light of KHR_lights_punctual that stands at a node, if there is one. Throws InputError with `file` and the
/// JSON path if a number is out of range; a light whose transform is singular is left out with a warning.
void addGltfLight(const std::string& file, const gltf::Model& model, const GltfNode& node, SceneBuilder& builder);

} // namespace lambert
