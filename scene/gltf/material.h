#pragma once

#include "scene/gltf/texture.h"

#include <optional>
#include <vector>

namespace lambert {

/// A material of the model, in the scene.
struct GltfMaterial {
    std::uint32_t index = 0;                                  //!< into Scene::materials
    std::optional<GltfTextureCoordinates> uv{}, emissionUv{}; //!< where its textures lie, if it has them
    bool isInvisible = false;                                 //!< alphaMode MASK leaves nothing of it
};

/// Adds all materials of the model to the builder, in its order, with warnings for what Lambert leaves out, and returns
/// what the meshes need of them: #materials of the model. Images are named relative to `folder`. Throws InputError with
/// the JSON path if a number is negative or not finite, or an index out of range.
std::vector<GltfMaterial> addGltfMaterials(const std::string& file, const std::filesystem::path& folder,
                                           const gltf::Model& model, SceneBuilder& builder);

} // namespace lambert
