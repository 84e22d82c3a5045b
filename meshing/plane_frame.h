#pragma once

#include "scene/scene.h"

#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <algorithm>
#include <limits>
#include <span>
#include <vector>

namespace lambert {

/// The area of the parallelogram of two vectors of a plane, positive if the second lies to the left of the first.
inline double cross(const glm::dvec2& a, const glm::dvec2& b) { return a.x * b.y - a.y * b.x; }

/// How deep a point lies inside a convex, counter-clockwise border, metres; negative outside.
inline double depthInside(std::span<const glm::dvec2> border, const glm::dvec2& point) {
    double depth = std::numeric_limits<double>::max();
    for (std::size_t k = 0; k < border.size(); ++k) {
        const glm::dvec2 edge = border[(k + 1) % border.size()] - border[k];
        const double length = glm::length(edge);
        if (length > 0.0) depth = std::min(depth, cross(edge, point - border[k]) / length);
    }
    return depth;
}

/// Coordinates in the plane of a polygon, in metres: the first axis along its longest edge, the polygon's front seen
/// counter-clockwise.
struct PlaneFrame {
    glm::dvec3 origin, axisX, axisY;

    glm::dvec2 project(const glm::vec3& point) const {
        const glm::dvec3 d = glm::dvec3(point) - origin;
        return {glm::dot(d, axisX), glm::dot(d, axisY)};
    }
    glm::vec3 lift(glm::dvec2 point) const { return glm::vec3(origin + point.x * axisX + point.y * axisY); }
    glm::dvec3 normal() const { return glm::cross(axisX, axisY); }
    double height(const glm::vec3& point) const { return glm::dot(glm::dvec3(point) - origin, normal()); }
    /// The corners of a polygon.
    std::vector<glm::dvec2> outline(const Scene& scene, const Polygon& polygon) const {
        std::vector<glm::dvec2> corners;
        for (int k = 0; k < polygon.size(); ++k) corners.push_back(project(corner(scene, polygon, k)));
        return corners;
    }
};

inline PlaneFrame planeFrame(const Scene& scene, const Polygon& polygon) {
    glm::dvec3 longest(0.0);
    for (int k = 0; k < polygon.size(); ++k) {
        const glm::dvec3 edge =
            glm::dvec3(corner(scene, polygon, (k + 1) % polygon.size())) - glm::dvec3(corner(scene, polygon, k));
        if (glm::dot(edge, edge) > glm::dot(longest, longest)) longest = edge;
    }
    // In double from the corners: the float area vector of a sliver is a poor normal.
    const glm::dvec3 a(corner(scene, polygon, 0));
    const glm::dvec3 b(corner(scene, polygon, 1));
    const glm::dvec3 c(corner(scene, polygon, 2));
    const glm::dvec3 normal =
        polygon.isQuad() ? glm::cross(c - a, glm::dvec3(corner(scene, polygon, 3)) - b) : glm::cross(b - a, c - a);
    PlaneFrame frame{};
    frame.origin = a;
    const glm::dvec3 n = glm::normalize(normal);
    frame.axisX = glm::normalize(longest - glm::dot(longest, n) * n);
    frame.axisY = glm::cross(n, frame.axisX);
    return frame;
}

} // namespace lambert
