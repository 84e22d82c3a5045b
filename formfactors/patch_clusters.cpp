#include "formfactors/patch_clusters.h"

#include "core/box.h"
#include "formfactors/coplanar_contacts.h"
#include "formfactors/patch_shape.h"
#include "formfactors/quadrature.h"

#include <algorithm>
#include <limits>

namespace lambert {

namespace {

Target makeTarget(std::span<const glm::dvec3> corners, const glm::dvec3& normal) {
    Target target;
    target.polygon = ConvexPolygon(corners);
    target.centre = target.polygon.centre();
    target.plane = Plane::through(target.centre, normal);
    target.radius = target.polygon.radiusAround(target.centre);
    return target;
}

bool isSeen(const Target& target) { return !target.frontHidden || target.blackBack; }

Target partOf(const Target& whole, const ConvexPolygon& polygon) {
    Target part = makeTarget(polygon.points(), whole.plane.normal);
    part.plane = whole.plane;
    part.opacity = whole.opacity;
    part.patch = whole.patch;
    part.frontHidden = whole.frontHidden;
    part.blackBack = whole.blackBack;
    return part;
}

} // namespace

PatchClusters::PatchClusters(const Scene& scene, const PatchMesh& mesh, const Occluders& occluders,
                             Directions& directions, double tolerance)
    : tolerance_(tolerance) {
    std::vector<glm::dvec3> corners;
    std::vector<std::uint32_t> occluderOf; // per target
    for (std::size_t i = 0; i < mesh.size(); ++i) {
        const glm::dvec3 normal = glm::normalize(glm::dvec3(mesh.normal[i]));
        Target& target = targets_.emplace_back(makeTarget(polygonOf(mesh, i).points(), normal));
        target.patch = static_cast<std::uint32_t>(i);
        target.blackBack = scene.polygons[mesh.polygon[i]].backMaterial == kNone;
        occluderOf.push_back(occluders.ofPolygon[mesh.polygon[i]]);
        takePlane(target, occluders.list[occluderOf.back()].plane);
        if (!mesh.opacity.empty()) target.opacity = static_cast<double>(mesh.opacity[i]);
    }
    for (std::size_t p = 0; p < scene.polygons.size(); ++p) {
        const Polygon& polygon = scene.polygons[p];
        if (!isOccluder(scene, polygon)) continue;
        corners.clear();
        for (int k = 0; k < polygon.size(); ++k) corners.emplace_back(corner(scene, polygon, k));
        Target& target =
            targets_.emplace_back(makeTarget(corners, glm::normalize(glm::dvec3(areaVector(scene, polygon)))));
        target.patch = kNone;
        target.blackBack = true;
        occluderOf.push_back(occluders.ofPolygon[p]);
    }

    for (Target& target : targets_)
        if (target.plane.direction < 0) directions.enter(target.plane);
    directions_ = directions.list();

    std::vector<std::uint32_t> order = divideAtContacts(occluderOf, occluders);
    Box<glm::dvec3> centres;
    for (const Target& t : targets_) centres.add(t.centre);
    // Targets that face elsewhere are as far as the other end of the scene.
    if (!order.empty()) build(order, 0, order.size(), glm::distance(centres.lower, centres.upper));
}

std::vector<std::uint32_t> PatchClusters::divideAtContacts(const std::vector<std::uint32_t>& occluderOf,
                                                           const Occluders& occluders) {
    const auto contacts = findCoplanarContacts(occluders.list, tolerance_);
    std::vector<std::uint32_t> order;
    std::vector<Target> parts, next;
    std::vector<ConvexPolygon> outside;
    ConvexPolygon covered;
    for (std::uint32_t t = 0; t < occluderOf.size(); ++t) {
        parts.assign(1, targets_[t]);
        for (const CoplanarContact& contact : contacts[occluderOf[t]]) {
            const Occluder& cover = occluders.list[contact.occluder];
            next.clear();
            for (const Target& part : parts) {
                outside.clear();
                divideByCover(part.polygon, cover, tolerance_, outside, covered);
                for (const ConvexPolygon& polygon : outside) next.push_back(partOf(part, polygon));
                if (covered.empty()) continue;
                Target under = partOf(part, covered);
                // The second side of a polygon faces away from what stands against the first.
                const bool second = glm::dot(part.plane.normal, occluders.list[occluderOf[t]].plane.normal) < 0.0;
                const bool front = contact.hides == CoveredSide::Both ||
                                   contact.hides == (second ? CoveredSide::Back : CoveredSide::Front);
                const bool back = contact.hides == CoveredSide::Both ||
                                  contact.hides == (second ? CoveredSide::Front : CoveredSide::Back);
                under.frontHidden = under.frontHidden || front;
                under.blackBack = under.blackBack && !back;
                next.push_back(under);
            }
            parts.swap(next);
        }
        if (parts.size() == 1) {
            targets_[t].frontHidden = parts[0].frontHidden;
            targets_[t].blackBack = parts[0].blackBack;
            if (isSeen(targets_[t])) order.push_back(t);
            continue;
        }
        for (const Target& part : parts) {
            if (!isSeen(part)) continue;
            order.push_back(static_cast<std::uint32_t>(targets_.size()));
            targets_.push_back(part);
        }
    }
    return order;
}

void PatchClusters::takePlane(Target& target, const Plane& plane) const {
    for (const glm::dvec3& p : target.polygon.points())
        if (std::abs(plane.height(p)) > tolerance_) return;
    const double side = glm::dot(plane.normal, target.plane.normal) > 0.0 ? 1.0 : -1.0;
    target.plane = {side * plane.normal, side * plane.offset, plane.direction};
}

std::uint32_t PatchClusters::build(std::vector<std::uint32_t>& order, std::size_t begin, std::size_t end,
                                   double normalWeight) {
    const auto index = static_cast<std::uint32_t>(nodes_.size());
    nodes_.emplace_back();
    const auto first = static_cast<std::uint32_t>(clusters_.size());
    std::uint32_t left = 0, right = 0;
    if (end - begin <= kLanes) {
        addCluster(order, begin, end);
    } else {
        const auto key = [&](std::uint32_t t, int axis) {
            return axis < 3 ? targets_[t].centre[axis] : normalWeight * targets_[t].plane.normal[axis - 3];
        };
        int widest = 0;
        double width = -1.0;
        for (int axis = 0; axis < 6; ++axis) {
            double low = std::numeric_limits<double>::max(), high = -low;
            for (std::size_t k = begin; k < end; ++k) {
                low = std::min(low, key(order[k], axis));
                high = std::max(high, key(order[k], axis));
            }
            if (high - low > width * (1.0 + 1e-9)) {
                width = high - low;
                widest = axis;
            }
        }
        // Full clusters on the left.
        const std::size_t middle = begin + ((end - begin) / kLanes + 1) / 2 * kLanes;
        const auto at = [&](std::size_t k) { return order.begin() + static_cast<std::ptrdiff_t>(k); };
        std::nth_element(at(begin), at(middle), at(end), [&](std::uint32_t a, std::uint32_t b) {
            const double keyA = key(a, widest), keyB = key(b, widest);
            return keyA != keyB ? keyA < keyB : a < b;
        });
        left = build(order, begin, middle, normalWeight);
        right = build(order, middle, end, normalWeight);
    }
    Node& node = nodes_[index];
    node.first = first;
    node.last = static_cast<std::uint32_t>(clusters_.size());
    node.left = left;
    node.right = right;
    for (std::uint32_t c = first; c < node.last; ++c) node.extents.add(clusters_[c].extents);
    return index;
}

void PatchClusters::addCluster(const std::vector<std::uint32_t>& order, std::size_t begin, std::size_t end) {
    Cluster& cluster = clusters_.emplace_back();
    cluster.count = static_cast<std::uint32_t>(end - begin);
    cluster.centre = glm::dvec3(0.0);
    cluster.radius = cluster.spread = 0.0;
    cluster.plane = targets_[order[begin]].plane;
    cluster.flat = true;
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
        const bool real = begin + lane < end;
        cluster.target[lane] = order[std::min(begin + lane, end - 1)];
        const Target& target = targets_[cluster.target[lane]];
        cluster.normalX[lane] = target.plane.normal.x;
        cluster.normalY[lane] = target.plane.normal.y;
        cluster.normalZ[lane] = target.plane.normal.z;
        cluster.radius = std::max(cluster.radius, target.radius);
        if (real) cluster.centre += target.centre / static_cast<double>(cluster.count);
        for (const glm::dvec3& p : target.polygon.points()) {
            cluster.extents.add(p, directions_);
            cluster.flat = cluster.flat && std::abs(cluster.plane.height(p)) <= tolerance_;
        }
        cluster.flat = cluster.flat && glm::dot(cluster.plane.normal, target.plane.normal) > 0.0;
        for (int order_ = 1; order_ <= kHighestOrder; ++order_) {
            std::vector<WeightedPoint> points;
            appendGaussPoints(target.polygon.points(), order_, points);
            if (points.size() % 2 != 0) points.push_back({points.back().point, 0.0});
            Points& soa = cluster.points[static_cast<std::size_t>(order_ - 1)];
            for (auto* list : {&soa.x, &soa.y, &soa.z, &soa.weight}) list->resize(points.size());
            for (std::size_t k = 0; k < points.size(); ++k) {
                soa.x[k][lane] = points[k].point.x;
                soa.y[k][lane] = points[k].point.y;
                soa.z[k][lane] = points[k].point.z;
                soa.weight[k][lane] = real ? points[k].weight : 0.0;
            }
        }
    }
    for (std::uint32_t lane = 0; lane < cluster.count; ++lane)
        cluster.spread = std::max(cluster.spread, glm::distance(cluster.centre, targets_[cluster.target[lane]].centre));
}

} // namespace lambert
