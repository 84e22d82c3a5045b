#include "meshing/edge_division.h"

#include "meshing/edge_crossings.h"
#include "meshing/pair_triangles.h"
#include "meshing/prepare.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

namespace lambert {

namespace {

using Key = std::pair<std::uint32_t, std::uint32_t>;

std::uint32_t partsFor(double length, double target) {
    // A hair above a whole number of parts must not cost a whole part.
    const double parts = std::ceil(length / target - 1e-3);
    return static_cast<std::uint32_t>(std::clamp(parts, 1.0, 65535.0));
}

} // namespace

EdgeDivision::EdgeDivision(const Scene& scene, const BoxIndex& index, double targetLength,
                           std::vector<glm::vec3>& positions) {
    const std::vector<Key> edges = uniqueEdges(scene);
    insertVertices(scene, index, edges);
    collectSegments(edges, scene.positions.size());
    for (Segment& segment : segments_) {
        const float length = glm::distance(scene.positions[segment.key.first], scene.positions[segment.key.second]);
        segment.parts = partsFor(static_cast<double>(length), targetLength);
    }
    balanceQuads(scene);
    for (Segment& segment : segments_) {
        if (segment.parts == 1) continue;
        segment.firstPoint = static_cast<std::uint32_t>(positions.size());
        const glm::dvec3 a(scene.positions[segment.key.first]);
        const glm::dvec3 b(scene.positions[segment.key.second]);
        for (std::uint32_t i = 1; i < segment.parts; ++i)
            positions.emplace_back(glm::mix(a, b, static_cast<double>(i) / static_cast<double>(segment.parts)));
    }
}

void EdgeDivision::insertVertices(const Scene& scene, const BoxIndex& index, const std::vector<Key>& edges) {
    const float tolerance = 2.0F * weldTolerance(scene);
    std::vector<std::uint32_t> found;
    std::vector<std::pair<float, std::uint32_t>> onEdge;
    for (const Key& key : edges) {
        const glm::vec3 a = scene.positions[key.first];
        const glm::vec3 b = scene.positions[key.second];
        const glm::vec3 direction = b - a;
        const float squaredLength = glm::dot(direction, direction);
        onEdge.clear();
        // The box of a long oblique edge is mostly empty: look along it in pieces.
        const glm::vec3 extent = glm::abs(direction);
        const float oblique = extent.x + extent.y + extent.z - std::max({extent.x, extent.y, extent.z});
        const int pieces = oblique > 1000.0F * tolerance ? 8 : 1;
        for (int piece = 0; piece < pieces; ++piece) {
            const glm::vec3 p = a + direction * (static_cast<float>(piece) / static_cast<float>(pieces));
            const glm::vec3 q = a + direction * (static_cast<float>(piece + 1) / static_cast<float>(pieces));
            index.meeting(Bounds{glm::min(p, q), glm::max(p, q)}.grownBy(tolerance), found);
            for (const std::uint32_t vertex : found) {
                if (vertex == key.first || vertex == key.second) continue;
                const glm::vec3 offset = scene.positions[vertex] - a;
                const float t = glm::dot(offset, direction) / squaredLength;
                if (t <= 0.0F || t >= 1.0F || glm::length(offset - t * direction) > tolerance) continue;
                onEdge.emplace_back(t, vertex);
            }
        }
        if (onEdge.empty()) continue;
        std::sort(onEdge.begin(), onEdge.end());
        onEdge.erase(std::unique(onEdge.begin(), onEdge.end()), onEdge.end());
        auto& vertices = inserted_[key];
        for (const auto& [t, vertex] : onEdge) vertices.push_back(vertex);
    }
}

void EdgeDivision::collectSegments(const std::vector<Key>& edges, std::size_t vertexCount) {
    std::vector<Key> keys;
    for (const Key& edge : edges) {
        std::uint32_t previous = edge.first;
        if (const auto it = inserted_.find(edge); it != inserted_.end()) {
            for (const std::uint32_t vertex : it->second) {
                keys.push_back(edgeKey(previous, vertex));
                previous = vertex;
            }
        }
        keys.push_back(edgeKey(previous, edge.second));
    }
    std::sort(keys.begin(), keys.end());
    keys.erase(std::unique(keys.begin(), keys.end()), keys.end());
    firstSegmentAt_.assign(vertexCount + 1, 0);
    segments_.reserve(keys.size());
    for (const Key& key : keys) {
        segments_.push_back({key});
        ++firstSegmentAt_[key.first + 1];
        ++firstSegmentAt_[key.second + 1];
    }
    for (std::size_t i = 0; i < vertexCount; ++i) firstSegmentAt_[i + 1] += firstSegmentAt_[i];
    std::vector<std::uint32_t> next(firstSegmentAt_.begin(), firstSegmentAt_.end() - 1);
    segmentsAt_.resize(2 * keys.size());
    for (std::uint32_t i = 0; i < keys.size(); ++i) {
        segmentsAt_[next[keys[i].first]++] = i;
        segmentsAt_[next[keys[i].second]++] = i;
    }
}

std::uint32_t EdgeDivision::find(std::uint32_t a, std::uint32_t b) const {
    const auto it = std::lower_bound(segments_.begin(), segments_.end(), edgeKey(a, b),
                                     [](const Segment& segment, const Key& key) { return segment.key < key; });
    return static_cast<std::uint32_t>(it - segments_.begin());
}

/// Gives opposite sides of a quad the same number of parts where they nearly have it, so that more quads become grids.
void EdgeDivision::balanceQuads(const Scene& scene) {
    const auto nearlyEqual = [](std::uint32_t low, std::uint32_t high) { return 4 * high <= 5 * low + 4; };
    bool changed = true;
    for (int pass = 0; changed && pass < 10; ++pass) {
        changed = false;
        for (const Polygon& polygon : scene.polygons) {
            if (!polygon.isQuad()) continue;
            const auto& v = polygon.vertices;
            for (std::size_t k = 0; k < 2; ++k) {
                if (inserted_.contains(edgeKey(v[k], v[k + 1])) ||
                    inserted_.contains(edgeKey(v[k + 2], v[(k + 3) % 4])))
                    continue;
                Segment& one = segments_[find(v[k], v[k + 1])];
                Segment& two = segments_[find(v[k + 2], v[(k + 3) % 4])];
                if (one.parts == two.parts) continue;
                const auto [low, high] = std::minmax(one.parts, two.parts);
                if (!nearlyEqual(low, high)) continue;
                one.parts = two.parts = std::max(low, high);
                changed = true;
            }
        }
    }
}

std::vector<std::uint32_t> EdgeDivision::segmentsAt(std::uint32_t vertex) const {
    return {segmentsAt_.begin() + firstSegmentAt_[vertex], segmentsAt_.begin() + firstSegmentAt_[vertex + 1]};
}

std::vector<std::uint32_t> EdgeDivision::segmentVertices(std::uint32_t index) const {
    const Segment& segment = segments_[index];
    std::vector<std::uint32_t> vertices{segment.key.first};
    for (std::uint32_t i = 1; i < segment.parts; ++i) vertices.push_back(segment.firstPoint + i - 1);
    vertices.push_back(segment.key.second);
    return vertices;
}

/// Appends the vertices after a, up to and including b, of the segment between two vertices.
void EdgeDivision::chain(std::uint32_t a, std::uint32_t b, std::vector<std::uint32_t>& vertices) const {
    std::vector<std::uint32_t> inside = segmentVertices(find(a, b));
    if (inside.front() != a) std::reverse(inside.begin(), inside.end());
    vertices.insert(vertices.end(), inside.begin() + 1, inside.end());
}

EdgeDivision::Side EdgeDivision::side(const Polygon& polygon, int k) const {
    const std::uint32_t a = polygon.vertices[static_cast<std::size_t>(k)];
    const std::uint32_t b = polygon.vertices[static_cast<std::size_t>((k + 1) % polygon.size())];
    Side result;
    result.vertices.push_back(a);
    const auto it = inserted_.find(edgeKey(a, b));
    if (it == inserted_.end()) {
        chain(a, b, result.vertices);
        return result;
    }
    std::vector<std::uint32_t> stops = it->second;
    if (a > b) std::reverse(stops.begin(), stops.end());
    stops.push_back(b);
    result.segments = static_cast<int>(stops.size());
    std::uint32_t previous = a;
    for (const std::uint32_t stop : stops) {
        chain(previous, stop, result.vertices);
        previous = stop;
    }
    return result;
}

} // namespace lambert
