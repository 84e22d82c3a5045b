#include "meshing/weld_polygon.h"

#include <algorithm>

namespace lambert {

namespace {

bool isNeedle(const Scene& scene, const Polygon& polygon, float tolerance) {
    const double height = (polygon.isQuad() ? 1.0 : 2.0) * polygonArea(scene, polygon) / longestEdge(scene, polygon);
    return !(height > static_cast<double>(tolerance));
}

} // namespace

std::optional<WeldedPolygon> weldPolygon(const Polygon& polygon, std::span<const std::uint32_t> representative,
                                         const Scene& scene, float tolerance) {
    WeldedPolygon welded{polygon};
    auto& vertices = welded.polygon.vertices;
    std::size_t count = 0;
    for (std::size_t k = 0; k < static_cast<std::size_t>(polygon.size()); ++k) {
        const std::uint32_t vertex = representative[polygon.vertices[k]];
        const auto end = vertices.begin() + static_cast<std::ptrdiff_t>(count);
        if (std::find(vertices.begin(), end, vertex) != end) continue;
        vertices[count] = vertex;
        welded.corners[count++] = k;
    }
    if (count < 3) return std::nullopt;
    if (count == 3) vertices[3] = kNone;
    if (isNeedle(scene, welded.polygon, tolerance)) return std::nullopt;
    return welded;
}

} // namespace lambert
