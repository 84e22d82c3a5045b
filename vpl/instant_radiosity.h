#pragma once

#include "core/progress.h"
#include "scene/rays/ray_caster.h"
#include "solver/problem.h"
#include "vpl/gather.h"
#include "vpl/trace_lights.h"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace lambert {

struct InstantRadiosityOptions {
    TraceOptions trace{};
    GatherOptions gather{}; //!< but for `direct`: E_0 is the problem's
    /// Points of a patch at which light is gathered, 1 to 4096; none: 4, and up to 256 where that is no more than 16384 in all.
    std::optional<std::uint32_t> points{};
};

/// Throws UsageError for options out of range.
void checkInstantRadiosity(const InstantRadiosityOptions& options);

/// The points of each of so many patches at which light is gathered.
std::uint32_t pointsPerPatch(const InstantRadiosityOptions& options, std::size_t patches);

/// What instant radiosity knows beyond the light on the patches. Its energy is the particles', see ParticleFlux: the imbalance
/// is what was lost where walks end, and noise.
struct InstantRadiosity : RadiositySolution {
    std::vector<std::uint32_t> particles; //!< S_k, see VirtualPointLights
    std::size_t lights = 0;               //!< left by all of them
    std::uint32_t points = 0;             //!< per patch
    RgbSum lost{0.0};                     //!< see ParticleFlux
    RgbSum cut{0.0};                      //!< flux to the patches that the bound took away; in part recovered
    RgbSum recovered{0.0};                //!< flux that recovery gave back
    std::uint64_t rays = 0;               //!< of all kinds
};

/// The points of patches at which light is gathered: `points` scrambled Sobol points on each, patch by patch.
std::vector<Receiver> patchReceivers(const PatchMesh& mesh, const RayCaster& rays, std::uint32_t points,
                                     std::uint64_t seed);

/// The light on patches by virtual point lights: E is E_0 of the problem plus the mean of what is gathered at points of the
/// patch, B = B_e + ρ E. Walks see the textures of `rays`' scene, whose mesh the problem's is.
/// The same whatever the number of threads. Throws UsageError as above, Cancelled.
InstantRadiosity solveInstantRadiosity(const SolverProblem& problem, const PatchMesh& mesh, const RayCaster& rays,
                                       const InstantRadiosityOptions& options, Progress& progress);

} // namespace lambert
