#pragma once

#include "meshing/patch_optics.h"
#include "scene/rays/ray_caster.h"

#include <vector>

namespace lambert {

/// Of each patch, whether it sees nothing but the dark inside of something: the underside of what stands on a surface, and what of
/// the surface is beneath it.
///
/// A patch is hidden if everywhere another face touches it, front to front, and behind one of the two lies the inside of a
/// solid, where all that is met are black backs. (Two faces back to back, of a partition, lie in one plane as well, but light
/// reaches both.) A patch that touches nothing but sees black backs alone is hidden too unless it emits: light that is lost on
/// backs is not to be passed over. `mesh` is a division of the rays' scene, `optics` are its.
std::vector<bool> findHiddenPatches(const RayCaster& rays, const PatchMesh& mesh, const PatchOptics& optics);

} // namespace lambert
