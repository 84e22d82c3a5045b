#include "scene/coplanar_ties.h"

#include "scene/coplanar_pairs.h"
#include "scene/surface.h"

#include <boost/container/small_vector.hpp>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <span>
#include <utility>

namespace lambert {

namespace {

constexpr float kInPlane = 2e-6F;                ///< of the scene's diagonal: as where scenes are prepared
constexpr float kGrazing = 0.05F;                ///< cosine to the normal below which a ray grazes
constexpr float kReach = 1.0F + 1.0F / kGrazing; ///< of kInPlane: how far rays that do not graze go between planes

bool liesOver(const Scene& scene, std::uint32_t a, std::uint32_t b) {
    return std::pair(emits(scene, {a, false}), a) > std::pair(emits(scene, {b, false}), b);
}

/// Where a ray meets the plane of a triangle, in the triangle's own coordinates.
std::optional<glm::dvec2> meet(const std::array<glm::dvec3, 3>& t, const glm::dvec3& origin, const glm::dvec3& along) {
    const glm::dvec3 u = t[1] - t[0];
    const glm::dvec3 v = t[2] - t[0];
    const glm::dvec3 normal = glm::cross(u, v);
    const double slope = glm::dot(normal, along);
    if (slope == 0.0) return std::nullopt;
    const glm::dvec3 p = origin + glm::dot(normal, t[0] - origin) / slope * along - t[0];
    const double twice = glm::dot(normal, normal);
    return glm::dvec2(glm::dot(glm::cross(p, v), normal), glm::dot(glm::cross(u, p), normal)) / twice;
}

/// The polygon's side and chart where a ray meets it; nothing where it passes by, farther than `slack` (metres).
std::optional<SeenPolygon> meetPolygon(const Scene& scene, std::uint32_t index, const glm::dvec3& origin,
                                       const glm::dvec3& along, double slack) {
    const Polygon& polygon = scene.polygons[index];
    const auto at = [&](int k) { return glm::dvec3(corner(scene, polygon, k)); };
    const std::array first{at(0), at(1), at(polygon.isQuad() ? 3 : 2)};
    const glm::dvec3 normal = glm::cross(first[1] - first[0], first[2] - first[0]);
    SeenPolygon seen{index, 0.0F, 0.0F, glm::dot(normal, along) < 0.0};
    std::optional<glm::dvec2> chart = meet(first, origin, along);
    bool second = false;
    if (chart && polygon.isQuad() && chart->x + chart->y > 1.0) {
        second = true;
        chart = meet({at(2), at(3), at(1)}, origin, along);
    }
    if (!chart) return std::nullopt;
    const double margin = slack / longestEdge(scene, polygon);
    const double sum = chart->x + chart->y;
    if (chart->x < -margin || chart->y < -margin || (sum > 1.0 + margin)) return std::nullopt;
    glm::dvec2 inside = glm::max(*chart, 0.0);
    if (inside.x + inside.y > 1.0) inside /= inside.x + inside.y;
    seen.u = static_cast<float>(second ? 1.0 - inside.x : inside.x);
    seen.v = static_cast<float>(second ? 1.0 - inside.y : inside.y);
    return seen;
}

/// Whether a polygon's side is hidden where another polygon lies in the same plane. Occluders and what has holes give way to others.
bool isHidden(const Scene& scene, const PolygonSide& side, std::uint32_t other, bool sameFacing) {
    const auto yields = [&](std::uint32_t p) {
        return isOccluder(scene, scene.polygons[p]) || hasHoles(scene, scene.polygons[p]);
    };
    if (yields(other)) return false;
    if (yields(side.polygon)) return true;
    const std::array sides{side, PolygonSide{other, sameFacing == side.back}};
    return seenSide(scene, sides, [&](auto a, auto b) { return liesOver(scene, a, b); }) == sides[1];
}

} // namespace

CoplanarTies::CoplanarTies(const Scene& scene) : scene_(scene) {
    const float diagonal = boundsOf(scene).diagonal();
    slack_ = static_cast<double>(0.5F * kInPlane * diagonal);
    std::vector<std::pair<std::size_t, std::uint32_t>> hidden;
    for (const CoplanarPair& pair : coplanarPairs(scene, kInPlane * diagonal))
        for (const auto& [polygon, other] : {std::pair(pair.one, pair.two), std::pair(pair.two, pair.one)})
            for (const bool back : {false, true})
                if (isHidden(scene, {polygon, back}, other, pair.sameFacing))
                    hidden.emplace_back(place({polygon, back}), other);
    if (hidden.empty()) return;
    normals_.reserve(scene.polygons.size());
    for (const Polygon& polygon : scene.polygons) normals_.push_back(glm::normalize(areaVector(scene, polygon)));
    std::sort(hidden.begin(), hidden.end());
    first_.assign(2 * scene.polygons.size() + 1, 0);
    for (const auto& [where, other] : hidden) {
        ++first_[where + 1];
        others_.push_back({other, boundsOf(scene, scene.polygons[other]).grownBy(kReach * kInPlane * diagonal)});
    }
    for (std::size_t k = 0; k + 1 < first_.size(); ++k) first_[k + 1] += first_[k];
}

std::optional<SeenPolygon> CoplanarTies::seen(const PolygonSide& side, const glm::vec3& point, const glm::vec3& origin,
                                              const glm::vec3& direction) const {
    const float cosine = glm::dot(normals_[side.polygon], direction);
    const bool grazes = cosine * cosine < kGrazing * kGrazing * glm::dot(direction, direction);
    boost::container::small_vector<PolygonSide, 4> sides;
    boost::container::small_vector<SeenPolygon, 4> met;
    for (std::uint32_t k = first_[place(side)]; k < first_[place(side) + 1]; ++k) {
        const Bounds& reach = others_[k].reach;
        if (!grazes && (glm::any(glm::lessThan(point, reach.lower)) || glm::any(glm::lessThan(reach.upper, point))))
            continue;
        const auto other = meetPolygon(scene_, others_[k].polygon, glm::dvec3(origin), glm::dvec3(direction), slack_);
        if (!other) continue;
        met.push_back(*other);
        sides.push_back({other->polygon, !other->front});
    }
    if (met.empty()) return std::nullopt;
    const PolygonSide best = seenSide(scene_, std::span<const PolygonSide>(sides.data(), sides.size()),
                                      [this](std::uint32_t a, std::uint32_t b) { return liesOver(scene_, a, b); });
    return *std::find_if(met.begin(), met.end(), [&](const SeenPolygon& p) { return p.polygon == best.polygon; });
}

} // namespace lambert
