#pragma once

#include "cli/scene_arguments.h"

#include <filesystem>
#include <vector>

namespace lambert {

/// The files a scene is read from: itself first, then those it names, whether they exist or not: of an OBJ the material
/// libraries and their textures, of glTF the buffers and images, of a PLY the textures, of an MGF what it includes. Throws
/// InputError if the scene's own file cannot be read.
std::vector<std::filesystem::path> filesOfScene(const std::filesystem::path& scene);

/// These, and the file of overrides, whether it is used or not.
std::vector<std::filesystem::path> inputFiles(const SceneArguments& arguments);

} // namespace lambert
