#pragma once

#include "baking/final_gather.h"
#include "lighting/solve_scene.h"

#include <span>
#include <vector>

namespace lambert {

/// A virtual sensor.
struct ProbePoint {
    glm::vec3 position; //!< metres
    glm::vec3 normal;   //!< need not have unit length, not 0
};

/// NaN in both where there is no number to stand for: where a point sees nothing but backs, as inside a solid or on a hidden face, and
/// where the error is as large as the light, as by one ray that leaked.
struct ProbeReading {
    RgbSum irradiance{0.0};    //!< E per m²
    RgbSum standardError{0.0}; //!< see probeIrradiance
    bool onSurface = false;    //!< within 1e-4 of the scene's diagonal of a front that has about this normal
};

/// The irradiance at points, #points readings, gathered at the points themselves (see FinalGather), on surfaces and in the air.
///
/// Errors are those of the gather's rays. Throws UsageError for options out of range, Cancelled.
std::vector<ProbeReading> probeIrradiance(const SolvedScene& scene, const FinalGatherOptions& options,
                                          std::span<const ProbePoint> points, Progress& progress);

} // namespace lambert
