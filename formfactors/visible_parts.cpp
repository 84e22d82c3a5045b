#include "formfactors/visible_parts.h"

#include "formfactors/closed_form.h"

#include <cmath>

namespace lambert {

namespace {

/// Whether part of the polygon lies in front of all planes; then what does not is appended to `left`.
bool subtractCone(std::span<const Plane> planes, const ConvexPolygon& polygon, std::vector<ConvexPolygon>& left) {
    std::array<std::size_t, ConvexPolygon::kMostCorners + 1> crossing;
    std::size_t count = 0;
    for (std::size_t k = 0; k < planes.size(); ++k) {
        const auto [low, high] = cornerHeights(planes[k], polygon.points());
        if (!(high > 0.0)) return false;
        if (low < 0.0) crossing[count++] = k;
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
                           std::span<const Occluder* const> occluders, double tolerance, Scratch& scratch)
    : point_(point), scratch_(scratch) {
    scratch_.parts.assign(1, polygon);
    for (const Occluder* occluder : occluders) {
        subtract(*occluder, polygon, tolerance);
        if (scratch_.parts.empty()) break;
    }
    if (scratch_.parts.empty()) visibility_ = Visibility::None;
}

void VisibleParts::subtract(const Occluder& occluder, const ConvexPolygon& whole, double tolerance) {
    const double height = occluder.plane.height(point_);
    if (std::abs(height) <= 1e-3 * tolerance) return; // seen edge-on
    // What is hidden lies behind the occluder and within the cone of its edges. Planes that the whole polygon lies in front of
    // cut none of its parts.
    std::size_t count = 0;
    const double side = height > 0.0 ? 1.0 : -1.0;
    const std::size_t n = occluder.corners.size();
    for (std::size_t k = 0; k <= n; ++k) {
        Plane& plane = scratch_.planes[count];
        if (k == 0) {
            plane = {-side * occluder.plane.normal, -side * occluder.plane.offset, -1};
        } else {
            const glm::dvec3 &begin = occluder.corners[k - 1], &end = occluder.corners[k < n ? k : 0];
            plane = Plane::through(point_, side * glm::cross(end - point_, begin - point_));
        }
        const auto [low, high] = cornerHeights(plane, whole.points());
        if (!(high > 0.0)) return;
        if (low < 0.0) ++count;
    }
    std::vector<ConvexPolygon>& parts = scratch_.parts;
    for (std::size_t k = 0, end = parts.size(); k < end;) {
        scratch_.left.clear();
        if (!subtractCone({scratch_.planes.data(), count}, parts[k], scratch_.left)) {
            ++k;
            continue;
        }
        visibility_ = Visibility::Part;
        // The last of those not yet looked at takes its place, new ones go to the end.
        --end;
        parts[k] = parts[end];
        parts[end] = parts.back();
        parts.pop_back();
        parts.insert(parts.end(), scratch_.left.begin(), scratch_.left.end());
    }
}

double VisibleParts::formFactor(const glm::dvec3& normal) const {
    double sum = 0.0;
    for (const ConvexPolygon& part : scratch_.parts) sum += pointToVisiblePolygon(point_, normal, part.points());
    return sum;
}

} // namespace lambert
