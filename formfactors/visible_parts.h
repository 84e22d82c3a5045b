#pragma once

#include "formfactors/convex_polygon.h"
#include "formfactors/occluders.h"

#include <array>
#include <span>
#include <vector>

namespace lambert {

/// How much of a polygon is visible.
enum class Visibility { None, Part, All };

/// The parts of `polygon` that are visible from `point` past the occluders; exact. An occluder
/// whose plane passes the point within a thousandth of `tolerance` (metres) is seen edge-on and hides nothing.
class VisibleParts {
public:
    /// Keeps its memory from one to the next; serves one at a time.
    struct Scratch {
        std::vector<ConvexPolygon> parts, left;
        std::array<Plane, ConvexPolygon::kMostCorners + 1> planes;
    };

    VisibleParts(const glm::dvec3& point, const ConvexPolygon& polygon, std::span<const Occluder* const> occluders,
                 double tolerance, Scratch& scratch);
    Visibility visibility() const { return visibility_; }
    /// The fraction of what leaves a surface element at the point (unit `normal`) that reaches the front of the visible
    /// parts; the polygon lies above the element's horizon and faces it.
    double formFactor(const glm::dvec3& normal) const;

private:
    void subtract(const Occluder& occluder, const ConvexPolygon& whole, double tolerance);

    glm::dvec3 point_;
    Visibility visibility_ = Visibility::All;
    Scratch& scratch_;
};

} // namespace lambert
