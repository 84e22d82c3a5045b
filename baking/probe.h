#pragma once

#include "baking/reconstruction.h"
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

/// The irradiance at points, #points readings. Direct light, of emitters and of lights without area, is found at the point itself by
/// shadow rays. All other light is interpolated between the vertices of the patch, at points on surfaces, and gathered at
/// others, by rows of the form factors that `options` (those of the solve) name; if they name none, by those of the default
/// method, and of lines without rows by local lines.
///
/// Errors are of shadow rays, and of gathered rows by the spread of four with other random numbers. On a surface they hold by how
/// much interpolation misses the patch's own value at its centre, which is as much of the mesh and of a noisy row as can be
/// told, and the patch's standard error where the solution has one. Throws UsageError, Cancelled.
std::vector<ProbeReading> probeIrradiance(const SolvedScene& scene, const SolveOptions& options,
                                          const ReconstructionOptions& reconstruction,
                                          std::span<const ProbePoint> points, Progress& progress);

} // namespace lambert
