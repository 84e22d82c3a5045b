#pragma once

#include "scene/scene.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

namespace lambert {

/// A polygon on welded vertices.
struct WeldedPolygon {
    Polygon polygon;
    std::array<std::size_t, 4> corners{0, 1, 2, 3}; //!< which of the original's are left
};

/// A polygon with every vertex replaced by its representative (#Scene::positions, see weldPositions), without repeated corners; nothing
/// if less than a triangle is left, or a needle that is no higher over its longest edge than `tolerance` (metres): its vertices lie on
/// its own edges.
std::optional<WeldedPolygon> weldPolygon(const Polygon& polygon, std::span<const std::uint32_t> representative,
                                         const Scene& scene, float tolerance);

} // namespace lambert
