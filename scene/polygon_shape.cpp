#include "scene/polygon_shape.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

namespace lambert {

namespace {

constexpr double kMinCornerSine = 1e-5; // flatter corners would leave a quad's half without area

double cross(const glm::dvec2& a, const glm::dvec2& b) { return a.x * b.y - a.y * b.x; }

} // namespace

glm::dvec3 newellNormal(std::span<const glm::dvec3> points) {
    glm::dvec3 sum(0.0);
    for (std::size_t i = 0; i < points.size(); ++i)
        sum += glm::cross(points[i] - points[0], points[(i + 1) % points.size()] - points[0]);
    return sum;
}

bool isConvex(std::span<const glm::dvec3> points, const glm::dvec3& normal) {
    for (std::size_t i = 0; i < points.size(); ++i) {
        const glm::dvec3 in = points[(i + 1) % points.size()] - points[i];
        const glm::dvec3 out = points[(i + 2) % points.size()] - points[(i + 1) % points.size()];
        const double turn = glm::dot(glm::cross(in, out), normal);
        if (!(turn > kMinCornerSine * glm::length(in) * glm::length(out))) return false;
    }
    return true;
}

double offPlane(std::span<const glm::dvec3> points, const glm::dvec3& normal) {
    glm::dvec3 centroid(0.0);
    for (const glm::dvec3& p : points) centroid += p;
    centroid /= static_cast<double>(points.size());
    double farthest = 0.0;
    for (const glm::dvec3& p : points) farthest = std::max(farthest, std::abs(glm::dot(p - centroid, normal)));
    return farthest;
}

std::vector<glm::dvec2> projected(std::span<const glm::dvec3> points, const glm::dvec3& normal) {
    const glm::dvec3 helper = std::abs(normal.x) < 0.6 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
    const glm::dvec3 u = glm::normalize(glm::cross(helper, normal));
    const glm::dvec3 v = glm::cross(normal, u);
    std::vector<glm::dvec2> result;
    for (const glm::dvec3& p : points) result.emplace_back(glm::dot(p - points[0], u), glm::dot(p - points[0], v));
    return result;
}

double areaWithHoles(std::span<const glm::dvec2> points, std::span<const std::size_t> loopSizes) {
    double area = 0.0;
    for (std::size_t loop = 0, begin = 0; loop < loopSizes.size(); begin += loopSizes[loop++]) {
        const auto corners = points.subspan(begin, loopSizes[loop]);
        double twice = 0.0;
        for (std::size_t k = 0; k < corners.size(); ++k) twice += cross(corners[k], corners[(k + 1) % corners.size()]);
        area += (loop == 0 ? 0.5 : -0.5) * std::abs(twice);
    }
    return area;
}

double areaOf(std::span<const std::array<std::uint32_t, 3>> triangles, std::span<const glm::dvec2> points) {
    double twice = 0.0;
    for (const auto& [a, b, c] : triangles) twice += cross(points[b] - points[a], points[c] - points[a]);
    return 0.5 * twice;
}

} // namespace lambert
