#pragma once

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace lambert {

/// Newell's normal: twice the area vector, also of polygons that are concave or not quite planar.
glm::dvec3 newellNormal(std::span<const glm::dvec3> points);

/// Whether every corner turns left, seen against `normal` (unit length), by more than rounding.
bool isConvex(std::span<const glm::dvec3> points, const glm::dvec3& normal);

/// Distance of the farthest vertex from the plane through the centroid, in the unit of the points.
double offPlane(std::span<const glm::dvec3> points, const glm::dvec3& normal);

/// The polygon in its own plane, counter-clockwise.
std::vector<glm::dvec2> projected(std::span<const glm::dvec3> points, const glm::dvec3& normal);

/// The area of the first loop less all others, whichever way they turn. `points` loop after loop, `loopSizes` many each.
double areaWithHoles(std::span<const glm::dvec2> points, std::span<const std::size_t> loopSizes);

/// The area of all triangles, into `points`; counter-clockwise ones count as positive.
double areaOf(std::span<const std::array<std::uint32_t, 3>> triangles, std::span<const glm::dvec2> points);

} // namespace lambert
