#include "meshing/coplanar_cells.h"

#include "core/triangulation.h"
#include "meshing/pair_triangles.h"
#include "meshing/plane_lines.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <unordered_map>
#include <utility>

namespace lambert {

namespace {

using Triangle = std::array<std::uint32_t, 3>;
using Chain = std::vector<std::uint32_t>;
using Edge = std::pair<std::uint32_t, std::uint32_t>; ///< directed

double areaOf(const std::vector<glm::dvec2>& points, const Triangle& t) {
    return 0.5 * cross(points[t[1]] - points[t[0]], points[t[2]] - points[t[0]]);
}

bool hasSurface(const Polygon& polygon) { return polygon.surface != kNone || polygon.backSurface != kNone; }

std::uint32_t largest(const Scene& scene, std::span<const std::uint32_t> polygons) {
    return *std::max_element(polygons.begin(), polygons.end(), [&](std::uint32_t a, std::uint32_t b) {
        return polygonArea(scene, scene.polygons[a]) < polygonArea(scene, scene.polygons[b]);
    });
}

/// The triangles on the left of directed edges.
class TriangleEdges {
public:
    explicit TriangleEdges(const std::vector<Triangle>& triangles) : triangles_(triangles) {
        left_.reserve(3 * triangles.size());
        for (std::uint32_t t = 0; t < triangles.size(); ++t)
            for (std::size_t k = 0; k < 3; ++k) left_[code(triangles[t][k], triangles[t][(k + 1) % 3])] = t;
    }

    /// All triangles within a closed border, which runs counter-clockwise along edges.
    std::vector<std::uint32_t> within(std::vector<Edge> border) const {
        std::sort(border.begin(), border.end());
        const auto onBorder = [&](std::uint32_t a, std::uint32_t b) {
            return std::binary_search(border.begin(), border.end(), Edge(a, b)) ||
                   std::binary_search(border.begin(), border.end(), Edge(b, a));
        };
        std::vector<std::uint32_t> found;
        std::unordered_map<std::uint32_t, bool> seen;
        const auto take = [&](std::uint32_t a, std::uint32_t b) {
            const auto it = left_.find(code(a, b));
            if (it != left_.end() && seen.try_emplace(it->second, true).second) found.push_back(it->second);
        };
        for (const auto& [a, b] : border) take(a, b);
        for (std::size_t k = 0; k < found.size(); ++k) {
            const Triangle& t = triangles_[found[k]];
            for (std::size_t i = 0; i < 3; ++i)
                if (!onBorder(t[i], t[(i + 1) % 3])) take(t[(i + 1) % 3], t[i]);
        }
        std::sort(found.begin(), found.end());
        return found;
    }

private:
    static std::uint64_t code(std::uint32_t a, std::uint32_t b) { return std::uint64_t{a} << 32 | b; }

    const std::vector<Triangle>& triangles_;
    std::unordered_map<std::uint64_t, std::uint32_t> left_;
};

class Cutting {
public:
    Cutting(const Scene& scene, std::span<const std::uint32_t> polygons, double tolerance)
        : scene_(scene), tolerance_(tolerance) {
        cells_.frame = planeFrame(scene, scene.polygons[largest(scene, polygons)]);
        cells_.polygons.assign(polygons.begin(), polygons.end());
        for (const std::uint32_t p : polygons)
            cells_.along.push_back(glm::dot(planeFrame(scene, scene.polygons[p]).normal(), cells_.frame.normal()) >
                                   0.0);
        addVertices();
    }

    std::optional<CoplanarCells> run() {
        if (coincide()) {
            takeOneOutline();
            return std::move(cells_);
        }
        PlaneLines drawing{cells_.points, cells_.places, lines()};
        const std::vector<Chain> chains = cutLines(drawing, tolerance_);
        if (chains.empty()) return std::nullopt;
        cells_.points = std::move(drawing.points);
        cells_.places = std::move(drawing.places);
        cells_.vertex.resize(cells_.points.size(), kNone);
        std::vector<std::array<std::uint32_t, 2>> pieces;
        for (const Chain& chain : chains)
            for (std::size_t k = 0; k + 1 < chain.size(); ++k) pieces.push_back({chain[k], chain[k + 1]});
        auto triangles = triangulateLines(cells_.points, pieces);
        if (!triangles) return std::nullopt;
        std::vector<std::vector<std::uint32_t>> covering(triangles->size());
        if (!cover(*triangles, chains, covering)) return std::nullopt;
        for (std::size_t t = 0; t < triangles->size(); ++t) {
            if (covering[t].empty()) continue;
            cells_.triangles.push_back((*triangles)[t]);
            cells_.covering.push_back(std::move(covering[t]));
        }
        return std::move(cells_);
    }

private:
    const Polygon& polygon(std::size_t k) const { return scene_.polygons[cells_.polygons[k]]; }

    void addVertices() {
        for (std::size_t k = 0; k < cells_.polygons.size(); ++k) {
            const auto& v = polygon(k).vertices;
            cells_.vertex.insert(cells_.vertex.end(), v.begin(), v.begin() + polygon(k).size());
        }
        std::sort(cells_.vertex.begin(), cells_.vertex.end());
        cells_.vertex.erase(std::unique(cells_.vertex.begin(), cells_.vertex.end()), cells_.vertex.end());
        vertices_ = cells_.vertex.size();
        for (const std::uint32_t v : cells_.vertex) {
            cells_.points.push_back(cells_.frame.project(scene_.positions[v]));
            cells_.places.emplace_back(scene_.positions[v]);
        }
    }

    std::uint32_t pointOf(std::uint32_t vertex) const {
        const auto end =
            cells_.vertex.begin() + static_cast<std::ptrdiff_t>(vertices_); // those of the scene come first
        return static_cast<std::uint32_t>(std::lower_bound(cells_.vertex.begin(), end, vertex) - cells_.vertex.begin());
    }

    /// Whether all polygons have the same vertices.
    bool coincide() const {
        for (std::size_t k = 0; k < cells_.polygons.size(); ++k)
            if (vertices_ != static_cast<std::size_t>(polygon(k).size())) return false;
        return true;
    }

    void takeOneOutline() {
        std::array<std::uint32_t, 4> corners{};
        const auto size = static_cast<std::size_t>(polygon(0).size());
        for (std::size_t i = 0; i < size; ++i) corners[i] = pointOf(polygon(0).vertices[i]);
        if (!cells_.along[0]) std::reverse(corners.begin(), corners.begin() + static_cast<std::ptrdiff_t>(size));
        const auto& [a, b, c, d] = corners;
        cells_.triangles = {{a, b, size == 4 ? d : c}};
        if (size == 4) cells_.triangles.push_back({c, d, b});
        std::vector<std::uint32_t> all;
        for (std::uint32_t k = 0; k < cells_.polygons.size(); ++k) all.push_back(k);
        cells_.covering.assign(cells_.triangles.size(), all);
    }

    /// All edges once, and the diagonals.
    std::vector<std::array<std::uint32_t, 2>> lines() {
        std::vector<Edge> edges;
        for (std::size_t k = 0; k < cells_.polygons.size(); ++k) {
            const Polygon& p = polygon(k);
            const auto size = static_cast<std::size_t>(p.size());
            for (std::size_t i = 0; i < size; ++i)
                edges.push_back(edgeKey(pointOf(p.vertices[i]), pointOf(p.vertices[(i + 1) % size])));
            if (p.isQuad() && hasSurface(p)) edges.push_back(edgeKey(pointOf(p.vertices[1]), pointOf(p.vertices[3])));
        }
        std::sort(edges.begin(), edges.end());
        edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
        edges_ = edges;
        std::vector<std::array<std::uint32_t, 2>> result;
        for (const auto& [a, b] : edges) result.push_back({a, b});
        return result;
    }

    /// The pieces of a polygon's border, counter-clockwise in the frame.
    std::vector<Edge> border(std::size_t k, const std::vector<Chain>& chains) const {
        const Polygon& p = polygon(k);
        const auto size = static_cast<std::size_t>(p.size());
        std::vector<Edge> result;
        for (std::size_t i = 0; i < size; ++i) {
            std::uint32_t from = pointOf(p.vertices[i]);
            std::uint32_t to = pointOf(p.vertices[(i + 1) % size]);
            if (!cells_.along[k]) std::swap(from, to);
            const auto line = std::lower_bound(edges_.begin(), edges_.end(), edgeKey(from, to)) - edges_.begin();
            const Chain& chain = chains[static_cast<std::size_t>(line)];
            for (std::size_t n = 0; n + 1 < chain.size(); ++n)
                result.push_back(from < to ? Edge(chain[n], chain[n + 1]) : Edge(chain[n + 1], chain[n]));
        }
        return result;
    }

    /// Finds which triangles each polygon covers. False where these do not make up the polygon.
    bool cover(const std::vector<Triangle>& triangles, const std::vector<Chain>& chains,
               std::vector<std::vector<std::uint32_t>>& covering) const {
        const TriangleEdges edges(triangles);
        for (std::size_t k = 0; k < cells_.polygons.size(); ++k) {
            double area = 0.0;
            for (const std::uint32_t t : edges.within(border(k, chains))) {
                covering[t].push_back(static_cast<std::uint32_t>(k));
                area += areaOf(cells_.points, triangles[t]);
            }
            // Its border has moved by no more than the tolerance.
            const double moved = 8.0 * tolerance_ * longestEdge(scene_, polygon(k));
            if (std::abs(area - polygonArea(scene_, polygon(k))) > moved) return false;
        }
        return true;
    }

    const Scene& scene_;
    double tolerance_;
    CoplanarCells cells_;
    std::size_t vertices_ = 0; ///< points that are vertices of the scene
    std::vector<Edge> edges_;  ///< between points, sorted
};

} // namespace

double CoplanarCells::area(std::size_t triangle) const { return areaOf(points, triangles[triangle]); }

glm::dvec2 CoplanarCells::centre(std::size_t triangle) const {
    const auto& [a, b, c] = triangles[triangle];
    return (points[a] + points[b] + points[c]) / 3.0;
}

std::optional<CoplanarCells> coplanarCells(const Scene& scene, std::span<const std::uint32_t> polygons,
                                           double tolerance) {
    return Cutting(scene, polygons, tolerance).run();
}

} // namespace lambert
