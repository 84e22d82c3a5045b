/// Blocks of pairs without occluders: E. A. Haines, J. R. Wallace, "Shaft culling for efficient ray-cast radiosity",
/// Eurographics Workshop on Rendering 1991.
#include "formfactors/closed_form_method.h"

#include "core/error.h"
#include "formfactors/closed_form.h"
#include "formfactors/gauss_exchange.h"
#include "formfactors/quadrature.h"
#include "formfactors/visible_exchange.h"
#include "meshing/prepare.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace lambert {

namespace {

using Cluster = PatchClusters::Cluster;
/// Factors below this are rounding: the contour integral is good to 1e-15 of the smaller area.
constexpr double kSmallestFactor = 1e-14;
constexpr double kUpright = 4.0; // see gaussOrder

} // namespace

/// The computation of one row.
class ClosedForm::Row {
public:
    Row(const ClosedForm& method, std::uint32_t patch, RowAccumulator& accumulator)
        : method_(method), from_(method.clusters_.targets()[patch]), accumulator_(accumulator) {
        area_ = glm::length(polygonAreaVector(from_.polygon.points()));
        for (const glm::dvec3& p : from_.polygon.points()) extents_.add(p, method.directions_.list());
        for (int order = 1; order <= PatchClusters::kHighestOrder; ++order)
            appendGaussPoints(from_.polygon.points(), order, points_[static_cast<std::size_t>(order - 1)]);
        for (const Occluder& occluder : method.occluders_.list)
            if (cornerHeights(from_.plane, occluder.corners)[1] > method.tolerance_ && !isRedundant(occluder))
                stack_.push_back(&occluder);
    }

    void run() {
        visit(0, 0);
        accumulator_.add(accumulator_.out(), std::max(0.0, 1.0 - total_));
    }

private:
    const PatchClusters& clusters() const { return method_.clusters_; }
    std::array<double, 2> heights(const Plane& plane, const Extents& extents) const {
        return extents.heights(plane, method_.directions_.list());
    }

    /// A back face of a solid that the patch is outside of, with a gap between: what a solid stands on lies partly under it.
    bool isRedundant(const Occluder& occluder) const {
        if (!occluder.solid || cornerHeights(occluder.plane, from_.polygon.points())[1] > method_.tolerance_)
            return false;
        return extents_.apart(occluder.solidExtents, method_.directions_.list().size(), -method_.tolerance_);
    }

    /// The occluders that may stand between the patch and a node are those of the stack from `begin` on.
    void visit(std::uint32_t index, std::size_t begin) {
        const PatchClusters::Node& node = clusters().nodes()[index];
        const double t = method_.tolerance_;
        if (heights(from_.plane, node.extents)[1] <= t) return;
        const std::size_t end = stack_.size();
        Extents both = extents_;
        both.add(node.extents);
        for (std::size_t k = begin; k < end; ++k) {
            const Occluder* occluder = stack_[k];
            if (mayStandBetween(*occluder, from_.polygon.points(), node.extents, both, method_.directions_.list(), t))
                stack_.push_back(occluder);
        }
        if (stack_.size() == end) {
            for (std::uint32_t c = node.first; c < node.last; ++c) addCluster(clusters().clusters()[c], end);
        } else if (node.left == 0) {
            addCluster(clusters().clusters()[node.first], end);
        } else {
            visit(node.left, end);
            visit(node.right, end);
        }
        stack_.resize(end);
    }

    void addCluster(const Cluster& cluster, std::size_t firstOccluder) {
        const double t = method_.tolerance_;
        const auto over = heights(from_.plane, cluster.extents);
        if (over[1] <= t) return;
        const double nearest = glm::distance(cluster.centre, from_.centre) - cluster.spread;
        const double ratio = nearest > 0.0 ? (from_.radius + cluster.radius) / nearest : 1e30;
        bool upright = over[0] >= kUpright * cluster.radius;
        bool oneByOne = over[0] < -t || !cluster.flat;
        if (!oneByOne) {
            const auto here = cornerHeights(cluster.plane, from_.polygon.points());
            if (here[0] >= -t && here[1] <= t) return; // in its plane
            oneByOne = here[0] < -t && here[1] > t;
            upright = upright && std::max(here[0], -here[1]) >= kUpright * from_.radius;
        }
        const int order = gaussOrder(ratio, upright);
        oneByOne = oneByOne || order == 0;
        if (oneByOne) {
            for (std::uint32_t lane = 0; lane < cluster.count; ++lane) addPair(cluster.target[lane], firstOccluder);
            return;
        }
        const auto exchange =
            exchangeWithCluster(points_[static_cast<std::size_t>(order - 1)], from_.plane.normal, cluster, order);
        const bool occluded = stack_.size() > firstOccluder;
        for (std::uint32_t lane = 0; lane < cluster.count; ++lane) {
            const Target& to = clusters().targets()[cluster.target[lane]];
            const bool front = exchange[lane] > 0.0;
            double value = std::abs(exchange[lane]);
            if (front ? to.frontHidden : !to.blackBack) continue;
            if (occluded) value = visiblePart(to, front, value, firstOccluder);
            add(to, front, value);
        }
    }

    void add(const Target& to, bool front, double exchange) {
        const double factor = exchange * to.opacity / area_;
        if (!(factor > kSmallestFactor)) return;
        total_ += factor;
        accumulator_.add(front && to.patch != kNone ? to.patch : accumulator_.back(), factor);
    }

    /// A pair on its own: close, or one reaching behind the other.
    void addPair(std::uint32_t target, std::size_t firstOccluder) {
        const Target& to = clusters().targets()[target];
        if (&to == &from_) return;
        const double t = method_.tolerance_;
        const auto over = cornerHeights(from_.plane, to.polygon.points());
        if (over[1] <= t) return;
        const auto here = cornerHeights(to.plane, from_.polygon.points());
        if (here[1] > t && !to.frontHidden) addSide(to, true, firstOccluder);
        if (here[0] < -t && to.blackBack) addSide(to, false, firstOccluder);
    }

    /// What is in front of the other's plane, of both.
    struct FacingParts {
        ConvexPolygon from, to;
        Plane toPlane;
    };
    FacingParts facingParts(const Target& to, bool front) const {
        FacingParts parts;
        ConvexPolygon behind;
        parts.toPlane = front ? to.plane : Plane{-to.plane.normal, -to.plane.offset, to.plane.direction};
        split(from_.polygon, parts.toPlane, method_.tolerance_, parts.from, behind);
        split(front ? to.polygon : reversed(to.polygon), from_.plane, method_.tolerance_, parts.to, behind);
        return parts;
    }

    void addSide(const Target& to, bool front, std::size_t firstOccluder) {
        const FacingParts parts = facingParts(to, front);
        if (parts.from.empty() || parts.to.empty()) return;
        const bool occluded = stack_.size() > firstOccluder;
        double value = convexExchange(parts.from, from_.plane, parts.to, parts.toPlane, scratch_.exchange);
        if (value > 0.0 && occluded) value = visiblePart(parts, value, firstOccluder);
        add(to, front, value);
    }

    double visiblePart(const Target& to, bool front, double unoccluded, std::size_t firstOccluder) {
        return visiblePart(facingParts(to, front), unoccluded, firstOccluder);
    }
    double visiblePart(const FacingParts& parts, double unoccluded, std::size_t firstOccluder) {
        occluders_.assign(stack_.begin() + static_cast<std::ptrdiff_t>(firstOccluder), stack_.end());
        OccludedPair pair{parts.from,
                          from_.plane,
                          parts.to,
                          parts.toPlane,
                          method_.occluders_.list.data(),
                          method_.directions_.list(),
                          occluders_,
                          method_.tolerance_};
        if (!dropClearOccluders(pair)) return 0.0;
        if (occluders_.empty()) return unoccluded;
        if (std::any_of(occluders_.begin(), occluders_.end(), [](const Occluder* o) { return o->holes; }))
            return unoccluded * visibleShare(parts);
        return visibleExchange(pair, unoccluded, method_.options_.error, scratch_);
    }

    /// The share that rays let through, between Gauss points of both.
    double visibleShare(const FacingParts& parts) const {
        constexpr int kOrder = 8;
        std::vector<WeightedPoint> from, to;
        appendGaussPoints(parts.from.points(), kOrder, from);
        appendGaussPoints(parts.to.points(), kOrder, to);
        const float offset = method_.rays_.originOffset(static_cast<float>(from_.radius));
        const glm::vec3 above = offset * glm::vec3(from_.plane.normal);
        const glm::vec3 before = offset * glm::vec3(parts.toPlane.normal);
        double visible = 0.0, all = 0.0;
        for (const auto& [x, weightX] : from) {
            for (const auto& [y, weightY] : to) {
                const glm::dvec3 d = y - x;
                const double squared = glm::dot(d, d);
                const double value = -weightX * weightY * glm::dot(from_.plane.normal, d) *
                                     glm::dot(parts.toPlane.normal, d) / (squared * squared);
                all += value;
                const glm::vec3 origin = glm::vec3(x) + above;
                if (!method_.rays_.occluded({origin, glm::vec3(y) + before - origin, 1.0F})) visible += value;
            }
        }
        return all > 0.0 ? visible / all : 0.0;
    }

    const ClosedForm& method_;
    const Target& from_;
    RowAccumulator& accumulator_;
    double area_; ///< m², holes included
    double total_ = 0.0;
    Extents extents_;
    std::array<std::vector<WeightedPoint>, PatchClusters::kHighestOrder> points_;
    std::vector<const Occluder*> stack_;
    std::vector<const Occluder*> occluders_;
    VisibleExchangeScratch scratch_;
};

ClosedForm::ClosedForm(const PatchMesh& mesh, const RayCaster& rays, const ClosedFormOptions& options)
    : rays_(rays),
      options_(options),
      patchCount_(mesh.size()),
      tolerance_(2.0 * static_cast<double>(weldTolerance(rays.scene()))),
      occluders_(gatherOccluders(rays.scene(), directions_, tolerance_)),
      clusters_(rays.scene(), mesh, occluders_, directions_, tolerance_) {
    if (!(options.error >= 1e-8 && options.error <= 0.1))
        throw UsageError(fmt::format("form-factor error: found {}, allowed are 1e-8 to 0.1", options.error));
}

void ClosedForm::row(std::uint32_t patch, RowAccumulator& accumulator) const { Row(*this, patch, accumulator).run(); }

} // namespace lambert
