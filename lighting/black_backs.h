#pragma once

#include "meshing/patch_optics.h"
#include "scene/rays/ray_caster.h"
#include "solver/solution.h"

#include <optional>
#include <string>

namespace lambert {

/// How much of a bake's light ends on the black backs of one-sided faces, which mostly were meant to be fronts. What starts
/// inside an object or under it does not count, unless it emits, nor what ends on occluders, which are to be black.
struct BlackBacks {
    double rays = 0.0;     //!< of the rays from all surfaces, weighted by area
    double light = 0.0;    //!< of the light that came in, after all bounces: Σ A B F_back / (emitted + received)
    double emission = 0.0; //!< of what emitters give off, before any bounce: Σ A B_e F_back / Σ A B_e
    std::string material;  //!< whose backs take most of the largest of these; empty if that is next to nothing
};

/// `solution` with its energy and `covered`, of this mesh and the scene of these rays.
BlackBacks findBlackBacks(const PatchMesh& mesh, const PatchOptics& optics, const RayCaster& rays,
                          const RadiositySolution& solution);

/// What to tell the user, one line that names the largest share; none below 1 %.
std::optional<std::string> warningOf(const BlackBacks& backs);

} // namespace lambert
