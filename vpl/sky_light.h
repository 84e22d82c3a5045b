#pragma once

#include "core/progress.h"
#include "scene/rays/ray_caster.h"
#include "vpl/receiver.h"

#include <cstdint>
#include <span>
#include <vector>

namespace lambert {

/// The irradiance that the environment of the scene gives directly to receivers, by this many rays from each (see DirectLight):
/// #receivers, or nothing without an environment. The same whatever the number of threads. Throws Cancelled.
std::vector<glm::dvec3> skyLight(const RayCaster& rays, std::span<const Receiver> receivers, std::uint32_t skyRays,
                                 std::uint64_t seed, Progress& progress);

/// The radiance that receivers with gloss send to their eyes of the environment, by this many rays from each,
/// distributed as their lobes: #receivers, or nothing without an environment or gloss. Otherwise as above.
std::vector<glm::dvec3> glossySkyLight(const RayCaster& rays, std::span<const Receiver> receivers,
                                       std::uint32_t skyRays, std::uint64_t seed, Progress& progress);

} // namespace lambert
