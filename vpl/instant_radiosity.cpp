#include "vpl/instant_radiosity.h"

#include "core/error.h"
#include "core/parallel.h"
#include "core/random.h"
#include "core/sample_points.h"
#include "formfactors/patch_sampling.h"
#include "meshing/patch_offset.h"
#include "solver/patch_rays.h"

#include <fmt/format.h>

#include <algorithm>

namespace lambert {

namespace {

constexpr std::uint32_t kMostPoints = 4096;
constexpr std::uint32_t kFewPoints = 4, kManyPoints = 256;
constexpr std::size_t kReceiversWanted = 16384;
constexpr std::uint32_t kCoverRays = 64; ///< per patch; what is covered need be known to some percent

/// F_back of every patch.
std::vector<float> coveredShares(const PatchMesh& mesh, const RayCaster& rays, std::uint64_t seed) {
    constexpr std::size_t kPatchesPerBatch = 512;
    const PatchRays patchRays(mesh, rays, Sampler::Sobol);
    std::vector<PatchRays::Batch> batches(static_cast<std::size_t>(threadCount()));
    std::vector<float> covered(mesh.size(), 0.0F);
    parallelFor((mesh.size() + kPatchesPerBatch - 1) / kPatchesPerBatch, 1, [&](auto begin, auto end, int worker) {
        PatchRays::Batch& batch = batches[static_cast<std::size_t>(worker)];
        for (std::size_t b = begin; b < end; ++b) {
            const std::size_t first = b * kPatchesPerBatch;
            batch.runs.clear();
            for (std::size_t i = first; i < std::min(first + kPatchesPerBatch, mesh.size()); ++i)
                batch.runs.push_back({static_cast<std::uint32_t>(i), 0, kCoverRays});
            patchRays.trace(seed, batch);
            for (std::size_t ray = 0; ray < batch.target.size(); ++ray)
                if (batch.target[ray] == patchRays.back()) covered[first + batch.run[ray]] += 1.0F / kCoverRays;
        }
    });
    return covered;
}

/// Σ A times the mean over each patch's points.
RgbSum fluxOf(const std::vector<glm::dvec3>& atReceivers, const SolverProblem& problem, std::uint32_t points) {
    RgbSum flux(0.0);
    for (std::size_t k = 0; k < atReceivers.size(); ++k) flux += problem.area(k / points) / points * atReceivers[k];
    return flux;
}

EnergyBalance energyOf(const ParticleFlux& flux) {
    return {flux.emitted, flux.received, flux.absorbed + flux.belowHorizon, flux.backFaces, flux.escaped};
}

} // namespace

void checkInstantRadiosity(const InstantRadiosityOptions& options) {
    checkTrace(options.trace);
    checkGather(options.gather);
    if (options.points && (*options.points < 1 || *options.points > kMostPoints))
        throw UsageError(fmt::format("points at which light is gathered: found {}, allowed are 1 to {}",
                                     *options.points, kMostPoints));
}

std::uint32_t pointsPerPatch(const InstantRadiosityOptions& options, std::size_t patches) {
    if (options.points) return *options.points;
    const std::size_t wanted = kReceiversWanted / std::max<std::size_t>(patches, 1);
    return std::clamp(static_cast<std::uint32_t>(wanted), kFewPoints, kManyPoints);
}

std::vector<Receiver> patchReceivers(const PatchMesh& mesh, const RayCaster& rays, std::uint32_t points,
                                     std::uint64_t seed) {
    std::vector<Receiver> receivers(mesh.size() * points);
    parallelFor(mesh.size(), 256, [&](std::size_t begin, std::size_t end, int) {
        for (std::size_t patch = begin; patch < end; ++patch) {
            const SamplePoints samples(Sampler::Sobol, points, 2,
                                       randomKey({static_cast<std::uint32_t>(patch), 0, 0, 0x50504F49}, seed));
            const PatchPoints surface(mesh, patch);
            const float lift = patchOriginOffset(rays, mesh, patch);
            for (std::uint32_t k = 0; k < points; ++k)
                receivers[patch * points + k] = {surface.at({samples.at(k, 0), samples.at(k, 1)}), mesh.normal[patch],
                                                 lift};
        }
    });
    return receivers;
}

InstantRadiosity solveInstantRadiosity(const SolverProblem& problem, const PatchMesh& mesh, const RayCaster& rays,
                                       const InstantRadiosityOptions& options, Progress& progress) {
    checkInstantRadiosity(options);
    InstantRadiosity result;
    const VirtualPointLights traced = traceLights(rays, options.trace, progress);
    result.particles = traced.particles;
    result.lights = traced.lights.size();
    result.lost = traced.flux.lost;
    result.energy = energyOf(traced.flux);

    result.points = pointsPerPatch(options, mesh.size());
    GatherOptions gather = options.gather;
    gather.direct = false;
    const Gathered gathered = gatherIrradiance(
        rays, traced.lights, patchReceivers(mesh, rays, result.points, options.trace.seed), gather, progress);
    result.cut = fluxOf(gathered.cutAt, problem, result.points);
    result.recovered = fluxOf(gathered.recoveredAt, problem, result.points);
    for (std::size_t i = 0; i < mesh.size(); ++i) {
        RgbSum sum(0.0);
        for (std::size_t k = i * result.points; k < (i + 1) * result.points; ++k) sum += gathered.irradiance[k];
        result.irradiance.push_back(problem.direct(i) + sum / static_cast<double>(result.points));
        result.radiosity.push_back(problem.radiosity(i, result.irradiance.back()));
    }
    result.covered = coveredShares(mesh, rays, options.trace.seed);
    result.rays = traced.rays + gathered.shadowRays + gathered.recoveryRays + mesh.size() * kCoverRays;
    return result;
}

} // namespace lambert
