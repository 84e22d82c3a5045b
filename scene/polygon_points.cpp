#include "scene/polygon_points.h"

#include "core/warps.h"

#include <glm/geometric.hpp>

#include <algorithm>

namespace lambert {

PolygonPoints::PolygonPoints(const Scene& scene, const Polygon& polygon) : share_(1.0) {
    if (!polygon.isQuad()) return;
    const auto at = [&](int k) { return glm::dvec3(corner(scene, polygon, k)); };
    const glm::dvec3 diagonal = at(3) - at(1);
    const double first = glm::length(glm::cross(at(0) - at(1), diagonal));
    const double second = glm::length(glm::cross(at(2) - at(1), diagonal));
    if (first + second > 0.0) share_ = first / (first + second);
}

glm::vec2 PolygonPoints::chartAt(const glm::dvec2& u) const {
    const bool first = u.x < share_;
    const double rescaled = std::clamp(first ? u.x / share_ : (u.x - share_) / (1.0 - share_), 0.0, 1.0);
    const glm::dvec3 w = uniformTriangle({rescaled, u.y});
    return first ? glm::vec2(glm::dvec2(w.y, w.z)) : glm::vec2(glm::dvec2(1.0 - w.y, 1.0 - w.z));
}

} // namespace lambert
