#pragma once

#include "core/progress.h"
#include "meshing/patch_optics.h"
#include "scene/rays/ray_caster.h"
#include "solver/solution.h"
#include "vpl/receiver.h"

#include <cstdint>
#include <span>
#include <vector>

namespace lambert {

/// A scene's division into patches with the light that falls on them.
struct PatchLight {
    const PatchMesh* mesh = nullptr;
    const PatchOptics* optics = nullptr;
    std::span<const RgbSum> irradiance; //!< #patches, E per m²
};

struct PointGatherOptions {
    int cells = 128; //!< along an edge of the square that is mapped to the directions; their square are the rays; a
                     //!< multiple of 4
    std::uint32_t emitterRays = 1024; //!< see EmitterLight
    std::uint32_t skyRays = 4096;     //!< see DirectLightOptions
    std::uint64_t seed = 1;
};

/// The irradiance at points from patch radiosity, found at the points themselves instead of between patches:
///
///     E(x) = E_0(x) + E_emitters(x) + (1/n²) Σ_rays ρ(y) E_patch(y)
///
/// E_0 is that of lights without area and of the environment (see DirectLight), E_emitters see EmitterLight. Rays are
/// cosine-distributed, one in each of n² cells; they find what surfaces reflect.
///
/// All `lights` are divisions of the scene of `rays` and are looked up with the same rays: their answers differ by what the
/// patches hold and by nothing else. Emitters are those of the first. #lights × #receivers; the same whatever the number of
/// threads. Throws Cancelled.
std::vector<std::vector<RgbSum>> gatherAtPoints(const RayCaster& rays, std::span<const PatchLight> lights,
                                                std::span<const Receiver> receivers, const PointGatherOptions& options,
                                                Progress& progress);

} // namespace lambert
