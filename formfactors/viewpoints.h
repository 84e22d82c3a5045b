#pragma once

#include "meshing/patch_mesh.h"
#include "scene/rays/ray_caster.h"

#include <cstdint>

namespace lambert {

/// Of hemicubes and hemispheres.
struct ViewOptions {
    int resolution = 128;       //!< see there
    int perPatch = 1;           //!< views spread over a patch, 1 to 1024; more for patches with near neighbours
    bool randomRotation = true; //!< turns each about its normal by an angle of its own
    std::uint64_t seed = 1;     //!< of the angles and places
};

/// Where a hemicube or hemisphere stands, and how it is turned.
struct Viewpoint {
    glm::vec3 origin; ///< above the patch
    float angle;      ///< radians, about the patch's normal
};

/// The `index`-th viewpoint of a patch: its centroid if there is one, else points of a stratified sample of its
/// area. The same arguments give the same viewpoint.
Viewpoint viewpoint(const PatchMesh& mesh, const RayCaster& rays, std::uint32_t patch, int index,
                    const ViewOptions& options);

/// The angle (radians) of the `k`-th view from patch or point `index`; 0 without `randomRotation`.
float viewAngle(std::uint32_t index, int k, const ViewOptions& options);

/// Throws UsageError unless `perPatch` is 1 to 1024.
void checkPerPatch(int perPatch);

} // namespace lambert
