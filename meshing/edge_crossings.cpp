#include "meshing/edge_crossings.h"

#include "meshing/pair_triangles.h"
#include "meshing/weld.h"
#include "scene/box_index.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <optional>

namespace lambert {

namespace {

struct Segment {
    glm::dvec3 from, direction;
    double length;
};

/// Where two segments cross, away from all four ends; nothing if they are parallel or pass each other.
std::optional<glm::vec3> crossing(const Segment& one, const Segment& two, double tolerance) {
    // Closest points of two lines: from + t direction and from + s direction.
    const glm::dvec3 offset = two.from - one.from;
    const double across = glm::dot(one.direction, two.direction);
    const double determinant = 1.0 - across * across;
    if (determinant < 1e-6) return std::nullopt;
    const double alongOne = glm::dot(offset, one.direction);
    const double alongTwo = glm::dot(offset, two.direction);
    const double t = (alongOne - across * alongTwo) / determinant;
    const double s = (across * alongOne - alongTwo) / determinant;
    if (t < tolerance || t > one.length - tolerance || s < tolerance || s > two.length - tolerance) return std::nullopt;
    const glm::dvec3 p = one.from + t * one.direction;
    const glm::dvec3 q = two.from + s * two.direction;
    if (glm::distance(p, q) > tolerance) return std::nullopt;
    return glm::vec3(0.5 * (p + q));
}

} // namespace

std::vector<std::pair<std::uint32_t, std::uint32_t>> uniqueEdges(const Scene& scene) {
    std::vector<std::pair<std::uint32_t, std::uint32_t>> edges;
    edges.reserve(scene.polygons.size() * 3);
    for (const Polygon& polygon : scene.polygons)
        for (int k = 0; k < polygon.size(); ++k) edges.push_back(edgeOf(polygon, k));
    std::sort(edges.begin(), edges.end());
    edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
    return edges;
}

std::vector<glm::vec3> edgeCrossings(const Scene& scene, float tolerance) {
    const auto edges = uniqueEdges(scene);
    const BoxIndex index(boxesOf(scene.positions, edges, tolerance));
    const auto segment = [&](std::uint32_t edge) {
        const glm::dvec3 a(scene.positions[edges[edge].first]);
        const glm::dvec3 b(scene.positions[edges[edge].second]);
        const double length = glm::distance(a, b);
        return Segment{a, (b - a) / length, length};
    };
    const std::size_t vertexCount = scene.positions.size();
    std::vector<glm::vec3> points = scene.positions;
    std::vector<std::uint32_t> near;
    for (std::uint32_t i = 0; i < edges.size(); ++i) {
        index.nearLater(i, near);
        if (near.empty()) continue;
        const Segment one = segment(i);
        for (const std::uint32_t j : near)
            if (const auto point = crossing(one, segment(j), static_cast<double>(tolerance))) points.push_back(*point);
    }
    const std::vector<std::uint32_t> representative = weldPositions(points, tolerance);
    std::vector<glm::vec3> crossings;
    for (std::size_t i = vertexCount; i < points.size(); ++i)
        if (representative[i] == i) crossings.push_back(points[i]);
    return crossings;
}

} // namespace lambert
