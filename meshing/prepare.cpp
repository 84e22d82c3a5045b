#include "meshing/prepare.h"

#include "meshing/pair_triangles.h"
#include "meshing/weld.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <optional>

namespace lambert {

namespace {

/// Whether a polygon is no higher over its longest edge than `tolerance`: its vertices lie on its own edges.
bool isNeedle(const Scene& scene, const Polygon& polygon, float tolerance) {
    float longest = 0.0F;
    for (int k = 0; k < polygon.size(); ++k)
        longest = std::max(longest, glm::distance(corner(scene, polygon, k),
                                                  corner(scene, polygon, (k + 1) % polygon.size())));
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

std::size_t joinTriangles(Scene& scene) {
    std::vector<Corners> faces;
    std::vector<std::uint32_t> group;
    // Node and material as one number: only alike polygons are joined.
    std::vector<std::pair<std::uint32_t, std::uint32_t>> groups;
    for (const Polygon& polygon : scene.polygons) groups.emplace_back(polygon.node, polygon.material);
    std::sort(groups.begin(), groups.end());
    groups.erase(std::unique(groups.begin(), groups.end()), groups.end());
    for (const Polygon& polygon : scene.polygons) {
        faces.push_back(polygon.vertices);
        const auto it = std::lower_bound(groups.begin(), groups.end(), std::pair(polygon.node, polygon.material));
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
        if (const auto welded = weldPolygon(polygon, representative, scene, 2.0F * tolerance))
            prepared.polygons.push_back(*welded);
        else
            ++counts.collapsedPolygons;
    }
    compactPositions(prepared);
    if (options.joinTriangles) counts.joinedPairs = joinTriangles(prepared);
    if (report != nullptr) *report = counts;
    return prepared;
}

} // namespace lambert
