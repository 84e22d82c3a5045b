#pragma once

#include "meshing/mesh_scene.h"
#include "solver/solution.h"

#include <cstddef>
#include <string>
#include <vector>

namespace lambert {

/// Whether nothing emits and nothing is lit. `direct` is E_0 per m², #patches.
bool isDark(const PatchOptics& optics, const std::vector<RgbSum>& direct);

/// The solution of a scene that is dark.
RadiositySolution darkness(std::size_t patches);

/// Says that there is nothing to be seen beyond what emits, why, and what can be done: one line for each cause; none where
/// something is lit and not black. `strayRays` as in DirectIrradiance.
std::vector<std::string> warningsOfDarkness(const MeshedScene& scene, const RadiositySolution& solution,
                                            std::size_t strayRays);

} // namespace lambert
