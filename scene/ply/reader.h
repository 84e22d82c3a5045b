#pragma once

#include "scene/reading.h"

namespace lambert {

/// Reads a .ply file, see readScene. Throws InputError with file and place.
ReadResult readPly(const std::filesystem::path& path, const ReadOptions& options);
/// The same for an .stl file.
ReadResult readStl(const std::filesystem::path& path, const ReadOptions& options);

} // namespace lambert
