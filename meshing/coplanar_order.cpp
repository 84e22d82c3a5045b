#include "meshing/coplanar_order.h"

#include "scene/surface.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>
#include <utility>

namespace lambert {

namespace {

constexpr double kSeen = 0.05; ///< of a surface: less than that is what modelling has left over at its border

bool sameVertices(const Polygon& a, const Polygon& b) {
    return std::is_permutation(a.vertices.begin(), a.vertices.end(), b.vertices.begin());
}

/// Per material and side of the cells' plane, how much of it there is and how much is not covered by others.
struct Surface {
    double area = 0.0, seen = 0.0; // m²
};

using SurfaceKey = std::pair<std::uint32_t, bool>;

SurfaceKey surfaceKey(const Scene& scene, const CoplanarCells& cells, std::uint32_t k) {
    return {scene.polygons[cells.polygons[k]].material, cells.along[k]};
}

} // namespace

CoplanarOrder::CoplanarOrder(const Scene& scene, const std::vector<CoplanarCells>& cells, double tolerance)
    : scene_(scene), hidden_(scene.polygons.size(), false) {
    for (const CoplanarCells& some : cells) findHidden(some);
    showWhatGoesOn(cells, tolerance);
}

void CoplanarOrder::findHidden(const CoplanarCells& cells) {
    std::map<SurfaceKey, Surface> surfaces;
    for (std::size_t t = 0; t < cells.triangles.size(); ++t) {
        const double area = cells.area(t);
        for (const std::uint32_t k : cells.covering[t]) {
            const SurfaceKey key = surfaceKey(scene_, cells, k);
            const bool covered =
                std::any_of(cells.covering[t].begin(), cells.covering[t].end(), [&](std::uint32_t other) {
                    return cells.along[other] == key.second && surfaceKey(scene_, cells, other) != key;
                });
            surfaces[key].area += area;
            if (!covered) surfaces[key].seen += area;
        }
    }
    for (std::uint32_t k = 0; k < cells.polygons.size(); ++k) {
        const Surface& surface = surfaces[surfaceKey(scene_, cells, k)];
        hidden_[cells.polygons[k]] = surface.seen <= kSeen * surface.area;
    }
}

/// A surface that goes on beyond these cells, in a polygon of which nothing is covered, is seen.
void CoplanarOrder::showWhatGoesOn(const std::vector<CoplanarCells>& cells, double tolerance) {
    struct Place {
        std::uint32_t vertex, cells, polygon;
        auto order() const { return std::tie(vertex, cells, polygon); }
        bool operator<(const Place& other) const { return order() < other.order(); }
    };
    std::vector<Place> places;
    std::vector<bool> inCells(scene_.polygons.size(), false);
    for (std::uint32_t c = 0; c < cells.size(); ++c)
        for (const std::uint32_t p : cells[c].polygons) {
            inCells[p] = true;
            if (!hidden_[p]) continue;
            for (int k = 0; k < scene_.polygons[p].size(); ++k)
                places.push_back({scene_.polygons[p].vertices[static_cast<std::size_t>(k)], c, p});
        }
    if (places.empty()) return;
    std::sort(places.begin(), places.end());
    std::vector<std::pair<std::uint32_t, SurfaceKey>> goOn; // cells and which of their surfaces
    for (std::uint32_t i = 0; i < scene_.polygons.size(); ++i) {
        if (inCells[i]) continue;
        const Polygon& polygon = scene_.polygons[i];
        for (int k = 0; k < polygon.size(); ++k) {
            const std::uint32_t vertex = polygon.vertices[static_cast<std::size_t>(k)];
            for (auto it = std::lower_bound(places.begin(), places.end(), Place{vertex, 0, 0});
                 it != places.end() && it->vertex == vertex; ++it) {
                if (scene_.polygons[it->polygon].material != polygon.material) continue;
                const PlaneFrame& frame = cells[it->cells].frame;
                bool inPlane = true;
                for (int n = 0; n < polygon.size(); ++n)
                    inPlane = inPlane && std::abs(frame.height(corner(scene_, polygon, n))) <= tolerance;
                const bool along = glm::dot(glm::dvec3(areaVector(scene_, polygon)), frame.normal()) > 0.0;
                if (inPlane) goOn.emplace_back(it->cells, SurfaceKey(polygon.material, along));
            }
        }
    }
    std::sort(goOn.begin(), goOn.end());
    for (std::uint32_t c = 0; c < cells.size(); ++c)
        for (std::uint32_t k = 0; k < cells[c].polygons.size(); ++k)
            if (std::binary_search(goOn.begin(), goOn.end(), std::pair(c, surfaceKey(scene_, cells[c], k))))
                hidden_[cells[c].polygons[k]] = false;
}

bool CoplanarOrder::mustDecide(const Scene& scene, const CoplanarPair& pair) {
    const Polygon& one = scene.polygons[pair.one];
    const Polygon& two = scene.polygons[pair.two];
    const bool occluderOne = isOccluder(scene, one);
    if (occluderOne || isOccluder(scene, two)) return occluderOne != isOccluder(scene, two);
    const bool holesOne = hasHoles(scene, one);
    const bool holesTwo = hasHoles(scene, two);
    if (holesOne && holesTwo) return false;
    if (pair.sameFacing) return true;
    if (emits(scene, {pair.one, true}) || emits(scene, {pair.two, true})) return true;
    return sameVertices(one, two) && (one.backMaterial != kNone || two.backMaterial != kNone);
}

bool CoplanarOrder::liesOver(std::uint32_t a, std::uint32_t b) const {
    const auto height = [&](std::uint32_t p) {
        return std::tuple(emits(scene_, PolygonSide{p, false}), static_cast<bool>(hidden_[p]), p);
    };
    return height(a) > height(b);
}

PolygonSide CoplanarOrder::seen(const CoplanarCells& cells, const std::vector<std::uint32_t>& covering,
                                bool along) const {
    std::vector<PolygonSide> sides;
    for (const std::uint32_t k : covering) sides.push_back({cells.polygons[k], cells.along[k] != along});
    const PolygonSide side =
        seenSide(scene_, sides, [this](std::uint32_t a, std::uint32_t b) { return liesOver(a, b); });
    return materialOf(scene_, side) == kNone ? PolygonSide{} : side;
}

std::vector<ShownSheet> CoplanarOrder::shown(const CoplanarCells& cells, std::size_t triangle) const {
    const auto polygonOf = [&](std::uint32_t k) -> const Polygon& { return scene_.polygons[cells.polygons[k]]; };
    std::vector<std::uint32_t> covering = cells.covering[triangle];
    const auto drop = [&](const auto& isLess) {
        if (!std::all_of(covering.begin(), covering.end(), isLess)) std::erase_if(covering, isLess);
    };
    drop([&](std::uint32_t k) { return isOccluder(scene_, polygonOf(k)); });
    drop([&](std::uint32_t k) { return hasHoles(scene_, polygonOf(k)); });

    const std::uint32_t first = covering.front();
    std::vector<ShownSheet> sheets;
    if (isOccluder(scene_, polygonOf(first)) || hasHoles(scene_, polygonOf(first))) {
        for (const std::uint32_t k : covering) {
            const std::uint32_t p = cells.polygons[k];
            const bool back = polygonOf(k).backMaterial != kNone;
            sheets.push_back({{p, false}, back ? PolygonSide{p, true} : PolygonSide{}, cells.along[k]});
        }
        return sheets;
    }
    ShownSheet sheet{seen(cells, covering, true), seen(cells, covering, false), true};
    const auto isFront = [](const PolygonSide& side) { return side.polygon != kNone && !side.back; };
    if (!isFront(sheet.front) && (isFront(sheet.back) || sheet.front.polygon == kNone)) {
        std::swap(sheet.front, sheet.back);
        sheet.along = false;
    }
    sheets.push_back(sheet);
    return sheets;
}

} // namespace lambert
