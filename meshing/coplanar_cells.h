#pragma once

#include "meshing/plane_frame.h"
#include "scene/scene.h"

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace lambert {

/// Polygons of one plane, and the plane cut along all their edges into triangles, each of which every polygon covers or leaves free.
struct CoplanarCells {
    PlaneFrame frame;
    std::vector<std::uint32_t> polygons; //!< into Scene::polygons, ascending
    std::vector<bool> along;             //!< #polygons: the front is seen where that of the frame is

    std::vector<glm::dvec2> points;    //!< in the frame; in space at `places`
    std::vector<glm::dvec3> places;    //!< #points, metres
    std::vector<std::uint32_t> vertex; //!< #points, into Scene::positions; kNone: a point that was added

    std::vector<std::array<std::uint32_t, 3>> triangles; //!< into points, counter-clockwise in the frame
    std::vector<std::vector<std::uint32_t>> covering;    //!< #triangles: at least one, into `polygons`, ascending

    double area(std::size_t triangle) const; //!< m²
    glm::dvec2 centre(std::size_t triangle) const;
};

/// Cuts polygons that lie in one plane. Quads with a surface (see SurfaceCorners) are cut along their diagonal, too: it is linear on
/// their halves. Points within `tolerance` (metres) of a line lie on it. Nothing if the lines cannot be untangled.
std::optional<CoplanarCells> coplanarCells(const Scene& scene, std::span<const std::uint32_t> polygons,
                                           double tolerance);

} // namespace lambert
