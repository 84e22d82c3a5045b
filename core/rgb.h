#pragma once

#include <glm/vec3.hpp>

namespace lambert {

/// Linear RGB, Rec. 709 primaries.
using Rgb = glm::vec3;

/// Sums over patches and time, in double.
using RgbSum = glm::dvec3;

/// Over the channels.
inline double sumOf(const RgbSum& c) { return c.x + c.y + c.z; }

} // namespace lambert
