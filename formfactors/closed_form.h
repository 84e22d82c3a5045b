#pragma once

#include <glm/vec3.hpp>

#include <span>
#include <vector>

namespace lambert {

/// Form factors between plane polygons that nothing stands between, in double precision. Polygons are simple, at least three
/// vertices, counter-clockwise seen from their front.

/// Half the sum of the cross products: points to the front, its length is the area.
glm::dvec3 polygonAreaVector(std::span<const glm::dvec3> polygon);

/// The part of a polygon on the positive side of the plane through `point` with this `normal`; empty if there is none. What
/// a concave polygon falls apart into stays connected by edges in the plane that are walked both ways.
std::vector<glm::dvec3> clippedToHalfSpace(std::span<const glm::dvec3> polygon, const glm::dvec3& point,
                                           const glm::dvec3& normal);

/// The fraction of what leaves a surface element at `point` (unit `normal`) that reaches the polygon's front; 0 from behind.
double pointToPolygon(const glm::dvec3& point, const glm::dvec3& normal, std::span<const glm::dvec3> polygon);

/// The same for a polygon that faces the element and lies above its horizon wholly: nothing is checked or clipped.
double pointToVisiblePolygon(const glm::dvec3& point, const glm::dvec3& normal, std::span<const glm::dvec3> polygon);

/// How carefully a contour integral is computed.
enum class Care {
    Full,   ///< to about 1e-12 of its value or 1e-15 of the smaller area, whichever is more
    Single, ///< for corners rounded to single precision, many times as fast: to about 1e-6
    Rough   ///< the same, to about 1e-4
};

/// A_from · F_from,to, in m²: the same in both directions.
double exchangeArea(std::span<const glm::dvec3> from, std::span<const glm::dvec3> to, Care care = Care::Full);

} // namespace lambert
