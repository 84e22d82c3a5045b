#pragma once

#include "meshing/patch_mesh.h"
#include "scene/rays/ray_caster.h"

#include <cstddef>

namespace lambert {

/// Rays that leave a patch start this far above it, metres: RayCaster::originOffset, and as much more as the patch lies beneath
/// the polygon it is a part of (a border takes up its neighbours' vertices, which may be off its plane by the weld tolerance; a quad
/// need not be quite plane), so that none meets that polygon. `mesh` is a division of the rays' scene.
float patchOriginOffset(const RayCaster& rays, const PatchMesh& mesh, std::size_t patch);

} // namespace lambert
