#include "scene/scene.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <limits>

namespace lambert {

glm::vec3 areaVector(const Scene& scene, const Polygon& polygon) {
    // In double: of a sliver a float cross product keeps only rounding errors.
    const glm::dvec3 a(corner(scene, polygon, 0));
    const glm::dvec3 b(corner(scene, polygon, 1));
    const glm::dvec3 c(corner(scene, polygon, 2));
    if (!polygon.isQuad()) return glm::vec3(0.5 * glm::cross(b - a, c - a));
    return glm::vec3(0.5 * glm::cross(c - a, glm::dvec3(corner(scene, polygon, 3)) - b));
}

double longestEdge(const Scene& scene, const Polygon& polygon) {
    double longest = 0.0;
    for (int k = 0; k < polygon.size(); ++k)
        longest = std::max(longest, glm::distance(glm::dvec3(corner(scene, polygon, k)),
                                                  glm::dvec3(corner(scene, polygon, (k + 1) % polygon.size()))));
    return longest;
}

double polygonArea(const Scene& scene, const Polygon& polygon) {
    return glm::length(glm::dvec3(areaVector(scene, polygon)));
}

float Bounds::diagonal() const { return glm::length(size()); }

Bounds boundsOf(const Scene& scene) {
    if (scene.polygons.empty()) return {};
    Bounds bounds{glm::vec3(std::numeric_limits<float>::max()), glm::vec3(std::numeric_limits<float>::lowest())};
    for (const Polygon& polygon : scene.polygons) {
        const Bounds own = boundsOf(scene, polygon);
        bounds.lower = glm::min(bounds.lower, own.lower);
        bounds.upper = glm::max(bounds.upper, own.upper);
    }
    return bounds;
}

Bounds boundsOf(const Scene& scene, const Polygon& polygon) {
    Bounds bounds{corner(scene, polygon, 0), corner(scene, polygon, 0)};
    for (int k = 1; k < polygon.size(); ++k) {
        bounds.lower = glm::min(bounds.lower, corner(scene, polygon, k));
        bounds.upper = glm::max(bounds.upper, corner(scene, polygon, k));
    }
    return bounds;
}

} // namespace lambert
