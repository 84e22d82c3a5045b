#pragma once

#include <glm/vec2.hpp>

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace lambert {

/// Constrained Delaunay triangulation of a polygon that does not cross itself.
///
/// `points[0 .. borderCount)` is the border, in order, counter-clockwise. It may touch itself: an edge that is walked in
/// both directions, such as the bridge to a hole, is no border, and of points that coincide there the triangles name the
/// first. The points after the border lie inside and become vertices too. `constraints` are pairs of point indices that
/// must appear as edges (chains of edges, where they pass through other points). No point is added.
///
/// Returns counter-clockwise triangles of point indices that cover the polygon once, or nothing if the border or the
/// constraints cross themselves or each other, if the border covers something twice or clockwise, or if two points
/// coincide that are consecutive or not both on the border, or more than 1,000.
std::optional<std::vector<std::array<std::uint32_t, 3>>>
triangulatePolygon(std::span<const glm::dvec2> points, std::size_t borderCount,
                   std::span<const std::array<std::uint32_t, 2>> constraints = {});

/// Constrained Delaunay triangulation of a polygon with holes.
///
/// The loops stand in `points` one after the other, `loopSizes` points each, every last point joined to the loop's first.
/// Inside is what an odd number of loop edges separates from infinity: holes may be given in either direction, loops may
/// touch at points, and an edge that is given twice (the seam by which a loop takes in a hole) counts as none.
///
/// Parity, where triangulatePolygon counts windings: files give holes in either direction, and a border that covers a place
/// twice is a mistake there but a hole here.
///
/// Returns counter-clockwise triangles of point indices, or nothing if edges cross or nothing is inside.
std::optional<std::vector<std::array<std::uint32_t, 3>>> triangulateLoops(std::span<const glm::dvec2> points,
                                                                          std::span<const std::size_t> loopSizes);

/// Constrained Delaunay triangulation of the convex hull of points, in which every line (a pair of point indices) is an edge, or a
/// chain of edges where it passes through other points.
///
/// Returns counter-clockwise triangles of point indices, or nothing if lines cross, two points coincide or all lie on a line.
std::optional<std::vector<std::array<std::uint32_t, 3>>>
triangulateLines(std::span<const glm::dvec2> points, std::span<const std::array<std::uint32_t, 2>> lines);

} // namespace lambert
