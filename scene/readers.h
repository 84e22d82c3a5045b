#pragma once

#include "scene/reading.h"

namespace lambert {

/// The readers of the file formats behind readScene, which see. Each throws InputError with file and place.
/// `options.progress` must not be null.
ReadResult readGltf(const std::filesystem::path& path, const ReadOptions& options); ///< .gltf and .glb
ReadResult readMgf(const std::filesystem::path& path, const ReadOptions& options);
ReadResult readObj(const std::filesystem::path& path, const ReadOptions& options);
ReadResult readPly(const std::filesystem::path& path, const ReadOptions& options);
ReadResult readStl(const std::filesystem::path& path, const ReadOptions& options);

} // namespace lambert
