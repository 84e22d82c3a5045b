#pragma once

#include <glm/vec3.hpp>

#include <array>
#include <cstdint>
#include <vector>

namespace lambert {

/// A curved surface as planar facets, front counter-clockwise. Its corners lie on the surface, so that it stays inside
/// what it encloses and its rims fit those of other shapes with the same axis and number of segments; area and volume
/// are too small by a share of order 1 / segments².
struct Facets {
    std::vector<glm::dvec3> points;
    std::vector<std::array<std::uint32_t, 4>> faces; //!< into points; triangles end in kNone
};

// `segments` (even, at least 4) divides a full circle. Fronts look outwards, or inwards where the radii are negative.

/// Closed. radius != 0.
Facets sphereFacets(const glm::dvec3& centre, double radius, int segments);
/// Open at both ends. The points differ; the radii are not both 0 and not of opposite sign.
Facets coneFacets(const glm::dvec3& from, double fromRadius, const glm::dvec3& to, double toRadius, int segments);
/// Front along `normal` (unit length). 0 <= inner < outer.
Facets ringFacets(const glm::dvec3& centre, const glm::dvec3& normal, double inner, double outer, int segments);
/// Closed, about the axis `normal` (unit length). |inner| < |outer|, not of opposite sign.
Facets torusFacets(const glm::dvec3& centre, const glm::dvec3& normal, double inner, double outer, int segments);

} // namespace lambert
