#pragma once

#include "meshing/mesh_scene.h"
#include "solver/direct_light.h"
#include "solver/solution.h"

#include <cstddef>
#include <vector>

namespace lambert {

// Rays slip between polygons that touch: in closed rooms about one of 10^8 does. Few rays of many are therefore no light, and
// say no more of how much there is than that it is too little to be told from none.

/// E_0 without what so few rays brought.
struct DirectIrradiance {
    std::vector<RgbSum> values; //!< #patches, per m²
    std::size_t strayRays = 0;  //!< rays that got through and do not count
};

/// DirectLight's irradiance. The light of a source (each light without area, the environment) counts as none if no more than
/// 10 of its rays in the whole scene got through, so that its own standard error is a third or more, or no more than
/// 10^-7 of them; unless a patch has fewer than 64 rays toward it.
DirectIrradiance directIrradiance(const PatchMesh& mesh, const RayCaster& rays, const DirectLightOptions& options,
                                  const LightSources& sources, Progress& progress);

/// The same for light that patches emit: takes the irradiance of all patches that do not emit out of the solution if together
/// they get no more than 10^-6 of what is emitted, and no straight line leads from an emitter to any of them (see
/// emissionArrives). Does nothing where lights without area contribute.
void dropStrayLight(const MeshedScene& scene, RadiositySolution& solution);

} // namespace lambert
