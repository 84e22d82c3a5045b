#include "scene/coplanar_sides.h"

#include <algorithm>

namespace lambert {

std::uint32_t materialOf(const Scene& scene, const PolygonSide& side) {
    if (side.polygon == kNone) return kNone;
    const Polygon& polygon = scene.polygons[side.polygon];
    return side.back ? polygon.backMaterial : polygon.material;
}

bool emits(const Scene& scene, const PolygonSide& side) {
    const std::uint32_t material = materialOf(scene, side);
    return material != kNone && scene.materials[material].emittedRadiance != Rgb(0.0F);
}

PolygonSide seenSide(const Scene& scene, std::span<const PolygonSide> sides,
                     const std::function<bool(std::uint32_t, std::uint32_t)>& liesOver) {
    return *std::min_element(sides.begin(), sides.end(), [&](const PolygonSide& a, const PolygonSide& b) {
        const bool emitsA = emits(scene, a);
        const bool emitsB = emits(scene, b);
        if (emitsA != emitsB) return emitsA;
        if (a.back != b.back) return !a.back;
        return a.back ? liesOver(b.polygon, a.polygon) : liesOver(a.polygon, b.polygon);
    });
}

} // namespace lambert
