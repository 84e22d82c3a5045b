#pragma once

#include "scene/scene_builder.h"

namespace tinygltf {
class Model;
}

namespace lambert {

/// Adds all materials of the model to the builder, in its order, with warnings for what Lambert leaves out,
/// and returns their indices: #materials of the model. Throws InputError with the JSON path if a number is
/// negative or not finite.
std::vector<std::uint32_t> addGltfMaterials(const std::string& file, const tinygltf::Model& model,
                                            SceneBuilder& builder);

} // namespace lambert
