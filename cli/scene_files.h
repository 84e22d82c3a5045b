#pragma once

#include <filesystem>
#include <vector>

namespace lambert {

/// The files a scene is read from: itself first, then those it names, whether they exist or not: of an OBJ the material
/// libraries and their textures, of a .gltf the buffers and images. Throws InputError if the scene's own file cannot be
/// read.
std::vector<std::filesystem::path> filesOfScene(const std::filesystem::path& scene);

} // namespace lambert
