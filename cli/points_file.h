#pragma once

#include "baking/probe.h"

#include <filesystem>
#include <vector>

namespace lambert {

/// Points from a CSV: x,y,z,nx,ny,nz in metres; # starts a comment, one header line is allowed, further columns are not read.
/// Throws InputError with file and line; a file without points is one too.
std::vector<ProbePoint> readPoints(const std::filesystem::path& path);

} // namespace lambert
