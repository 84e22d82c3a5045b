#pragma once

#include "formfactors/convex_polygon.h"
#include "formfactors/extents.h"
#include "scene/scene.h"

#include <span>
#include <vector>

namespace lambert {

/// A convex plane polygon that light does not pass, from either side.
struct Occluder {
    std::vector<glm::dvec3> corners;      //!< counter-clockwise about the plane's normal
    std::vector<std::uint32_t> neighbour; //!< per corner: the occluder beyond the edge that begins there; kNone
    Plane plane;                          //!< unit normal
    glm::dvec3 axisU{0.0}, axisV{0.0};    //!< unit, in the plane
    Extents extents;
    std::uint32_t polygon = 0; //!< one of Scene::polygons it consists of
    /// It is part of a closed surface with these extents and its fronts outside. From outside them a back face hides nothing
    /// that front faces do not hide.
    bool solid = false;
    Extents solidExtents;
    bool holes = false; //!< light passes in places, see Material::hasHoles
};

struct Occluders {
    std::vector<Occluder> list;
    std::vector<std::uint32_t> ofPolygon; //!< #Scene::polygons, into the list
};

/// Whether an occluder may stand between some points and what lies within `there`; `both` are the extents of both, and
/// `directions` the list that they refer to. What is nearer to a plane than `tolerance` (metres) counts as in it.
bool mayStandBetween(const Occluder& occluder, std::span<const glm::dvec3> from, const Extents& there,
                     const Extents& both, std::span<const glm::dvec3> directions, double tolerance);

/// The polygons of a scene as few convex occluders: neighbours in one plane are joined where they share an edge and the whole
/// stays convex. Points within `tolerance` (metres) of a plane count as in it. Polygons with holes are not joined.
/// The planes are entered into `directions`.
Occluders gatherOccluders(const Scene& scene, Directions& directions, double tolerance);

} // namespace lambert
