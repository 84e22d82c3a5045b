#pragma once

#include "scene/rays/ray_caster.h"

#include <glm/vec3.hpp>

#include <array>

namespace lambert {

/// One face of a turned hemicube: the pixel at (u, v) looks along axis + u·axisU + v·axisV.
struct HemicubeFace {
    glm::vec3 axis, axisU, axisV;
    int columns, rows; ///< pixels; u covers [−1, 1], v covers [−1, 1] on the top and [0, 1] on the sides
    bool top;
};

/// Top first, then the four sides.
std::array<HemicubeFace, 5> hemicubeFaces(const glm::vec3& normal, float angle, int resolution);

/// Directions of the tile of 4 × 4 pixels that begins at (column, row), a pixel along a row after the other. Pixels past the
/// face's end are inactive.
void tileDirections(const HemicubeFace& face, int column, int row, int resolution, RayPacket& packet);

} // namespace lambert
