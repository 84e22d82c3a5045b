#pragma once

#include <glm/vec2.hpp>

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace lambert {

/// Constrained Delaunay triangulation of a simple polygon.
///
/// `points[0 .. borderCount)` is the border, in order, counter-clockwise; the points after it lie inside and
/// become vertices too. `constraints` are pairs of point indices that must appear as edges (chains of edges,
/// where they pass through other points). No point is added.
///
/// Returns counter-clockwise triangles of point indices that cover the polygon, or nothing if the border or
/// the constraints cross themselves or each other, or if two points coincide.
std::optional<std::vector<std::array<std::uint32_t, 3>>>
triangulatePolygon(std::span<const glm::dvec2> points, std::size_t borderCount,
                   std::span<const std::array<std::uint32_t, 2>> constraints = {});

} // namespace lambert
