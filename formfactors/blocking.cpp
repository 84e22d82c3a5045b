#include "formfactors/blocking.h"

#include <glm/vec2.hpp>

#include <algorithm>
#include <array>
#include <vector>

namespace lambert {

namespace {

using Points2 = std::vector<glm::dvec2>;

glm::dvec2 inPlane(const Occluder& occluder, const glm::dvec3& p) {
    const glm::dvec3 d = p - occluder.corners[0];
    return {glm::dot(d, occluder.axisU), glm::dot(d, occluder.axisV)};
}

/// The lowest and highest of the points along an axis.
std::array<double, 2> range(const Points2& points, const glm::dvec2& axis) {
    std::array<double, 2> result{glm::dot(points[0], axis), glm::dot(points[0], axis)};
    for (const glm::dvec2& p : points) {
        const double t = glm::dot(p, axis);
        result[0] = std::min(result[0], t);
        result[1] = std::max(result[1], t);
    }
    return result;
}

/// Whether every line from one polygon to the other crosses the occluder's plane beside it or in it. For polygons on different
/// sides of the plane the crossings of all lines lie within the convex hull of those between corners.
Blocking crossing(const ConvexPolygon& from, const ConvexPolygon& to, const Occluder& occluder) {
    static thread_local Points2 points, corners;
    points.clear();
    std::array<double, ConvexPolygon::kMostCorners> heightTo;
    for (std::size_t j = 0; j < to.size; ++j) heightTo[j] = occluder.plane.height(to.corners[j]);
    for (const glm::dvec3& p : from.points()) {
        const double heightFrom = occluder.plane.height(p);
        for (std::size_t j = 0; j < to.size; ++j) {
            if (!(heightFrom * heightTo[j] < 0.0)) return Blocking::Unknown;
            const double t = heightFrom / (heightFrom - heightTo[j]);
            points.push_back(inPlane(occluder, p + t * (to.corners[j] - p)));
        }
    }
    corners.clear();
    for (const glm::dvec3& p : occluder.corners) corners.push_back(inPlane(occluder, p));

    bool hidden = true;
    for (std::size_t k = 0; k < corners.size(); ++k) {
        const glm::dvec2 along = corners[(k + 1) % corners.size()] - corners[k];
        const glm::dvec2 inward(-along.y, along.x);
        const double edge = glm::dot(inward, corners[k]);
        const auto [low, high] = range(points, inward);
        if (high <= edge) return Blocking::Clear;
        hidden = hidden && low >= edge;
    }
    if (hidden) return Blocking::Hidden;
    // The sides of the hull run between lines that share an end: try the directions of those from the first corners.
    const auto separates = [&](const glm::dvec2& side) {
        const glm::dvec2 axis(-side.y, side.x);
        const auto lines = range(points, axis), blocker = range(corners, axis);
        return lines[1] < blocker[0] || blocker[1] < lines[0];
    };
    for (std::size_t j = 0; j < to.size; ++j)
        if (separates(points[(j + 1) % to.size] - points[j])) return Blocking::Clear;
    for (std::size_t i = 0; i < from.size; ++i)
        if (separates(points[(i + 1) % from.size * to.size] - points[i * to.size])) return Blocking::Clear;
    return Blocking::Unknown;
}

} // namespace

bool allAbove(const Plane& plane, std::span<const glm::dvec3> points, double height) {
    return std::all_of(points.begin(), points.end(), [&](const auto& p) { return plane.height(p) >= height; });
}
bool allBelow(const Plane& plane, std::span<const glm::dvec3> points, double height) {
    return std::all_of(points.begin(), points.end(), [&](const auto& p) { return plane.height(p) <= height; });
}

Blocking blocking(const ConvexPolygon& from, const Plane& fromPlane, const ConvexPolygon& to, const Plane& toPlane,
                  const Occluder& occluder, double tolerance) {
    const Plane& plane = occluder.plane;
    if (allAbove(plane, from.points(), -tolerance) && allAbove(plane, to.points(), -tolerance)) return Blocking::Clear;
    if (allBelow(plane, from.points(), tolerance) && allBelow(plane, to.points(), tolerance)) return Blocking::Clear;
    if (allBelow(fromPlane, occluder.corners, tolerance) || allBelow(toPlane, occluder.corners, tolerance))
        return Blocking::Clear;
    const Blocking found = crossing(from, to, occluder);
    return found == Blocking::Hidden && occluder.holes ? Blocking::Unknown : found;
}

} // namespace lambert
