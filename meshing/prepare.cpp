#include "meshing/prepare.h"

#include "meshing/coplanar_cover.h"
#include "meshing/edge_crossings.h"
#include "meshing/join_triangles.h"
#include "meshing/pair_triangles.h"
#include "meshing/weld.h"
#include "meshing/weld_polygon.h"
#include "scene/surface.h"

#include <algorithm>
#include <array>
#include <tuple>

namespace lambert {

namespace {

/// What the material makes use of: coordinates of textures it has not are no reason to keep triangles apart.
SurfaceCorners usedPart(SurfaceCorners surface, const Material& material) {
    if (!material.reflectanceTexture && !material.hasHoles()) surface.uv = {};
    if (!material.emissionTexture) surface.emissionUv = {};
    return surface;
}

/// Adds the surface of a polygon with the given corners of another; none if it says nothing.
std::uint32_t addSurface(Scene& target, const SurfaceCorners& source, const std::array<std::size_t, 4>& corners,
                         const Material& material) {
    SurfaceCorners surface;
    for (std::size_t k = 0; k < 4; ++k) {
        surface.uv[k] = source.uv[corners[k]];
        surface.emissionUv[k] = source.emissionUv[corners[k]];
        surface.tint[k] = source.tint[corners[k]];
    }
    surface = usedPart(surface, material);
    const bool tinted = surface.tint != SurfaceCorners().tint;
    if (!material.isTextured() && !tinted) return kNone;
    target.surfaces.push_back(surface);
    return static_cast<std::uint32_t>(target.surfaces.size() - 1);
}

/// The front surface of `other`, a polygon on the vertices of `polygon`, at the corners of `polygon`.
std::uint32_t surfaceAtCornersOf(const Polygon& polygon, const Polygon& other, Scene& scene) {
    if (other.surface == kNone) return kNone;
    std::array<std::size_t, 4> corners{0, 1, 2, 3};
    for (std::size_t k = 0; k < static_cast<std::size_t>(polygon.size()); ++k)
        corners[k] = static_cast<std::size_t>(
            std::find(other.vertices.begin(), other.vertices.end(), polygon.vertices[k]) - other.vertices.begin());
    const SurfaceCorners source = scene.surfaces[other.surface];
    return addSurface(scene, source, corners, scene.materials[other.material]);
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

/// Whether two polygons on the same vertices are merged at once. Others are decided with what else lies in their plane, see
/// coverCoplanar.
bool mergeAtOnce(const Scene& scene, const Polygon& kept, const Polygon& other, bool reversed) {
    const auto yields = [&](const Polygon& polygon) { return isOccluder(scene, polygon) || hasHoles(scene, polygon); };
    if (yields(kept) || yields(other)) return true;
    if (!reversed) return kept.material == other.material && kept.backMaterial == other.backMaterial;
    if (kept.backMaterial == kNone) return other.backMaterial == kNone;
    return kept.backMaterial == other.material && kept.material == other.backMaterial;
}

/// Merges polygons on the same vertices into the first of them; into the first without holes, if there is one: light that
/// passes the others must meet it.
void mergeCoincident(Scene& scene, PrepareReport& counts) {
    struct Entry {
        Corners key;
        bool occluder; ///< comes after the others: these are in the way as well
        bool holes;
        std::uint32_t polygon;
        bool reversed;
        auto order() const { return std::tie(key, occluder, holes, polygon); }
    };
    std::vector<Entry> entries;
    for (std::uint32_t i = 0; i < scene.polygons.size(); ++i) {
        Entry entry{{}, isOccluder(scene, scene.polygons[i]), hasHoles(scene, scene.polygons[i]), i, false};
        entry.key = coincidenceKey(scene.polygons[i], entry.reversed);
        entries.push_back(entry);
    }
    std::sort(entries.begin(), entries.end(), [](const Entry& a, const Entry& b) { return a.order() < b.order(); });
    std::vector<bool> dropped(scene.polygons.size(), false);
    for (std::size_t begin = 0, end = 0; begin < entries.size(); begin = end) {
        Polygon& kept = scene.polygons[entries[begin].polygon];
        for (end = begin + 1; end < entries.size() && entries[end].key == entries[begin].key; ++end) {
            const Polygon& other = scene.polygons[entries[end].polygon];
            const bool reversed = entries[end].reversed != entries[begin].reversed;
            if (!mergeAtOnce(scene, kept, other, reversed)) continue;
            dropped[entries[end].polygon] = true;
            if (entries[end].occluder || !reversed || kept.backMaterial != kNone) {
                ++counts.duplicatePolygons;
            } else {
                kept.backMaterial = other.material;
                kept.backSurface = surfaceAtCornersOf(kept, other, scene);
                ++counts.mergedSheets;
            }
        }
    }
    std::size_t next = 0;
    std::erase_if(scene.polygons, [&](const Polygon&) { return dropped[next++]; });
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
    prepared.textures = scene.textures;
    prepared.lights = scene.lights;
    prepared.environment = scene.environment;
    prepared.origin = scene.origin;
    prepared.polygons.reserve(scene.polygons.size());
    for (const Polygon& polygon : scene.polygons) {
        auto welded = weldPolygon(polygon, representative, scene, 2.0F * tolerance);
        if (!welded) {
            ++counts.collapsedPolygons;
            continue;
        }
        Polygon& kept = prepared.polygons.emplace_back(welded->polygon);
        const Material& material = scene.materials[polygon.material];
        if (polygon.surface != kNone)
            kept.surface = addSurface(prepared, scene.surfaces[polygon.surface], welded->corners, material);
        if (material.twoSided) {
            kept.backMaterial = kept.material;
            kept.backSurface = kept.surface;
        }
    }
    if (options.keepPolygons) {
        counts.cover = findCoplanarOverlaps(prepared, tolerance);
    } else {
        // Twice: sheets of triangles can be joined once they are one, sheets of differently cut quads only coincide then.
        mergeCoincident(prepared, counts);
        counts.joinedPairs = joinTriangles(prepared);
        mergeCoincident(prepared, counts);
        counts.cover = coverCoplanar(prepared, tolerance);
    }
    compactPositions(prepared);
    if (!options.keepPolygons) {
        const std::vector<glm::vec3> crossings = edgeCrossings(prepared, tolerance);
        prepared.positions.insert(prepared.positions.end(), crossings.begin(), crossings.end());
        counts.edgeCrossings = crossings.size();
    }
    if (report != nullptr) *report = counts;
    return prepared;
}

} // namespace lambert
