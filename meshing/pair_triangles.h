#pragma once

#include "scene/scene.h"

#include <array>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace lambert {

using Corners = std::array<std::uint32_t, 4>; ///< vertex indices; a triangle ends in kNone

/// An undirected edge as a key: the smaller vertex first.
inline std::pair<std::uint32_t, std::uint32_t> edgeKey(std::uint32_t a, std::uint32_t b) {
    return a < b ? std::pair(a, b) : std::pair(b, a);
}
/// That of a polygon from corner `k` to the next.
inline std::pair<std::uint32_t, std::uint32_t> edgeOf(const Polygon& polygon, int k) {
    return edgeKey(polygon.vertices[static_cast<std::size_t>(k)],
                   polygon.vertices[static_cast<std::size_t>((k + 1) % polygon.size())]);
}

/// The faces that became one.
struct FaceOrigin {
    std::uint32_t first = 0;
    std::uint32_t second = kNone; //!< of a pair
    bool operator==(const FaceOrigin&) const = default;
};

/// Joins coplanar triangles that share an edge into convex quads, best pairs first (corner angles closest to 90°),
/// and leaves pairs that would make a quad with a corner below 45° or above 135° alone.
///
/// `faces` are triangles and quads; only triangles of the same `group` (#faces) are joined. Edges in `fixed` (sorted)
/// stay. A quad takes the place of its first triangle, the place of its second is dropped, order is kept otherwise. The edge
/// that a quad's triangles shared joins its corners 0 and 2. Returns for each resulting face what it came from; `faces` is
/// changed in place.
std::vector<FaceOrigin> pairTriangles(std::vector<Corners>& faces, std::span<const std::uint32_t> group,
                                      std::span<const glm::vec3> positions,
                                      std::span<const std::pair<std::uint32_t, std::uint32_t>> fixed = {});

} // namespace lambert
