#pragma once

#include "scene/reading.h"

namespace lambert {

/// Reads a .mgf file, see readScene. Throws InputError with file and place.
ReadResult readMgf(const std::filesystem::path& path, const ReadOptions& options);

} // namespace lambert
