#pragma once

#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace lambert {

/// Maps from the unit square, area-preserving up to a constant: uniform points stay uniform, strata stay strata.

/// To the unit disk, squares to sectors of rings.
/// P. Shirley, K. Chiu, "A low distortion map between disk and square", Journal of Graphics Tools 2(3), 1997.
inline glm::dvec2 concentricDisk(const glm::dvec2& u) {
    const double x = 2.0 * u.x - 1.0;
    const double y = 2.0 * u.y - 1.0;
    if (x == 0.0 && y == 0.0) return glm::dvec2(0.0);
    constexpr double kQuarter = std::numbers::pi / 4.0;
    const bool wide = std::abs(x) > std::abs(y);
    const double radius = wide ? x : y;
    const double angle = wide ? kQuarter * (y / x) : 2.0 * kQuarter - kQuarter * (x / y);
    return radius * glm::dvec2(std::cos(angle), std::sin(angle));
}

/// To directions about +z with density cos θ / π: the disk, lifted (Nusselt 1928). z > 0 but for rounding.
inline glm::dvec3 cosineHemisphere(const glm::dvec2& u) {
    const glm::dvec2 disk = concentricDisk(u);
    return {disk.x, disk.y, std::sqrt(std::max(0.0, 1.0 - glm::dot(disk, disk)))};
}

/// To directions with density 1 / 4π.
inline glm::dvec3 uniformSphere(const glm::dvec2& u) {
    const double z = 1.0 - 2.0 * u.x;
    const double radius = std::sqrt(std::max(0.0, 1.0 - z * z));
    const double angle = 2.0 * std::numbers::pi * u.y;
    return {radius * std::cos(angle), radius * std::sin(angle), z};
}

/// To barycentric weights of a triangle's corners.
inline glm::dvec3 uniformTriangle(const glm::dvec2& u) {
    const double root = std::sqrt(u.x);
    return {1.0 - root, root * (1.0 - u.y), root * u.y};
}

/// To weights of the corners of a convex planar quad whose triangles (0, 1, 2) and (0, 2, 3) have the given areas, not both
/// zero. (A bilinear map would not be uniform.)
inline std::array<double, 4> uniformQuad(const glm::dvec2& u, double area012, double area023) {
    const double share = area012 / (area012 + area023);
    const bool first = u.x < share;
    const glm::dvec2 rescaled(std::min(first ? u.x / share : (u.x - share) / (1.0 - share), 1.0), u.y);
    const glm::dvec3 w = uniformTriangle(rescaled);
    if (first) return {w.x, w.y, w.z, 0.0};
    return {w.x, 0.0, w.y, w.z};
}

} // namespace lambert
