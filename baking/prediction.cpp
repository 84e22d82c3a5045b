#include "baking/prediction.h"

#include "core/error.h"
#include "core/parallel.h"
#include "core/process.h"
#include "core/stopwatch.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace lambert {

namespace {

constexpr double kPilotSeconds = 0.4;

// Measured on two cores; all but the rows is a small part of a bake.
constexpr double kSecondsPerEntry = 3e-9; // of one iteration, one thread
constexpr double kSecondsPerPatch = 5e-6; // of reconstruction
constexpr double kSecondsPerRay = 2e-7;   // of pictures, one thread, where the rows need none
constexpr double kBytesPerPatch = 1000.0; // solution, reconstruction and the files' bytes
constexpr double kBytesPerRow = 32.0;     // the allocator's, and what rounding up costs

// Of instant radiosity.
constexpr std::uint32_t kPilotParticles = 1024;
constexpr std::size_t kPilotReceivers = 4096; ///< at a time: few would be far from each other
constexpr double kBytesPerReceiver = 150.0, kBytesPerLight = 250.0;

struct Pilot {
    std::size_t rows = 0;
    double seconds = 0.0;
    double entries = 0.0;   ///< mean per row
    double reflected = 0.0; ///< mean over the rows: what part of the light that leaves a patch leaves the next as well
};

double brightestChannel(const Rgb& rgb) { return static_cast<double>(std::max({rgb.x, rgb.y, rgb.z})); }

/// The k-th of indices below `count` that are spread evenly however many of them there are: multiples of the golden ratio, modulo 1.
std::size_t spreadIndex(std::size_t k, std::size_t count) {
    const double at = 0.6180339887498949 * static_cast<double>(k);
    return static_cast<std::size_t>((at - std::floor(at)) * static_cast<double>(count));
}

/// Rows of patches spread over the mesh, until they have taken long enough to be timed, or are all.
Pilot pilotRows(const MeshedScene& scene, const FormFactorMethod& method, Progress& progress) {
    const std::size_t count = method.patchCount();
    const auto batch = static_cast<std::size_t>(16 * threadCount());
    const auto patch = [count](std::size_t k) { return spreadIndex(k, count); };
    std::vector<RowAccumulator> accumulators(static_cast<std::size_t>(threadCount()), RowAccumulator(count));
    std::vector<FormFactorRow> rows(batch);
    Pilot pilot;
    const Stopwatch watch;
    do {
        parallelFor(batch, 1, [&](std::size_t begin, std::size_t end, int worker) {
            RowAccumulator& accumulator = accumulators[static_cast<std::size_t>(worker)];
            for (std::size_t k = begin; k < end; ++k) {
                method.row(static_cast<std::uint32_t>(patch(pilot.rows + k)), accumulator);
                accumulator.take(rows[k]);
            }
        });
        for (std::size_t k = 0; k < batch; ++k) {
            pilot.entries += static_cast<double>(rows[k].entries.size());
            pilot.reflected +=
                (1.0 - rows[k].back - rows[k].out) * brightestChannel(scene.mesh.reflectance[patch(pilot.rows + k)]);
        }
        pilot.rows += batch;
        pilot.seconds = watch.seconds();
        progress.throwIfCancelled();
    } while (pilot.seconds < kPilotSeconds && pilot.rows < count);
    pilot.entries /= static_cast<double>(pilot.rows);
    pilot.reflected /= static_cast<double>(pilot.rows);
    return pilot;
}

/// How often a solver passes over the matrix. Jacobi's residual falls about by what is reflected from one bounce to the next.
double predictPasses(double reflected, const SolverOptions& options) {
    if (!(options.tolerance > 0.0)) return options.bounces;
    const double share = std::clamp(reflected, 0.01, 0.999);
    const double jacobi = std::max(1.0, std::log(options.tolerance) / std::log(share) + 1.0);
    switch (options.method) {
    case SolverMethod::Jacobi:
        return options.bounces > 0 ? std::min<double>(jacobi, options.bounces) : jacobi;
    case SolverMethod::GaussSeidel:
    case SolverMethod::Southwell:
        return jacobi / 2.0 + 1.0;
    case SolverMethod::ConjugateGradient:
        // As the theory has it but for the factor, which is measured.
        return 3.0 + 0.3 * std::log(2.0 / options.tolerance) / std::sqrt(1.0 - share);
    case SolverMethod::Stochastic:
    case SolverMethod::RandomWalk:
        break;
    }
    return jacobi;
}

/// Of the light without area, about.
double directRays(const MeshedScene& meshed, const DirectLightOptions& options) {
    return static_cast<double>(meshed.mesh.size()) *
           (static_cast<double>(meshed.scene->lights.size()) * options.points +
            (meshed.scene->environment ? static_cast<double>(options.skyRays) : 0.0));
}

void predictInstantRadiosity(const MeshedScene& meshed, const BakeOptions& bake, BakePrediction& result,
                             Progress& progress) {
    InstantRadiosityOptions options = bake.instantRadiosity.value();
    const std::uint32_t points = pointsPerPatch(options, meshed.mesh.size());
    const double wanted = options.trace.particles;
    options.trace.particles = std::min(options.trace.particles, kPilotParticles);
    options.gather.direct = false;
    Stopwatch watch;
    const VirtualPointLights some = traceLights(*meshed.rays, options.trace, progress);
    const double more = wanted / options.trace.particles;
    const double traceSeconds = more * watch.lap();

    const std::vector<Receiver> all = patchReceivers(meshed.mesh, *meshed.rays, points, options.trace.seed);
    std::size_t done = 0;
    double rays = 0.0;
    const Stopwatch gathering;
    do {
        std::vector<Receiver> receivers;
        for (std::size_t k = done; k < std::min(done + kPilotReceivers, all.size()); ++k)
            receivers.push_back(all[spreadIndex(k, all.size())]);
        const Gathered gathered = gatherIrradiance(*meshed.rays, some.lights, receivers, options.gather, progress);
        rays += static_cast<double>(gathered.shadowRays + gathered.recoveryRays);
        done += receivers.size();
    } while (gathering.seconds() < kPilotSeconds && done < all.size());
    const double scale = more * static_cast<double>(all.size()) / static_cast<double>(done);

    result.rays = static_cast<std::uint64_t>(more * static_cast<double>(some.rays) + scale * rays);
    result.secondsPerRay = rays > 0.0 ? gathering.seconds() / rays : kSecondsPerRay / threadCount();
    result.seconds.solve = traceSeconds + scale * gathering.seconds();
    result.seconds.directLight = result.secondsPerRay * directRays(meshed, bake.directLight);
    result.seconds.bake = kSecondsPerPatch * static_cast<double>(meshed.mesh.size());
    result.peakMemory =
        peakMemoryBytes() + static_cast<std::uint64_t>(kBytesPerPatch * static_cast<double>(meshed.mesh.size()) +
                                                       kBytesPerReceiver * static_cast<double>(all.size()) +
                                                       kBytesPerLight * more * static_cast<double>(some.lights.size()));
}

} // namespace

BakePrediction predictBake(const Scene& scene, const BakeOptions& options, Progress& progress) {
    Stopwatch watch;
    const MeshedScene meshed = meshLitScene(scene, options.mesh, progress);
    BakePrediction result;
    result.seconds.mesh = watch.lap();
    result.patches = meshed.mesh.size();
    if (options.instantRadiosity) {
        predictInstantRadiosity(meshed, options, result, progress);
        return result;
    }
    if (!options.formFactors.file.empty())
        throw UsageError("--dry-run: predicts nothing of a bake from a matrix file (--form-factors)");
    if (usesLines(options.solver.method))
        throw UsageError(fmt::format("--dry-run: predicts nothing of the solver {}", nameOf(options.solver.method)));
    const TransportPlan plan = planTransport(options.formFactors.transport, meshed.mesh, *meshed.rays, progress);
    result.plan = plan;
    if (!hasRows(plan.options.method))
        throw UsageError(fmt::format("--dry-run: predicts nothing of {}", nameOf(plan.options.method)));
    if (!options.formFactors.transport.stored)
        throw UsageError(
            "--dry-run: predicts nothing of --storage none, whose rows are computed as the light needs them");
    const auto method = makeMethod(plan, meshed.mesh, *meshed.rays);
    const Pilot pilot = pilotRows(meshed, *method, progress);

    const auto patches = static_cast<double>(meshed.mesh.size());
    const double secondsPerRow = pilot.seconds / static_cast<double>(pilot.rows);
    const double entries = patches * pilot.entries;
    result.rays = plan.rays;
    const auto raysPerRow = static_cast<double>(method->raysPerRow());
    result.secondsPerRay = raysPerRow > 0.0 ? secondsPerRow / raysPerRow : kSecondsPerRay / threadCount();
    result.seconds.formFactors = secondsPerRow * patches;
    result.seconds.directLight = result.secondsPerRay * directRays(meshed, options.directLight);
    result.seconds.solve = predictPasses(pilot.reflected, options.solver) * entries * kSecondsPerEntry / threadCount();
    result.seconds.bake = kSecondsPerPatch * patches;
    result.matrixBytes =
        static_cast<std::uint64_t>(entries * bytesPerFactor(*plan.options.storage) +
                                   patches * (static_cast<double>(sizeof(FormFactorRow)) + kBytesPerRow));
    result.peakMemory = peakMemoryBytes() + result.matrixBytes + static_cast<std::uint64_t>(kBytesPerPatch * patches);
    return result;
}

} // namespace lambert
