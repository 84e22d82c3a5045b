#pragma once

#include "core/progress.h"
#include "scene/rays/ray_caster.h"
#include "vpl/receiver.h"
#include "vpl/virtual_point_light.h"

#include <cstdint>
#include <span>
#include <vector>

namespace lambert {

/// What many lights give to many receivers.
struct ShadowedSum {
    std::vector<glm::dvec3> irradiance;     //!< #receivers
    std::vector<glm::dvec3> cut;            //!< #receivers: what G_max took away
    std::vector<glm::dvec3> glossyRadiance; //!< #receivers: by their gloss, toward their eyes; empty if none has any
    std::uint64_t rays = 0;
};

/// What shines.
struct ShadowedLights {
    std::span<const VirtualPointLight> virtualLights;
    std::span<const PunctualLight> punctual;
};

/// The sum of gatherIrradiance without recovery; `largestTerm` is G_max (1/m², may be infinite).
ShadowedSum sumLights(const RayCaster& rays, const ShadowedLights& lights, std::span<const Receiver> receivers,
                      double largestTerm, Progress& progress);

} // namespace lambert
