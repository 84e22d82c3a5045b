#pragma once

#include "scene/scene.h"

#include <glm/vec3.hpp>

#include <cstdint>
#include <map>
#include <utility>
#include <vector>

namespace lambert {

/// An edge over a polygon, as far as it is near to it.
struct OutlineEdge {
    glm::dvec3 from, to; //!< metres, on the edge
    double gap;          //!< mean distance from the polygon's plane, metres
};

/// The outline of one object over a polygon: edges beyond which the gap between the two is open.
struct Outline {
    std::uint32_t below = 0;        //!< the polygon
    std::vector<OutlineEdge> edges; //!< connected
    std::vector<std::uint32_t>
        hovering;          //!< polygons at these edges that face the one below, wider than twice the gap; ascending
    double length = 0.0;   //!< of all edges, metres
    double emission = 0.0; //!< brightest of the polygons' emitted radiance, mean of r, g, b; W m⁻² sr⁻¹
};

struct HoveringOutlines {
    std::vector<Outline> outlines; //!< in the order of the polygons below
    /// Edges that touch a polygon which is below something, as vertices.
    std::map<std::uint32_t, std::vector<std::pair<std::uint32_t, std::uint32_t>>> touching;
};

/// What hovers over the polygons of a prepared scene nearer than `reach` metres; over smaller polygons only nearer than half
/// their size. Surfaces that go on down to the polygon enclose the gap and are no outline.
HoveringOutlines findHoveringOutlines(const Scene& scene, double reach);

} // namespace lambert
