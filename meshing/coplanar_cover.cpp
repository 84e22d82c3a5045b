#include "meshing/coplanar_cover.h"

#include "core/triangulation.h"
#include "meshing/coplanar_cells.h"
#include "meshing/coplanar_order.h"
#include "meshing/disjoint_sets.h"
#include "meshing/pair_triangles.h"
#include "meshing/weld.h"
#include "meshing/weld_polygon.h"
#include "scene/coplanar_pairs.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <map>
#include <numeric>
#include <tuple>
#include <utility>

namespace lambert {

namespace {

/// The half of a quad on which its surface is linear.
enum class Half : std::uint8_t { None, First, Second };

/// What shows the same throughout: triangles of cells that may become one.
struct Region {
    ShownSheet sheet;
    Half frontHalf = Half::None, backHalf = Half::None; ///< of the quads whose surfaces are seen
    std::uint32_t backMaterial = kNone, backSurface = kNone;

    auto key() const {
        return std::tuple(sheet.front.polygon, sheet.front.back, frontHalf, backMaterial, backSurface, backHalf,
                          sheet.along);
    }
    bool operator<(const Region& other) const { return key() < other.key(); }
};

/// A polygon that takes another's place.
struct Part {
    std::uint32_t replaces; ///< into Scene::polygons
    Polygon polygon;
    Region region;
    bool whole = false; ///< has the vertices and surfaces of what it replaces
};

std::uint32_t surfaceOf(const Scene& scene, const PolygonSide& side) {
    if (side.polygon == kNone) return kNone;
    const Polygon& polygon = scene.polygons[side.polygon];
    return side.back ? polygon.backSurface : polygon.surface;
}

/// The corners of a polygon on one of whose triangles its surface is linear.
std::array<std::size_t, 3> linearCorners(const Polygon& polygon, Half half) {
    if (!polygon.isQuad()) return {0, 1, 2};
    if (half == Half::First) return {0, 1, 3};
    return {2, 3, 1};
}

Half halfAt(const Scene& scene, const PlaneFrame& frame, const PolygonSide& side, glm::dvec2 point) {
    if (surfaceOf(scene, side) == kNone || !scene.polygons[side.polygon].isQuad()) return Half::None;
    const Polygon& quad = scene.polygons[side.polygon];
    const glm::dvec2 from = frame.project(corner(scene, quad, 1));
    const glm::dvec2 diagonal = frame.project(corner(scene, quad, 3)) - from;
    const double here = cross(diagonal, point - from);
    const double first = cross(diagonal, frame.project(corner(scene, quad, 0)) - from);
    return (here > 0.0) == (first > 0.0) ? Half::First : Half::Second;
}

/// The surface of a side at other vertices in its plane.
SurfaceCorners surfaceAt(const Scene& scene, const PolygonSide& side, Half half, const Polygon& polygon) {
    const Polygon& source = scene.polygons[side.polygon];
    const SurfaceCorners& given = scene.surfaces[surfaceOf(scene, side)];
    const auto triangle = linearCorners(source, half);
    const auto at = [&](std::size_t k) { return glm::dvec3(scene.positions[source.vertices[triangle[k]]]); };
    const glm::dvec3 u = at(1) - at(0);
    const glm::dvec3 v = at(2) - at(0);
    const glm::dvec3 normal = glm::cross(u, v);
    const double twice = glm::dot(normal, normal);
    SurfaceCorners result;
    for (std::size_t k = 0; k < static_cast<std::size_t>(polygon.size()); ++k) {
        const glm::dvec3 p = glm::dvec3(scene.positions[polygon.vertices[k]]) - at(0);
        // A vertex may lie outside by as much as lines have moved.
        const double s = glm::clamp(glm::dot(glm::cross(p, v), normal) / twice, 0.0, 1.0);
        const double t = glm::clamp(glm::dot(glm::cross(u, p), normal) / twice, 0.0, 1.0 - s);
        const auto weight = glm::vec3(1.0 - s - t, s, t);
        const auto mean = [&](const auto& corners) {
            return weight.x * corners[triangle[0]] + weight.y * corners[triangle[1]] + weight.z * corners[triangle[2]];
        };
        result.uv[k] = mean(given.uv);
        result.emissionUv[k] = mean(given.emissionUv);
        result.tint[k] = mean(given.tint);
    }
    return result;
}

/// Closed loops of directed edges, all of them used once.
std::vector<std::vector<std::uint32_t>> loopsOf(std::vector<std::pair<std::uint32_t, std::uint32_t>> edges) {
    std::sort(edges.begin(), edges.end());
    std::vector<bool> used(edges.size(), false);
    std::vector<std::vector<std::uint32_t>> loops;
    for (std::size_t first = 0; first < edges.size(); ++first) {
        if (used[first]) continue;
        std::vector<std::uint32_t>& loop = loops.emplace_back();
        for (std::size_t k = first; k < edges.size() && !used[k];) {
            used[k] = true;
            loop.push_back(edges[k].first);
            const std::uint32_t to = edges[k].second;
            const auto next = std::lower_bound(edges.begin(), edges.end(), std::pair(to, std::uint32_t{0}));
            k = static_cast<std::size_t>(next - edges.begin());
            while (k < edges.size() && edges[k].first == to && used[k]) ++k;
            if (k < edges.size() && edges[k].first != to) break;
        }
    }
    return loops;
}

class Covering {
public:
    Covering(Scene& scene, float tolerance) : scene_(scene), tolerance_(tolerance) {}

    CoverReport run() {
        findCells();
        if (cells_.empty()) return report_;
        const CoplanarOrder order(scene_, cells_, static_cast<double>(2.0F * tolerance_));
        const std::size_t oldPositions = scene_.positions.size();
        for (const CoplanarCells& cells : cells_) cut(cells, order);
        weld(oldPositions);
        replace();
        std::sort(report_.overlaps.begin(), report_.overlaps.end(),
                  [](const CoplanarOverlap& a, const CoplanarOverlap& b) { return a.area > b.area; });
        return report_;
    }

private:
    /// The cells of all polygons that overlap, with others between them or not.
    void findCells() {
        DisjointSets sets(scene_.polygons.size());
        std::vector<std::uint32_t> members;
        for (const CoplanarPair& pair : coplanarPairs(scene_, 2.0F * tolerance_)) {
            if (!CoplanarOrder::mustDecide(scene_, pair)) continue;
            sets.unite(pair.one, pair.two);
            members.insert(members.end(), {pair.one, pair.two});
        }
        std::map<std::uint32_t, std::vector<std::uint32_t>> clusters;
        std::sort(members.begin(), members.end());
        members.erase(std::unique(members.begin(), members.end()), members.end());
        for (const std::uint32_t p : members) clusters[sets.root(p)].push_back(p);
        for (const auto& [root, polygons] : clusters) {
            auto cells = coplanarCells(scene_, polygons, static_cast<double>(2.0F * tolerance_));
            if (cells)
                cells_.push_back(std::move(*cells));
            else
                report_.undecidedPolygons += polygons.size();
        }
    }

    Region regionOf(const CoplanarCells& cells, const ShownSheet& sheet, std::size_t triangle) const {
        Region region;
        region.sheet = sheet;
        const glm::dvec2 centre = cells.centre(triangle);
        region.frontHalf = halfAt(scene_, cells.frame, sheet.front, centre);
        region.backHalf = halfAt(scene_, cells.frame, sheet.back, centre);
        region.backMaterial = materialOf(scene_, sheet.back);
        region.backSurface = surfaceOf(scene_, sheet.back);
        return region;
    }

    void cut(const CoplanarCells& cells, const CoplanarOrder& order) {
        added_.clear();
        std::map<Region, std::vector<std::size_t>> regions;
        for (std::size_t t = 0; t < cells.triangles.size(); ++t) {
            const std::vector<ShownSheet> sheets = order.shown(cells, t);
            for (const ShownSheet& sheet : sheets) regions[regionOf(cells, sheet, t)].push_back(t);
            if (sheets.size() == 1) note(cells, sheets[0], t);
        }
        std::map<std::uint32_t, std::vector<const std::pair<const Region, std::vector<std::size_t>>*>> shown;
        for (const auto& entry : regions) shown[entry.first.sheet.front.polygon].push_back(&entry);
        std::vector<std::size_t> all(cells.polygons.size(), 0); // triangles that each covers
        for (const auto& covering : cells.covering)
            for (const std::uint32_t k : covering) ++all[k];
        for (std::uint32_t k = 0; k < cells.polygons.size(); ++k) {
            const std::uint32_t p = cells.polygons[k];
            replaced_.push_back(p);
            const auto it = shown.find(p);
            if (it == shown.end()) {
                ++report_.coveredPolygons;
                continue;
            }
            std::size_t seen = 0;
            for (const auto* entry : it->second) seen += entry->second.size();
            if (seen == all[k] && keepsShape(it->second)) {
                addWhole(p, it->second.front()->first);
                continue;
            }
            if (seen < all[k]) ++report_.cutPolygons;
            for (const auto* entry : it->second) addParts(cells, entry->first, entry->second);
        }
    }

    /// Whether a polygon that is seen everywhere can stay one: what its back shows is the same everywhere, and its own or without a
    /// surface.
    template <typename Entries>
    bool keepsShape(const Entries& entries) const {
        const Region& first = entries.front()->first;
        return std::all_of(entries.begin(), entries.end(), [&](const auto* entry) {
            const Region& region = entry->first;
            return !region.sheet.front.back && region.backMaterial == first.backMaterial &&
                   region.backSurface == first.backSurface &&
                   (region.backSurface == kNone || region.sheet.back.polygon == region.sheet.front.polygon);
        });
    }

    void addWhole(std::uint32_t p, const Region& region) {
        Part& part = parts_.emplace_back(Part{p, scene_.polygons[p], region, true});
        part.polygon.backMaterial = region.backMaterial;
        if (region.backSurface == kNone) part.polygon.backSurface = kNone;
    }

    /// Notes what a sheet covers on a triangle.
    void note(const CoplanarCells& cells, const ShownSheet& sheet, std::size_t triangle) {
        for (const std::uint32_t k : cells.covering[triangle]) {
            const std::uint32_t lower = cells.polygons[k];
            const std::uint32_t upper = cells.along[k] == sheet.along ? sheet.front.polygon : sheet.back.polygon;
            if (upper == lower || upper == kNone || isOccluder(scene_, scene_.polygons[lower])) continue;
            const Polygon& above = scene_.polygons[upper];
            const Polygon& below = scene_.polygons[lower];
            const std::array key{above.node, above.material, below.node, below.material};
            const auto [it, isNew] = overlapAt_.try_emplace(key, report_.overlaps.size());
            if (isNew) report_.overlaps.push_back({key[0], key[1], key[2], key[3], 0.0});
            report_.overlaps[it->second].area += cells.area(triangle);
        }
    }

    /// The triangles of a region without the points inside it.
    std::vector<std::array<std::uint32_t, 3>> merged(const CoplanarCells& cells,
                                                     const std::vector<std::size_t>& triangles) const {
        std::vector<std::pair<std::uint32_t, std::uint32_t>> edges;
        for (const std::size_t t : triangles)
            for (std::size_t k = 0; k < 3; ++k)
                edges.emplace_back(cells.triangles[t][k], cells.triangles[t][(k + 1) % 3]);
        std::sort(edges.begin(), edges.end());
        std::vector<std::pair<std::uint32_t, std::uint32_t>> border;
        for (const auto& [a, b] : edges)
            if (!std::binary_search(edges.begin(), edges.end(), std::pair(b, a))) border.emplace_back(a, b);
        std::vector<glm::dvec2> points;
        std::vector<std::uint32_t> names;
        std::vector<std::size_t> sizes;
        for (const auto& loop : loopsOf(border)) {
            for (const std::uint32_t point : loop) points.push_back(cells.points[point]);
            names.insert(names.end(), loop.begin(), loop.end());
            sizes.push_back(loop.size());
        }
        std::vector<std::array<std::uint32_t, 3>> result;
        if (const auto found = triangulateLoops(points, sizes)) {
            for (const auto& [a, b, c] : *found) result.push_back({names[a], names[b], names[c]});
        } else {
            for (const std::size_t t : triangles) result.push_back(cells.triangles[t]);
        }
        return result;
    }

    /// Appends the polygons of a region.
    void addParts(const CoplanarCells& cells, const Region& region, const std::vector<std::size_t>& triangles) {
        const PolygonSide& front = region.sheet.front;
        Polygon polygon;
        polygon.material = materialOf(scene_, front);
        polygon.node = scene_.polygons[front.polygon].node;
        polygon.backMaterial = region.backMaterial;
        std::vector<Corners> faces;
        for (auto [a, b, c] : merged(cells, triangles)) {
            if (!region.sheet.along) std::swap(b, c);
            faces.push_back({vertexOf(cells, a), vertexOf(cells, b), vertexOf(cells, c), kNone});
        }
        pairTriangles(faces, std::vector<std::uint32_t>(faces.size(), 0), scene_.positions);
        for (const Corners& face : faces) {
            polygon.vertices = face;
            parts_.push_back({front.polygon, polygon, region, false});
        }
    }

    std::uint32_t vertexOf(const CoplanarCells& cells, std::uint32_t point) {
        if (cells.vertex[point] != kNone) return cells.vertex[point];
        const auto [it, isNew] = added_.try_emplace(point, static_cast<std::uint32_t>(scene_.positions.size()));
        if (isNew) scene_.positions.emplace_back(cells.places[point]);
        return it->second;
    }

    /// Points that were added may lie where others are; what has no height between them is dropped.
    void weld(std::size_t oldPositions) {
        std::vector<std::uint32_t> representative(oldPositions);
        std::iota(representative.begin(), representative.end(), 0U);
        if (scene_.positions.size() > oldPositions) representative = weldPositions(scene_.positions, tolerance_);
        std::erase_if(parts_, [&](Part& part) {
            if (part.whole) return false;
            const auto welded = weldPolygon(part.polygon, representative, scene_, 2.0F * tolerance_);
            if (welded) part.polygon.vertices = welded->polygon.vertices;
            return !welded;
        });
    }

    std::uint32_t addSurface(const PolygonSide& side, Half half, const Polygon& polygon) {
        if (side.polygon == kNone || surfaceOf(scene_, side) == kNone) return kNone;
        const SurfaceCorners surface = surfaceAt(scene_, side, half, polygon);
        scene_.surfaces.push_back(surface);
        return static_cast<std::uint32_t>(scene_.surfaces.size() - 1);
    }

    void giveSurfaces(Part& part) {
        const auto& [front, back, along] = part.region.sheet;
        if (part.whole) return;
        part.polygon.surface = addSurface(front, part.region.frontHalf, part.polygon);
        const bool same = front.polygon == back.polygon && surfaceOf(scene_, front) == surfaceOf(scene_, back);
        part.polygon.backSurface = same ? part.polygon.surface : addSurface(back, part.region.backHalf, part.polygon);
    }

    /// Puts the parts where what they replace was.
    void replace() {
        for (Part& part : parts_) giveSurfaces(part);
        std::stable_sort(parts_.begin(), parts_.end(),
                         [](const Part& a, const Part& b) { return a.replaces < b.replaces; });
        std::sort(replaced_.begin(), replaced_.end());
        std::vector<Polygon> polygons;
        polygons.reserve(scene_.polygons.size() + parts_.size());
        auto part = parts_.begin();
        for (std::uint32_t i = 0; i < scene_.polygons.size(); ++i) {
            if (!std::binary_search(replaced_.begin(), replaced_.end(), i)) polygons.push_back(scene_.polygons[i]);
            for (; part != parts_.end() && part->replaces == i; ++part) polygons.push_back(part->polygon);
        }
        scene_.polygons = std::move(polygons);
    }

    Scene& scene_;
    float tolerance_;
    CoverReport report_;
    std::vector<CoplanarCells> cells_;
    std::map<std::array<std::uint32_t, 4>, std::size_t> overlapAt_;
    std::map<std::uint32_t, std::uint32_t> added_; ///< vertices, by point of the cells that are being cut
    std::vector<Part> parts_;
    std::vector<std::uint32_t> replaced_;
};

} // namespace

CoverReport coverCoplanar(Scene& scene, float tolerance) { return Covering(scene, tolerance).run(); }

CoverReport findCoplanarOverlaps(const Scene& scene, float tolerance) {
    Scene copy = scene;
    CoverReport report = Covering(copy, tolerance).run();
    report.takenAway = false;
    report.coveredPolygons = report.cutPolygons = 0;
    return report;
}

} // namespace lambert
