#include "meshing/hovering_edges.h"

#include "core/parallel.h"
#include "meshing/disjoint_sets.h"
#include "meshing/edge_crossings.h"
#include "meshing/face_lines.h"
#include "meshing/pair_triangles.h"
#include "meshing/plane_frame.h"
#include "meshing/prepare.h"
#include "scene/box_index.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <optional>
#include <span>

namespace lambert {

namespace {

constexpr double kSteep = 0.5; ///< sine of the angle to the polygon from which on an edge or a face is not over it

using Edge = std::pair<std::uint32_t, std::uint32_t>;

/// The edges of a scene and the polygons at each.
struct Edges {
    std::vector<Edge> keys;
    std::vector<std::uint32_t> first;    ///< #keys + 1, into `polygons`
    std::vector<std::uint32_t> polygons; ///< at each edge, ascending

    explicit Edges(const Scene& scene) : keys(uniqueEdges(scene)), first(keys.size() + 1, 0) {
        std::vector<std::pair<std::uint32_t, std::uint32_t>> at;
        for (std::uint32_t i = 0; i < scene.polygons.size(); ++i) {
            const Polygon& polygon = scene.polygons[i];
            for (int k = 0; k < polygon.size(); ++k) {
                const auto edge = std::lower_bound(keys.begin(), keys.end(), edgeOf(polygon, k)) - keys.begin();
                at.emplace_back(static_cast<std::uint32_t>(edge), i);
            }
        }
        std::sort(at.begin(), at.end());
        polygons.reserve(at.size());
        for (const auto& [edge, polygon] : at) {
            ++first[edge + 1];
            polygons.push_back(polygon);
        }
        for (std::size_t i = 0; i < keys.size(); ++i) first[i + 1] += first[i];
    }
    std::span<const std::uint32_t> at(std::uint32_t edge) const {
        return std::span(polygons).subspan(first[edge], first[edge + 1] - first[edge]);
    }
};

double emissionOf(const Scene& scene, const Polygon& polygon) {
    double emission = 0.0;
    for (const std::uint32_t material : {polygon.material, polygon.backMaterial}) {
        if (material == kNone) continue;
        const Rgb& radiance = scene.materials[material].emittedRadiance;
        emission = std::max(emission, static_cast<double>(radiance.x + radiance.y + radiance.z) / 3.0);
    }
    return emission;
}

/// Half the polygon's smaller extent across its longest edge, at most `reach`: how near to it things hover that matter.
double reachOver(const Scene& scene, const Polygon& polygon, double reach) {
    return std::min(reach, 0.5 * polygonArea(scene, polygon) / lambert::longestEdge(scene, polygon));
}

/// Finds what hovers over one side of a polygon.
class OneSide {
public:
    OneSide(const Scene& scene, const Edges& edges, std::uint32_t polygon, bool back, double reach)
        : scene_(scene),
          edges_(edges),
          below_(polygon),
          frame_(planeFrame(scene, scene.polygons[polygon])),
          normal_(frame_.normal()),
          reach_(reach),
          least_(3.0 * static_cast<double>(weldTolerance(scene))),
          border_(frame_.outline(scene, scene.polygons[polygon])) {
        if (back) normal_ = -normal_;
    }

    std::vector<Outline> outlines(std::span<const std::uint32_t> near) const {
        std::vector<std::pair<std::uint32_t, OutlineEdge>> rims;
        for (const std::uint32_t edge : near) {
            const auto part = partWithinReach(edge);
            if (part && crossesPolygon(*part) && isOpen(edge)) rims.emplace_back(edge, *part);
        }
        return grouped(rims);
    }

private:
    double height(const glm::vec3& p) const { return glm::dot(glm::dvec3(p) - frame_.origin, normal_); }

    /// Nothing if it is steep over the polygon.
    std::optional<OutlineEdge> partWithinReach(std::uint32_t edge) const {
        const glm::dvec3 a(scene_.positions[edges_.keys[edge].first]);
        const glm::dvec3 b(scene_.positions[edges_.keys[edge].second]);
        const double from = height(glm::vec3(a)), to = height(glm::vec3(b));
        if (std::abs(to - from) > kSteep * glm::distance(a, b)) return std::nullopt;
        Interval within{0.0, 1.0};
        within.below(-from, from - to, -least_);
        within.below(from, to - from, reach_);
        if (within.isEmpty()) return std::nullopt;
        return OutlineEdge{glm::mix(a, b, within.from), glm::mix(a, b, within.to),
                           glm::mix(from, to, 0.5 * (within.from + within.to))};
    }

    bool crossesPolygon(const OutlineEdge& edge) const {
        const glm::dvec2 a = frame_.project(glm::vec3(edge.from)), b = frame_.project(glm::vec3(edge.to));
        Interval inside{0.0, 1.0};
        for (std::size_t k = 0; k < border_.size(); ++k) {
            const glm::dvec2 side = glm::normalize(border_[(k + 1) % border_.size()] - border_[k]);
            const double from = cross(side, a - border_[k]) - least_, to = cross(side, b - border_[k]) - least_;
            inside.below(-from, from - to, 0.0);
        }
        return !inside.isEmpty();
    }

    /// Sine of the angle by which a polygon rises from one of its edges, away from the polygon below; and to which side of the
    /// edge it lies.
    struct Rise {
        double sine;
        bool left;
    };
    Rise riseOf(std::uint32_t polygon, const Edge& edge) const {
        const PlaneFrame frame = planeFrame(scene_, scene_.polygons[polygon]);
        const glm::dvec3 a(scene_.positions[edge.first]);
        const glm::dvec3 along = glm::normalize(glm::dvec3(scene_.positions[edge.second]) - a);
        glm::dvec3 inward = glm::cross(frame.normal(), along);
        glm::dvec3 middle(0.0);
        const int count = scene_.polygons[polygon].size();
        for (int k = 0; k < count; ++k)
            middle += glm::dvec3(corner(scene_, scene_.polygons[polygon], k)) / double(count);
        if (glm::dot(inward, middle - a) < 0.0) inward = -inward;
        return {glm::dot(inward, normal_), glm::dot(glm::cross(along, inward), normal_) > 0.0};
    }

    /// Whether a polygon is so little inclined to the one below that it is over it. Those of a ball that are have a rim
    /// without gaps, none of whose edges is steep.
    bool isOver(std::uint32_t polygon) const {
        const double cosine = glm::dot(planeFrame(scene_, scene_.polygons[polygon]).normal(), normal_);
        return cosine * cosine >= 1.0 - kSteep * kSteep;
    }

    /// Whether light passes below the edge: no surface goes down from it, and what is over the polygon ends there.
    bool isOpen(std::uint32_t edge) const {
        bool left = false, right = false;
        for (const std::uint32_t polygon : edges_.at(edge)) {
            if (polygon == below_) return false;
            const Rise rise = riseOf(polygon, edges_.keys[edge]);
            if (isOver(polygon))
                (rise.left ? left : right) = true;
            else if (rise.sine < 0.0)
                return false;
        }
        return !(left && right);
    }

    /// Whether a polygon at an edge shows the polygon below a side that is not black and is larger than the gap.
    bool faces(std::uint32_t polygon, double gap) const {
        if (reachOver(scene_, scene_.polygons[polygon], reach_) < gap) return false;
        if (isOccluder(scene_, scene_.polygons[polygon]) || !isOver(polygon)) return false;
        const double turned = glm::dot(planeFrame(scene_, scene_.polygons[polygon]).normal(), normal_);
        return turned < 0.0 || scene_.polygons[polygon].backMaterial != kNone;
    }

    /// The outlines that hang together.
    std::vector<Outline> grouped(const std::vector<std::pair<std::uint32_t, OutlineEdge>>& rims) const {
        DisjointSets sets(rims.size());
        std::map<std::uint32_t, std::uint32_t> firstAt; // vertex → rim
        for (std::uint32_t i = 0; i < rims.size(); ++i) {
            const auto& [a, b] = edges_.keys[rims[i].first];
            for (const std::uint32_t vertex : {a, b}) sets.unite(firstAt.try_emplace(vertex, i).first->second, i);
        }
        std::map<std::uint32_t, Outline> byRoot;
        for (std::uint32_t i = 0; i < rims.size(); ++i) {
            Outline& outline = byRoot[sets.root(i)];
            outline.below = below_;
            outline.edges.push_back(rims[i].second);
            outline.length += glm::distance(rims[i].second.from, rims[i].second.to);
            outline.emission = std::max(outline.emission, emissionOf(scene_, scene_.polygons[below_]));
            for (const std::uint32_t polygon : edges_.at(rims[i].first)) {
                outline.emission = std::max(outline.emission, emissionOf(scene_, scene_.polygons[polygon]));
                if (faces(polygon, rims[i].second.gap)) outline.hovering.push_back(polygon);
            }
        }
        std::vector<Outline> outlines;
        for (auto& [root, outline] : byRoot) {
            std::sort(outline.hovering.begin(), outline.hovering.end());
            outline.hovering.erase(std::unique(outline.hovering.begin(), outline.hovering.end()),
                                   outline.hovering.end());
            outlines.push_back(std::move(outline));
        }
        return outlines;
    }

    const Scene& scene_;
    const Edges& edges_;
    std::uint32_t below_;
    PlaneFrame frame_;
    glm::dvec3 normal_; ///< of the side
    double reach_, least_;
    std::vector<glm::dvec2> border_;
};

} // namespace

HoveringOutlines findHoveringOutlines(const Scene& scene, double reach) {
    const Edges edges(scene);
    const BoxIndex index(boxesOf(scene.positions, edges.keys, 0.0F));
    const auto touching = 2.0 * static_cast<double>(weldTolerance(scene));
    std::vector<std::vector<Outline>> outlines(scene.polygons.size());
    std::vector<std::vector<Edge>> contacts(scene.polygons.size());
    parallelFor(scene.polygons.size(), 64, [&](std::size_t begin, std::size_t end, int) {
        std::vector<std::uint32_t> near;
        for (std::size_t i = begin; i < end; ++i) {
            const Polygon& polygon = scene.polygons[i];
            const double own = reachOver(scene, polygon, reach);
            if (isOccluder(scene, polygon) || own < 0.125 * reach || own < 16.0 * touching) continue;
            index.meeting(boundsOf(scene, polygon).grownBy(static_cast<float>(own)), near);
            for (const bool back : {false, true}) {
                if (back && polygon.backMaterial == kNone) continue;
                auto some = OneSide(scene, edges, static_cast<std::uint32_t>(i), back, own).outlines(near);
                outlines[i].insert(outlines[i].end(), some.begin(), some.end());
            }
            if (outlines[i].empty()) continue;
            const PlaneFrame frame = planeFrame(scene, polygon);
            const auto touches = [&](std::uint32_t vertex) {
                return std::abs(frame.height(scene.positions[vertex])) <= touching;
            };
            for (const std::uint32_t edge : near)
                if (touches(edges.keys[edge].first) && touches(edges.keys[edge].second))
                    contacts[i].push_back(edges.keys[edge]);
        }
    });
    HoveringOutlines result;
    for (std::uint32_t i = 0; i < scene.polygons.size(); ++i) {
        if (outlines[i].empty()) continue;
        std::move(outlines[i].begin(), outlines[i].end(), std::back_inserter(result.outlines));
        const Polygon& polygon = scene.polygons[i];
        for (const Edge& edge : contacts[i]) {
            bool own = false;
            for (int k = 0; k < polygon.size(); ++k) own = own || edge == edgeOf(polygon, k);
            if (!own) result.touching[i].push_back(edge);
        }
    }
    return result;
}

} // namespace lambert
