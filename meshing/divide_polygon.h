#pragma once

#include "meshing/contacts.h"
#include "meshing/edge_division.h"
#include "meshing/face_mesher.h"
#include "scene/scene.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace lambert {

/// What becomes of one polygon.
struct DividedPolygon {
    std::vector<glm::vec3> added; //!< inner vertices, numbered on from those that were there
    std::vector<Corners> faces;   //!< of its patches; none: it only blocks light
    std::size_t columns = 0;      //!< of a grid, whose faces come row by row; 0: no grid
    std::size_t rows = 0;
    std::vector<std::uint32_t> border; //!< of a polygon that only blocks light
    bool undivided = false;            //!< could not be divided cleanly, kept whole
    bool contactsFollowed = false;     //!< divided along its contact lines
    bool contactsIgnored = false;      //!< its contact lines cross each other
};

/// Divides a polygon into patches about `length` metres long, which end at its divided edges; `contact`, if not null, tells
/// what stands on it, and `lines` which other lines no patch shall cross. `positions` are the vertices of the scene and of the divided edges.
DividedPolygon dividePolygon(const Scene& scene, const Polygon& polygon, const EdgeDivision& division,
                             const PlanarContact* contact, const FaceLines* lines, double length,
                             std::span<const glm::vec3> positions);

/// The polygon as it is, as its only patch; or, if it only blocks light, none.
DividedPolygon keptWhole(const Scene& scene, const Polygon& polygon);

} // namespace lambert
