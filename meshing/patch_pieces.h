#pragma once

#include "meshing/patch_mesh.h"

#include <glm/vec3.hpp>

#include <array>
#include <vector>

namespace lambert {

/// The part of a patch that lies in one triangle of its source polygon, where texture coordinates and tints are linear.
struct PatchPiece {
    std::array<std::size_t, 3> corners{}; //!< the triangle, as corners of the polygon
    std::vector<glm::dvec3> border; //!< #corners of the piece (at most 5), as weights of the triangle's corners, sum 1
    glm::dvec3 centroid{0.0};       //!< the same of the piece's centroid
    double share = 1.0;             //!< of the patch's area
};

/// The parts of a patch in the triangle (0, 1, 2) of its polygon, or in (0, 1, 3) and (2, 3, 1) of a quad; their shares add
/// up to 1. A patch without area is one piece.
std::vector<PatchPiece> patchPieces(const Scene& scene, const PatchMesh& mesh, std::size_t patch);

} // namespace lambert
