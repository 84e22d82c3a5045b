#pragma once

#include "scene/reading.h"

namespace lambert {

/// Reads a .obj file, see readScene. Throws InputError with file and place.
ReadResult readObj(const std::filesystem::path& path, const ReadOptions& options);

} // namespace lambert
