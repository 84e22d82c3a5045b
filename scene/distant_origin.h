#pragma once

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include <limits>

namespace lambert {

/// Axis-aligned box around places of a file, in metres.
struct PlaceBounds {
    glm::dvec3 lower{std::numeric_limits<double>::max()};
    glm::dvec3 upper{std::numeric_limits<double>::lowest()};

    void add(const glm::dvec3& place) {
        lower = glm::min(lower, place);
        upper = glm::max(upper, place);
    }
    double diagonal() const {
        return lower.x <= upper.x ? glm::length(upper - lower) : 0.0;
    } //!< 0 if nothing was added
};

/// How many of its diagonals a scene may reach along an axis before single precision, which is 2^-24 of the coordinate off,
/// is off by more than 1e-6 of the diagonal: the length below which vertices are taken for one (see weldTolerance).
inline constexpr double kMostDiagonals = 16.0;

/// What is to be subtracted from the places of a scene with these bounds, in metres: a point near the middle along each axis
/// on which it reaches beyond kMostDiagonals of its diagonals, 0 on the others. A multiple of the power of two below the
/// diagonal, so that the difference of a double is exact.
glm::dvec3 distantOrigin(const PlaceBounds& bounds);

} // namespace lambert
