#pragma once

#include "scene/rays/ray_caster.h"

#include <string>
#include <vector>

namespace lambert {

/// Lights that light nothing: which, and what becomes of their light; and what can be done.
struct LostLight {
    std::string problem, remedy;
};

/// What emits, the lights without area and the environment, as far as none of their light arrives at a front that does not
/// emit (see LightFate). Those to which the same happens are one entry.
std::vector<LostLight> findLostLight(const RayCaster& rays);

} // namespace lambert
