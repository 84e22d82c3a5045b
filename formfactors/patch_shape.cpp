#include "formfactors/patch_shape.h"

#include "formfactors/patch_sampling.h"
#include "meshing/patch_offset.h"

namespace lambert {

PatchShape::PatchShape(const RayCaster& rays, const PatchMesh& mesh, std::size_t patch)
    : normal(mesh.normal[patch]), lift(patchOriginOffset(rays, mesh, patch)) {
    const PatchPoints points(mesh, patch);
    const auto& corners = points.corners();
    corner = corners[0];
    edge = corners[1] - corner;
    diagonal = corners[2] - corner;
    across = corners[3] - corner;
    firstShare = points.firstShare();
    perFirst = firstShare > 0.0F ? 1.0F / firstShare : 0.0F;
    perRest = firstShare < 1.0F ? 1.0F / (1.0F - firstShare) : 0.0F;
}

ConvexPolygon polygonOf(const PatchMesh& mesh, std::size_t patch) {
    ConvexPolygon polygon;
    for (int k = 0; k < mesh.cornerCount(patch); ++k) polygon.add(glm::dvec3(mesh.position(patch, k)));
    return polygon;
}

} // namespace lambert
