#pragma once

#include "meshing/patch_mesh.h"
#include "scene/rays/ray_caster.h"

#include <cstdint>

namespace lambert {

/// Where a hemicube or hemisphere stands, and how it is turned.
struct Viewpoint {
    glm::vec3 origin; ///< above the patch
    float angle;      ///< radians, about the patch's normal
};

/// The `index`-th of `count` viewpoints of a patch: its centroid if there is one, else points of a stratified sample of its
/// area. The same arguments give the same viewpoint; without `randomRotation` the angle is 0.
Viewpoint viewpoint(const PatchMesh& mesh, const RayCaster& rays, std::uint32_t patch, int index, int count,
                    bool randomRotation, std::uint64_t seed);

/// The angle (radians) of the `k`-th view from patch or point `index`.
float viewAngle(std::uint32_t index, int k, std::uint64_t seed);

/// Throws UsageError unless `perPatch` is 1 to 1024.
void checkPerPatch(int perPatch);

} // namespace lambert
