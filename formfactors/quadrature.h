#pragma once

#include <glm/vec3.hpp>

#include <span>
#include <vector>

namespace lambert {

/// A point of a quadrature rule over a surface.
struct WeightedPoint {
    glm::dvec3 point;
    double weight; //!< m²
};

/// Appends `order`² Gauss points over a convex plane polygon of three or four corners, or over each of the quads (and the last
/// triangle) of a fan if it has more; `order` from 1 to 8. Polynomials up to
/// degree 2 order − 1 are integrated exactly (on a quad that is no parallelogram, polynomials of its bilinear chart).
void appendGaussPoints(std::span<const glm::dvec3> polygon, int order, std::vector<WeightedPoint>& points);

} // namespace lambert
