#pragma once

#include "scene/scene.h"

#include <glm/vec2.hpp>

namespace lambert {

/// The intensity of a point light or spot (per sr) toward a direction of unit length; the illuminance across (per m²) of a
/// directional one.
Rgb intensityToward(const PunctualLight& light, const glm::vec3& direction);

/// All that leaves a point light or spot: ∫ I dω.
glm::dvec3 totalFlux(const PunctualLight& light);

/// Maps the unit square to directions (unit length) whose density is proportional to the intensity of a point light or spot.
glm::dvec3 sampleDirection(const PunctualLight& light, const glm::dvec2& u);

} // namespace lambert
