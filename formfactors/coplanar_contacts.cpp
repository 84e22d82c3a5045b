#include "formfactors/coplanar_contacts.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace lambert {

namespace {

bool inPlane(const Plane& plane, std::span<const glm::dvec3> points, double tolerance) {
    return std::all_of(points.begin(), points.end(),
                       [&](const glm::dvec3& p) { return std::abs(plane.height(p)) <= tolerance; });
}

bool overlap(const Occluder& a, const Occluder& b, double tolerance) {
    std::vector<ConvexPolygon> outside;
    ConvexPolygon covered;
    divideByCover(ConvexPolygon(a.corners), b, tolerance, outside, covered);
    return !covered.empty();
}

CoveredSide hiddenSide(const std::vector<Occluder>& occluders, std::uint32_t of, std::uint32_t by) {
    const Occluder &a = occluders[of], &b = occluders[by];
    if (glm::dot(a.plane.normal, b.plane.normal) > 0.0) return CoveredSide::Both;
    return a.solid || b.solid ? CoveredSide::Front : CoveredSide::Back;
}

} // namespace

std::vector<std::vector<CoplanarContact>> findCoplanarContacts(const std::vector<Occluder>& occluders,
                                                               double tolerance) {
    std::vector<std::vector<CoplanarContact>> contacts(occluders.size());
    // A sweep along x: only those whose ranges meet are looked at.
    std::vector<std::array<double, 2>> range;
    for (const Occluder& o : occluders) {
        std::array<double, 2>& r = range.emplace_back(std::array{o.corners[0].x, o.corners[0].x});
        for (const glm::dvec3& p : o.corners) r = {std::min(r[0], p.x), std::max(r[1], p.x)};
    }
    std::vector<std::uint32_t> order(occluders.size());
    std::iota(order.begin(), order.end(), 0U);
    std::sort(order.begin(), order.end(), [&](auto a, auto b) { return range[a][0] < range[b][0]; });
    for (std::size_t k = 0; k < order.size(); ++k) {
        const std::uint32_t a = order[k];
        for (std::size_t l = k + 1; l < order.size() && range[order[l]][0] <= range[a][1] + tolerance; ++l) {
            const std::uint32_t b = order[l];
            if (!inPlane(occluders[a].plane, occluders[b].corners, tolerance) ||
                !inPlane(occluders[b].plane, occluders[a].corners, tolerance) ||
                !overlap(occluders[a], occluders[b], tolerance))
                continue;
            for (const auto& [of, by] : {std::pair(a, b), std::pair(b, a)}) {
                const CoveredSide side = hiddenSide(occluders, of, by);
                if (!occluders[by].holes && (side != CoveredSide::Both || by < of)) contacts[of].push_back({by, side});
            }
        }
    }
    for (auto& list : contacts)
        std::sort(list.begin(), list.end(), [](const auto& a, const auto& b) { return a.occluder < b.occluder; });
    return contacts;
}

void divideByCover(const ConvexPolygon& polygon, const Occluder& cover, double tolerance,
                   std::vector<ConvexPolygon>& outside, ConvexPolygon& covered) {
    const std::size_t first = outside.size();
    covered = polygon;
    ConvexPolygon inside, beside;
    for (std::size_t k = 0; k < cover.corners.size(); ++k) {
        const glm::dvec3& begin = cover.corners[k];
        const glm::dvec3& end = cover.corners[(k + 1) % cover.corners.size()];
        const Plane edge = Plane::through(begin, glm::normalize(glm::cross(cover.plane.normal, end - begin)));
        // What only touches the outline lies outside of it.
        const auto points = covered.points();
        if (std::all_of(points.begin(), points.end(), [&](const auto& p) { return edge.height(p) <= tolerance; })) {
            outside.resize(first);
            outside.push_back(polygon);
            covered.size = 0;
            return;
        }
        split(covered, edge, tolerance, inside, beside);
        if (!beside.empty()) outside.push_back(beside);
        covered = inside;
    }
}

} // namespace lambert
