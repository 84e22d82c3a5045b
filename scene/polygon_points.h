#pragma once

#include "scene/scene.h"

#include <glm/vec2.hpp>

namespace lambert {

/// Maps the unit square to a polygon's chart (see polygonPoint) so that uniform points become uniform on the polygon.
class PolygonPoints {
public:
    PolygonPoints(const Scene& scene, const Polygon& polygon);

    glm::vec2 chartAt(const glm::dvec2& u) const;
    /// Of the area, in the triangle whose charts have u + v <= 1; all of a triangle's.
    double firstShare() const { return share_; }

private:
    double share_; ///< firstShare()
};

} // namespace lambert
