#pragma once

#include "formfactors/convex_polygon.h"
#include "meshing/patch_mesh.h"
#include "scene/rays/ray_caster.h"

#include <glm/vec3.hpp>

namespace lambert {

/// A patch, or a point, as rays between many pairs of patches need it: the map of PatchPoints in single precision, computed
/// once.
struct PatchShape {
    glm::vec3 corner;                      ///< the first, metres
    glm::vec3 edge, diagonal, across;      ///< from it to the second, third and fourth
    glm::vec3 normal;                      ///< unit length
    float firstShare = 1.0F;               ///< area of the triangle of edge and diagonal, as a share of the whole
    float perFirst = 1.0F, perRest = 0.0F; ///< 1 / share of either triangle; 0 of none
    float lift = 0.0F;                     ///< metres; rays begin and end this far above it

    PatchShape(const RayCaster& rays, const PatchMesh& mesh, std::size_t patch);
    /// A point, not lifted.
    PatchShape(const glm::vec3& point, const glm::vec3& unitNormal)
        : corner(point), edge(0.0F), diagonal(0.0F), across(0.0F), normal(unitNormal) {}
};

ConvexPolygon polygonOf(const PatchMesh& mesh, std::size_t patch);

} // namespace lambert
