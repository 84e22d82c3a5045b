#pragma once

#include "baking/bake_scene.h"

#include <span>
#include <vector>

namespace lambert {

/// A virtual sensor.
struct ProbePoint {
    glm::vec3 position; //!< metres
    glm::vec3 normal;   //!< need not have unit length, not 0
};

struct ProbeReading {
    RgbSum irradiance{0.0};    //!< E per m²
    RgbSum standardError{0.0}; //!< 0 for deterministic methods
    bool onSurface = false;    //!< interpolated in the solution; else gathered at the point
};

/// The irradiance at points, #points readings. A point on a surface (within 1e-4 of the scene's diagonal, the normal to its
/// front) is interpolated between the vertices of its patch; at any other the light is gathered by a hemicube.
std::vector<ProbeReading> probeIrradiance(const BakedScene& scene, std::span<const ProbePoint> points);

} // namespace lambert
