#include "meshing/join_triangles.h"

#include "meshing/pair_triangles.h"

#include <algorithm>
#include <array>
#include <utility>

namespace lambert {

namespace {

using Edge = std::pair<std::uint32_t, std::uint32_t>;

constexpr float kAgreement = 1e-5F; ///< of texture coordinates (relative beyond 1) and tints

std::size_t cornerAt(const Polygon& polygon, std::uint32_t vertex) {
    return static_cast<std::size_t>(std::find(polygon.vertices.begin(), polygon.vertices.end(), vertex) -
                                    polygon.vertices.begin());
}

bool agree(float a, float b) { return std::abs(a - b) <= kAgreement * std::max(1.0F, std::abs(a)); }

bool agree(const SurfaceCorners& a, std::size_t i, const SurfaceCorners& b, std::size_t j) {
    for (int k = 0; k < 2; ++k)
        if (!agree(a.uv[i][k], b.uv[j][k]) || !agree(a.emissionUv[i][k], b.emissionUv[j][k])) return false;
    for (int k = 0; k < 3; ++k)
        if (!agree(a.tint[i][k], b.tint[j][k])) return false;
    return true;
}

/// Whether two polygons show the same at a vertex they share.
bool agreeAt(const Scene& scene, const Polygon& one, const Polygon& two, std::uint32_t vertex) {
    const auto sides = {std::pair(one.surface, two.surface), std::pair(one.backSurface, two.backSurface)};
    return std::all_of(sides.begin(), sides.end(), [&](const auto& side) {
        const auto [a, b] = side;
        if (a == kNone || b == kNone) return a == b;
        return agree(scene.surfaces[a], cornerAt(one, vertex), scene.surfaces[b], cornerAt(two, vertex));
    });
}

/// Edges of triangles across which surfaces do not go on; sorted.
std::vector<Edge> seams(const Scene& scene) {
    std::vector<std::pair<Edge, std::uint32_t>> edges;
    for (std::uint32_t i = 0; i < scene.polygons.size(); ++i) {
        const Polygon& polygon = scene.polygons[i];
        if (polygon.isQuad() || (polygon.surface == kNone && polygon.backSurface == kNone)) continue;
        const auto& v = polygon.vertices;
        for (std::size_t k = 0; k < 3; ++k) edges.emplace_back(edgeKey(v[k], v[(k + 1) % 3]), i);
    }
    std::sort(edges.begin(), edges.end());
    std::vector<Edge> result;
    for (std::size_t k = 1; k < edges.size(); ++k) {
        const auto& [edge, polygon] = edges[k];
        if (edges[k - 1].first != edge) continue;
        const Polygon& one = scene.polygons[edges[k - 1].second];
        const Polygon& two = scene.polygons[polygon];
        if (!agreeAt(scene, one, two, edge.first) || !agreeAt(scene, one, two, edge.second)) result.push_back(edge);
    }
    return result;
}

/// The numbers of triangles that may be joined: alike in node, materials, and whether they have surfaces.
std::vector<std::uint32_t> groups(const Scene& scene) {
    const auto key = [](const Polygon& p) {
        return std::array<std::uint32_t, 5>{p.node, p.material, p.backMaterial, p.surface == kNone,
                                            p.backSurface == kNone};
    };
    std::vector<std::array<std::uint32_t, 5>> keys;
    for (const Polygon& polygon : scene.polygons) keys.push_back(key(polygon));
    std::sort(keys.begin(), keys.end());
    keys.erase(std::unique(keys.begin(), keys.end()), keys.end());
    std::vector<std::uint32_t> result;
    for (const Polygon& polygon : scene.polygons)
        result.push_back(
            static_cast<std::uint32_t>(std::lower_bound(keys.begin(), keys.end(), key(polygon)) - keys.begin()));
    return result;
}

/// The surface of a quad whose corners are those of two triangles.
std::uint32_t joinedSurface(Scene& scene, const Corners& quad, const Polygon& one, std::uint32_t surfaceOne,
                            const Polygon& two, std::uint32_t surfaceTwo) {
    if (surfaceOne == kNone) return kNone;
    SurfaceCorners joined;
    for (std::size_t k = 0; k < 4; ++k) {
        std::size_t from = cornerAt(one, quad[k]);
        const bool second = from == 4;
        if (second) from = cornerAt(two, quad[k]);
        const SurfaceCorners& source = scene.surfaces[second ? surfaceTwo : surfaceOne];
        joined.uv[k] = source.uv[from];
        joined.emissionUv[k] = source.emissionUv[from];
        joined.tint[k] = source.tint[from];
    }
    scene.surfaces.push_back(joined);
    return static_cast<std::uint32_t>(scene.surfaces.size() - 1);
}

Polygon joinedPolygon(Scene& scene, Corners quad, const Polygon& one, const Polygon& two) {
    Polygon polygon = one;
    if (one.surface != kNone || one.backSurface != kNone) {
        std::rotate(quad.begin(), quad.begin() + 1, quad.end()); // the diagonal from corners 0 and 2 to 1 and 3
        polygon.surface = joinedSurface(scene, quad, one, one.surface, two, two.surface);
        polygon.backSurface = one.backSurface == one.surface
                                  ? polygon.surface
                                  : joinedSurface(scene, quad, one, one.backSurface, two, two.backSurface);
    }
    polygon.vertices = quad;
    return polygon;
}

} // namespace

std::size_t joinTriangles(Scene& scene) {
    std::vector<Corners> faces;
    for (const Polygon& polygon : scene.polygons) faces.push_back(polygon.vertices);
    const std::vector<FaceOrigin> origins = pairTriangles(faces, groups(scene), scene.positions, seams(scene));
    std::vector<Polygon> joined;
    joined.reserve(faces.size());
    for (std::size_t i = 0; i < faces.size(); ++i) {
        const auto [first, second] = origins[i];
        joined.push_back(second == kNone
                             ? scene.polygons[first]
                             : joinedPolygon(scene, faces[i], scene.polygons[first], scene.polygons[second]));
    }
    const std::size_t pairs = scene.polygons.size() - joined.size();
    scene.polygons = std::move(joined);
    return pairs;
}

} // namespace lambert
