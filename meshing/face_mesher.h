#pragma once

#include "meshing/contact_strips.h"
#include "meshing/pair_triangles.h"
#include "meshing/plane_frame.h"
#include "scene/scene.h"

#include <cstdint>
#include <optional>
#include <span>
#include <utility>
#include <vector>

namespace lambert {

/// A polygon to be divided: its border with all vertices on it, and the lines along which other surfaces stand on it.
struct FaceOutline {
    PlaneFrame frame;
    std::vector<std::uint32_t> border;                             //!< counter-clockwise, no repetition
    std::vector<std::pair<std::uint32_t, std::uint32_t>> contacts; //!< inside the polygon; no end outside
    const FaceLines* lines =
        nullptr; //!< more lines, in the frame; those that end on no vertex of the border are left out
};

/// Grid of a planar quad: `sides[k]` runs from corner k to corner k + 1, opposite sides have equally many vertices.
/// Appends inner vertices, numbered on from `positions`, to `added`, which is empty. Returns columns × rows quads, row by row
/// along side 0.
std::vector<Corners> gridFace(const std::array<std::vector<std::uint32_t>, 4>& sides,
                              std::span<const glm::vec3> positions, std::vector<glm::vec3>& added);

/// Any other face: its border stays, a square lattice of `spacing` metres fills the inside, and a constrained Delaunay
/// triangulation joins the two, its triangles paired to quads where that is good. Appends inner vertices, numbered on from
/// `positions`, to `added`, which is empty. Nothing if the border or the contacts cross themselves or each other (`added`
/// then stays empty).
std::optional<std::vector<Corners>> triangulateFace(const FaceOutline& outline, double spacing,
                                                    std::span<const glm::vec3> positions,
                                                    std::vector<glm::vec3>& added);

} // namespace lambert
