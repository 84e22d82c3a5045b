#include "formfactors/convex_polygon.h"

#include <algorithm>
#include <cmath>

namespace lambert {

ConvexPolygon::ConvexPolygon(std::span<const glm::dvec3> points) {
    for (const glm::dvec3& p : points) add(p);
}

ConvexPolygon& ConvexPolygon::operator=(const ConvexPolygon& other) {
    std::copy_n(other.corners.begin(), other.size, corners.begin());
    size = other.size;
    return *this;
}

glm::dvec3 ConvexPolygon::centre() const {
    glm::dvec3 sum(0.0);
    for (const glm::dvec3& p : points()) sum += p;
    return sum / static_cast<double>(size);
}

double ConvexPolygon::radiusAround(const glm::dvec3& point) const {
    double squared = 0.0;
    for (const glm::dvec3& p : points()) squared = std::max(squared, glm::dot(p - point, p - point));
    return std::sqrt(squared);
}

std::array<double, 2> cornerHeights(const Plane& plane, std::span<const glm::dvec3> points) {
    std::array<double, 2> range{plane.height(points[0]), plane.height(points[0])};
    for (const glm::dvec3& p : points) {
        const double height = plane.height(p);
        range[0] = std::min(range[0], height);
        range[1] = std::max(range[1], height);
    }
    return range;
}

ConvexPolygon reversed(const ConvexPolygon& polygon) {
    ConvexPolygon result = polygon;
    std::reverse(result.corners.begin(), result.corners.begin() + static_cast<std::ptrdiff_t>(result.size));
    return result;
}

void split(const ConvexPolygon& polygon, const Plane& plane, double tolerance, ConvexPolygon& front,
           ConvexPolygon& behind) {
    front.size = 0;
    behind.size = 0;
    std::array<double, ConvexPolygon::kMostCorners> height;
    bool anyFront = false, anyBehind = false;
    for (std::size_t k = 0; k < polygon.size; ++k) {
        height[k] = plane.height(polygon.corners[k]);
        anyFront = anyFront || height[k] > tolerance;
        anyBehind = anyBehind || height[k] < -tolerance;
    }
    if (!anyBehind || !anyFront) {
        (anyBehind ? behind : front) = polygon;
        return;
    }
    for (std::size_t k = 0; k < polygon.size; ++k) {
        const std::size_t next = k + 1 < polygon.size ? k + 1 : 0;
        const glm::dvec3& p = polygon.corners[k];
        if (height[k] >= -tolerance) front.add(p);
        if (height[k] <= tolerance) behind.add(p);
        const bool crosses = (height[k] > tolerance && height[next] < -tolerance) ||
                             (height[k] < -tolerance && height[next] > tolerance);
        if (crosses) {
            const glm::dvec3 at = p + height[k] / (height[k] - height[next]) * (polygon.corners[next] - p);
            front.add(at);
            behind.add(at);
        }
    }
}

std::array<ConvexPolygon, 2> halvesOf(const ConvexPolygon& polygon) {
    const glm::dvec3 centre = polygon.centre();
    glm::dvec3 longest(0.0);
    for (const glm::dvec3& p : polygon.points())
        if (glm::dot(p - centre, p - centre) > glm::dot(longest, longest)) longest = p - centre;
    std::array<ConvexPolygon, 2> halves;
    split(polygon, Plane::through(centre, longest), 0.0, halves[0], halves[1]);
    return halves;
}

} // namespace lambert
