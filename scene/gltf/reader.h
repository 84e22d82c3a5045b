#pragma once

#include "scene/reading.h"

namespace lambert {

/// Reads a .gltf or .glb file, see readScene. Throws InputError with file and place.
ReadResult readGltf(const std::filesystem::path& path, const ReadOptions& options);

} // namespace lambert
