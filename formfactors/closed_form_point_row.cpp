#include "formfactors/closed_form.h"
#include "formfactors/closed_form_method.h"
#include "formfactors/quadrature.h"
#include "formfactors/visible_parts.h"

#include <algorithm>
#include <vector>

namespace lambert {

/// The computation of the row of a point.
class ClosedForm::PointRow {
public:
    PointRow(const ClosedForm& method, const glm::dvec3& point, const glm::dvec3& normal, RowAccumulator& accumulator)
        : method_(method),
          point_(point),
          horizon_(Plane::through(point, glm::normalize(normal))),
          accumulator_(accumulator) {
        extents_.add(point, directions());
        for (const Occluder& occluder : method.occluders_.list)
            if (cornerHeights(horizon_, occluder.corners)[1] > method.tolerance_) stack_.push_back(&occluder);
    }

    void run() {
        if (!method_.clusters_.nodes().empty()) visit(0, 0);
        accumulator_.add(accumulator_.out(), std::max(0.0, 1.0 - total_));
    }

private:
    std::span<const glm::dvec3> directions() const { return method_.directions_.list(); }

    /// The occluders that may stand between the point and a node are those of the stack from `begin` on.
    void visit(std::uint32_t index, std::size_t begin) {
        const PatchClusters& clusters = method_.clusters_;
        const PatchClusters::Node& node = clusters.nodes()[index];
        if (node.extents.heights(horizon_, directions())[1] <= method_.tolerance_) return;
        const std::size_t end = stack_.size();
        Extents both = extents_;
        both.add(node.extents);
        for (std::size_t k = begin; k < end; ++k)
            if (mayStandBetween(*stack_[k], {&point_, 1}, node.extents, both, directions(), method_.tolerance_))
                stack_.push_back(stack_[k]);
        if (node.left == 0) {
            for (std::uint32_t c = node.first; c < node.last; ++c) {
                const PatchClusters::Cluster& cluster = clusters.clusters()[c];
                for (std::uint32_t lane = 0; lane < cluster.count; ++lane)
                    addTarget(clusters.targets()[cluster.target[lane]], end);
            }
        } else {
            visit(node.left, end);
            visit(node.right, end);
        }
        stack_.resize(end);
    }

    void addTarget(const Target& to, std::size_t firstOccluder) {
        const double height = to.plane.height(point_);
        if (std::abs(height) <= method_.tolerance_) return; // seen edge-on
        const bool front = height > 0.0;
        if (front ? to.frontHidden : !to.blackBack) return;
        ConvexPolygon above, below;
        split(front ? to.polygon : reversed(to.polygon), horizon_, 0.0, above, below);
        if (above.empty()) return;
        occluders_.clear();
        for (std::size_t k = firstOccluder; k < stack_.size(); ++k)
            if (standsBetween(*stack_[k], above)) occluders_.push_back(stack_[k]);
        const double factor = to.opacity * visibleFactor(above, front ? to.plane.normal : -to.plane.normal);
        if (!(factor > 0.0)) return;
        total_ += factor;
        accumulator_.add(front && to.patch != kNone ? to.patch : accumulator_.back(), factor);
    }

    /// Whether the point and part of the polygon lie on two sides of the occluder's plane: it must not hide what lies in it.
    bool standsBetween(const Occluder& occluder, const ConvexPolygon& polygon) const {
        const double t = method_.tolerance_;
        const double here = occluder.plane.height(point_);
        const auto there = cornerHeights(occluder.plane, polygon.points());
        return here > 0.0 ? there[0] < -t : there[1] > t;
    }

    double visibleFactor(const ConvexPolygon& polygon, const glm::dvec3& facing) {
        if (std::any_of(occluders_.begin(), occluders_.end(), [](const Occluder* o) { return o->holes; }))
            return pointToVisiblePolygon(point_, horizon_.normal, polygon.points()) * visibleShare(polygon, facing);
        return VisibleParts(point_, polygon, occluders_, method_.tolerance_, scratch_).formFactor(horizon_.normal);
    }

    /// The share that rays let through, to Gauss points of a polygon that faces the point.
    double visibleShare(const ConvexPolygon& polygon, const glm::dvec3& facing) const {
        constexpr int kOrder = 8;
        constexpr int kHalvings = 6; // in all as many rays as for a pair of patches
        std::vector<ConvexPolygon> parts{polygon};
        for (int k = 0; k < kHalvings; ++k) parts = halved(parts);
        std::vector<WeightedPoint> points;
        for (const ConvexPolygon& part : parts) appendGaussPoints(part.points(), kOrder, points);
        const float offset = method_.rays_.originOffset(0.0F);
        const glm::vec3 origin = glm::vec3(point_) + offset * glm::vec3(horizon_.normal);
        double visible = 0.0, all = 0.0;
        for (const auto& [y, weight] : points) {
            const glm::dvec3 d = y - point_;
            const double squared = glm::dot(d, d);
            const double value = -weight * glm::dot(horizon_.normal, d) * glm::dot(facing, d) / (squared * squared);
            all += value;
            const glm::vec3 end = glm::vec3(y) + offset * glm::vec3(facing);
            if (!method_.rays_.occluded({origin, end - origin, 1.0F})) visible += value;
        }
        return all > 0.0 ? visible / all : 0.0;
    }

    /// Each polygon cut across, through its centre.
    static std::vector<ConvexPolygon> halved(const std::vector<ConvexPolygon>& polygons) {
        std::vector<ConvexPolygon> halves;
        for (const ConvexPolygon& polygon : polygons)
            for (const ConvexPolygon& half : halvesOf(polygon))
                if (!half.empty()) halves.push_back(half);
        return halves;
    }

    const ClosedForm& method_;
    glm::dvec3 point_;
    Plane horizon_; ///< unit normal
    RowAccumulator& accumulator_;
    double total_ = 0.0;
    Extents extents_;
    std::vector<const Occluder*> stack_;
    std::vector<const Occluder*> occluders_; ///< of the target at hand
    VisibleParts::Scratch scratch_;
};

void ClosedForm::pointRow(const glm::vec3& origin, const glm::vec3& normal, std::uint32_t,
                          RowAccumulator& accumulator) const {
    PointRow(*this, glm::dvec3(origin), glm::dvec3(normal), accumulator).run();
}

} // namespace lambert
