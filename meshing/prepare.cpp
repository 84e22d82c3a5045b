#include "meshing/prepare.h"

#include "meshing/edge_crossings.h"
#include "meshing/pair_triangles.h"
#include "meshing/weld.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <optional>
#include <tuple>

namespace lambert {

namespace {

/// Whether a polygon is no higher over its longest edge than `tolerance`: its vertices lie on its own edges.
bool isNeedle(const Scene& scene, const Polygon& polygon, float tolerance) {
    float longest = 0.0F;
    for (int k = 0; k < polygon.size(); ++k)
        longest = std::max(longest,
                           glm::distance(corner(scene, polygon, k), corner(scene, polygon, (k + 1) % polygon.size())));
    const float height = (polygon.isQuad() ? 1.0F : 2.0F) * glm::length(areaVector(scene, polygon)) / longest;
    return !(height > tolerance);
}

/// The polygon on welded vertices, without repeated corners; nothing if less than a triangle is left.
std::optional<Polygon> weldPolygon(const Polygon& polygon, const std::vector<std::uint32_t>& representative,
                                   const Scene& scene, float tolerance) {
    Polygon welded = polygon;
    std::size_t count = 0;
    for (int k = 0; k < polygon.size(); ++k) {
        const std::uint32_t vertex = representative[polygon.vertices[static_cast<std::size_t>(k)]];
        const auto end = welded.vertices.begin() + static_cast<std::ptrdiff_t>(count);
        if (std::find(welded.vertices.begin(), end, vertex) == end) welded.vertices[count++] = vertex;
    }
    if (count < 3) return std::nullopt;
    if (count == 3) welded.vertices[3] = kNone;
    if (isNeedle(scene, welded, tolerance)) return std::nullopt;
    return welded;
}

void compactPositions(Scene& scene) {
    std::vector<std::uint32_t> newIndex(scene.positions.size(), kNone);
    std::vector<glm::vec3> used;
    for (Polygon& polygon : scene.polygons) {
        for (int k = 0; k < polygon.size(); ++k) {
            std::uint32_t& vertex = polygon.vertices[static_cast<std::size_t>(k)];
            if (newIndex[vertex] == kNone) {
                newIndex[vertex] = static_cast<std::uint32_t>(used.size());
                used.push_back(scene.positions[vertex]);
            }
            vertex = newIndex[vertex];
        }
    }
    scene.positions = std::move(used);
}

/// The corners from the smallest vertex on, in their order or reversed: one key for all polygons that coincide.
Corners coincidenceKey(const Polygon& polygon, bool& reversed) {
    const auto count = static_cast<std::size_t>(polygon.size());
    const auto& v = polygon.vertices;
    const auto first = static_cast<std::size_t>(
        std::min_element(v.begin(), v.begin() + static_cast<std::ptrdiff_t>(count)) - v.begin());
    reversed = v[(first + 1) % count] > v[(first + count - 1) % count];
    Corners key{kNone, kNone, kNone, kNone};
    for (std::size_t k = 0; k < count; ++k) key[k] = v[(first + (reversed ? count - k : k)) % count];
    return key;
}

/// Merges polygons on the same vertices into the first of them.
void mergeCoincident(Scene& scene, PrepareReport& counts) {
    struct Entry {
        Corners key;
        bool occluder; ///< comes after the others: these are in the way as well
        std::uint32_t polygon;
        bool reversed;
    };
    std::vector<Entry> entries;
    for (std::uint32_t i = 0; i < scene.polygons.size(); ++i) {
        Entry entry{{}, isOccluder(scene, scene.polygons[i]), i, false};
        entry.key = coincidenceKey(scene.polygons[i], entry.reversed);
        entries.push_back(entry);
    }
    std::sort(entries.begin(), entries.end(), [](const Entry& a, const Entry& b) {
        return std::tie(a.key, a.occluder, a.polygon) < std::tie(b.key, b.occluder, b.polygon);
    });
    std::vector<bool> dropped(scene.polygons.size(), false);
    for (std::size_t begin = 0, end = 0; begin < entries.size(); begin = end) {
        Polygon& kept = scene.polygons[entries[begin].polygon];
        for (end = begin + 1; end < entries.size() && entries[end].key == entries[begin].key; ++end) {
            const Polygon& other = scene.polygons[entries[end].polygon];
            dropped[entries[end].polygon] = true;
            if (entries[end].occluder || entries[end].reversed == entries[begin].reversed ||
                kept.backMaterial != kNone) {
                ++counts.duplicatePolygons;
            } else {
                kept.backMaterial = other.material;
                ++counts.mergedSheets;
            }
        }
    }
    std::size_t next = 0;
    std::erase_if(scene.polygons, [&](const Polygon&) { return dropped[next++]; });
}

std::size_t joinTriangles(Scene& scene) {
    std::vector<Corners> faces;
    std::vector<std::uint32_t> group;
    // Node and materials as one number: only alike polygons are joined.
    const auto key = [](const Polygon& p) { return std::array{p.node, p.material, p.backMaterial}; };
    std::vector<std::array<std::uint32_t, 3>> groups;
    for (const Polygon& polygon : scene.polygons) groups.push_back(key(polygon));
    std::sort(groups.begin(), groups.end());
    groups.erase(std::unique(groups.begin(), groups.end()), groups.end());
    for (const Polygon& polygon : scene.polygons) {
        faces.push_back(polygon.vertices);
        const auto it = std::lower_bound(groups.begin(), groups.end(), key(polygon));
        group.push_back(static_cast<std::uint32_t>(it - groups.begin()));
    }
    const std::vector<std::uint32_t> origin = pairTriangles(faces, group, scene.positions);
    std::vector<Polygon> joined;
    joined.reserve(faces.size());
    for (std::size_t i = 0; i < faces.size(); ++i) {
        joined.push_back(scene.polygons[origin[i]]);
        joined.back().vertices = faces[i];
    }
    const std::size_t pairs = scene.polygons.size() - joined.size();
    scene.polygons = std::move(joined);
    return pairs;
}

} // namespace

float weldTolerance(const Scene& scene) { return std::max(1e-6F * boundsOf(scene).diagonal(), 1e-30F); }

Scene prepareScene(const Scene& scene, const PrepareOptions& options, PrepareReport* report) {
    PrepareReport counts;
    const float tolerance = weldTolerance(scene);
    const std::vector<std::uint32_t> representative = weldPositions(scene.positions, tolerance);
    for (std::uint32_t i = 0; i < representative.size(); ++i) counts.weldedVertices += representative[i] != i ? 1 : 0;

    Scene prepared;
    prepared.positions = scene.positions;
    prepared.materials = scene.materials;
    prepared.nodes = scene.nodes;
    prepared.cameras = scene.cameras;
    prepared.polygons.reserve(scene.polygons.size());
    for (const Polygon& polygon : scene.polygons) {
        auto welded = weldPolygon(polygon, representative, scene, 2.0F * tolerance);
        if (!welded) {
            ++counts.collapsedPolygons;
            continue;
        }
        if (scene.materials[polygon.material].twoSided) welded->backMaterial = polygon.material;
        prepared.polygons.push_back(*welded);
    }
    // Twice: sheets of triangles can be joined once they are one, sheets of differently cut quads only coincide then.
    if (options.mergeCoincident) mergeCoincident(prepared, counts);
    if (options.joinTriangles) counts.joinedPairs = joinTriangles(prepared);
    if (options.mergeCoincident) mergeCoincident(prepared, counts);
    compactPositions(prepared);
    if (options.addCrossings) {
        const std::vector<glm::vec3> crossings = edgeCrossings(prepared, tolerance);
        prepared.positions.insert(prepared.positions.end(), crossings.begin(), crossings.end());
        counts.edgeCrossings = crossings.size();
    }
    if (report != nullptr) *report = counts;
    return prepared;
}

} // namespace lambert
