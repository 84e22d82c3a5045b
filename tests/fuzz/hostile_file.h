#pragma once

#include <string_view>

namespace lambert {

/// Between a scene and the one file that it may name: a line of its own in the input, see readHostileFile.
inline constexpr std::string_view kCompanionMark = "\n=====\n";

/// Treats `input` as the content of a file of this format ("obj", "glb", "image" for textures, or "solution"), whatever it holds,
/// and takes what comes out of it through the stages that follow: a scene is checked, prepared, meshed with few patches, and
/// rays are cast in it; a solution is written, read again and compared. Formats whose scenes name other files read one: what stands in `input` after kCompanionMark is
/// scene.mtl for an OBJ, scene.bin for a glTF, scene.inc for an MGF.
///
/// An InputError is a good end. Any other exception leaves this function, and a broken promise of Scene, Texture,
/// PatchMesh or Hit aborts the process.
void readHostileFile(std::string_view format, std::string_view input);

} // namespace lambert
