#pragma once

#include "scene/scene.h"

#include <cstdint>
#include <functional>
#include <span>

namespace lambert {

/// One side of a polygon.
struct PolygonSide {
    std::uint32_t polygon = kNone; //!< into Scene::polygons
    bool back = false;

    bool operator==(const PolygonSide&) const = default;
};

/// Of a side's material, into Scene::materials; none: black.
std::uint32_t materialOf(const Scene& scene, const PolygonSide& side);

bool emits(const Scene& scene, const PolygonSide& side);

/// Which of several sides that lie in one plane and face the same way is seen; at least one.
///
/// What emits hides what does not. Then fronts hide backs: of two polygons back to back each shows its front. Of several fronts the
/// highest is seen, of several backs the lowest, as in a pile that is looked at from above and from below. `liesOver` says of two
/// polygons that face the same way whether the first lies over the second.
PolygonSide seenSide(const Scene& scene, std::span<const PolygonSide> sides,
                     const std::function<bool(std::uint32_t, std::uint32_t)>& liesOver);

} // namespace lambert
