#pragma once

#include "scene/reading.h"

#include <filesystem>
#include <string>

namespace lambert {

/// Reads a scene by the extension of its name: .obj, .gltf, .glb, .ply, .stl or .mgf. All lengths of the result are metres.
/// A scene that lies far from the file's origin is read a second time, relative to an origin of its own.
/// Throws InputError, with file and place, if the file cannot be used; UsageError if `metresPerUnit` is not above 0 and finite,
/// or not 1 for glTF.
ReadResult readScene(const std::filesystem::path& path, const ReadOptions& options = {});

/// Whether readScene has a reader for files of this name, and the extensions of which that is so (".obj, .gltf and .glb").
bool hasSceneExtension(const std::filesystem::path& path);
std::string sceneExtensions();

} // namespace lambert
