#include "formfactors/visible_parts.h"

#include "formfactors/closed_form.h"

#include <cmath>

namespace lambert {

namespace {

/// How the corners lie to a plane.
struct Sides {
    bool above = false, below = false;
    Sides(const Plane& plane, const ConvexPolygon& polygon) {
        for (const glm::dvec3& p : polygon.points()) {
            const double height = plane.height(p);
            above = above || height > 0.0;
            below = below || height < 0.0;
        }
    }
};

/// Whether part of the polygon lies in front of all planes; then what does not is appended to `left`.
bool subtractCone(std::span<const Plane> planes, const ConvexPolygon& polygon, std::vector<ConvexPolygon>& left) {
    std::array<std::size_t, ConvexPolygon::kMostCorners + 1> crossing;
    std::size_t count = 0;
    for (std::size_t k = 0; k < planes.size(); ++k) {
        const Sides sides(planes[k], polygon);
        if (!sides.above) return false;
        if (sides.below) crossing[count++] = k;
    }
    const std::size_t first = left.size();
    ConvexPolygon inside = polygon, front, behind;
    for (std::size_t c = 0; c < count; ++c) {
        split(inside, planes[crossing[c]], 0.0, front, behind);
        if (!behind.empty()) left.push_back(behind);
        if (front.empty()) {
            // Beside the region after all: it need not be in pieces.
            left.erase(left.begin() + static_cast<std::ptrdiff_t>(first), left.end());
            return false;
        }
        inside = front;
    }
    return true;
}

} // namespace

VisibleParts::VisibleParts(const glm::dvec3& point, const ConvexPolygon& polygon,
                           std::span<const Occluder* const> occluders, double tolerance)
    : point_(point), parts_([]() -> std::vector<ConvexPolygon>& {
          static thread_local std::vector<ConvexPolygon> scratch;
          return scratch;
      }()) {
    parts_.assign(1, polygon);
    for (const Occluder* occluder : occluders) {
        subtract(*occluder, polygon, tolerance);
        if (parts_.empty()) break;
    }
    if (parts_.empty()) visibility_ = Visibility::None;
}

void VisibleParts::subtract(const Occluder& occluder, const ConvexPolygon& whole, double tolerance) {
    const double height = occluder.plane.height(point_);
    if (std::abs(height) <= 1e-3 * tolerance) return; // seen edge-on
    // What is hidden lies behind the occluder and within the cone of its edges. Planes that the whole polygon lies in front of
    // cut none of its parts.
    static thread_local std::array<Plane, ConvexPolygon::kMostCorners + 1> planes;
    std::size_t count = 0;
    const double side = height > 0.0 ? 1.0 : -1.0;
    const std::size_t n = occluder.corners.size();
    for (std::size_t k = 0; k <= n; ++k) {
        Plane& plane = planes[count];
        if (k == 0) {
            plane = {-side * occluder.plane.normal, -side * occluder.plane.offset, -1};
        } else {
            const glm::dvec3 &begin = occluder.corners[k - 1], &end = occluder.corners[k < n ? k : 0];
            plane = Plane::through(point_, side * glm::cross(end - point_, begin - point_));
        }
        const Sides sides(plane, whole);
        if (!sides.above) return;
        if (sides.below) ++count;
    }
    for (std::size_t k = 0, parts = parts_.size(); k < parts;) {
        static thread_local std::vector<ConvexPolygon> left;
        left.clear();
        if (!subtractCone({planes.data(), count}, parts_[k], left)) {
            ++k;
            continue;
        }
        visibility_ = Visibility::Part;
        // The last of those not yet looked at takes its place, new ones go to the end.
        --parts;
        parts_[k] = parts_[parts];
        parts_[parts] = parts_.back();
        parts_.pop_back();
        parts_.insert(parts_.end(), left.begin(), left.end());
    }
}

double VisibleParts::formFactor(const glm::dvec3& normal) const {
    double sum = 0.0;
    for (const ConvexPolygon& part : parts_) sum += pointToVisiblePolygon(point_, normal, part.points());
    return sum;
}

} // namespace lambert
