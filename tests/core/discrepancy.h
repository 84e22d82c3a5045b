#pragma once

#include <glm/vec2.hpp>

#include <span>

namespace lambert {

/// The star discrepancy of points in [0, 1)²: the largest difference between a box's area and its share of the points,
/// over all boxes with a corner in the origin. Exact; takes O(n²) time and O(n) memory.
double starDiscrepancy(std::span<const glm::dvec2> points);

/// The L2 star discrepancy in any dimension: `coordinates` holds the points one after the other.
/// T. T. Warnock, "Computational investigations of low-discrepancy point sets", 1972. O(n² · dimensions).
double l2StarDiscrepancy(std::span<const double> coordinates, std::size_t dimensions);

} // namespace lambert
