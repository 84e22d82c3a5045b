#include "prediction/prediction.h"

#include "core/process.h"
#include "core/stopwatch.h"
#include "prediction/measured_costs.h"
#include "prediction/pilots.h"

#include <algorithm>

namespace lambert {

namespace {

double directRaysPerPatch(const Scene& scene, const DirectLightOptions& options) {
    return static_cast<double>(scene.lights.size()) * options.points +
           (scene.environment ? static_cast<double>(options.skyRays) : 0.0);
}

} // namespace

BakePrediction predictBake(const Scene& scene, const SolveOptions& options, Progress& progress) {
    Stopwatch watch;
    const MeshedScene meshed = meshLitScene(scene, options.mesh, progress);
    BakePrediction result;
    result.seconds.mesh = watch.lap();
    result.patches = meshed.mesh.size();
    const std::uint64_t meshMemory = residentMemoryBytes();
    const auto* const lines = std::get_if<LineSolverOptions>(&options.method);
    if (lines != nullptr)
        pilot(meshed, *lines, options.directLight, result, progress);
    else if (const auto* const factors = std::get_if<FormFactorLight>(&options.method))
        pilot(meshed, *factors, result, progress);
    else
        pilot(meshed, std::get<InstantRadiosityOptions>(options.method), result, progress);
    const auto patches = static_cast<double>(result.patches);
    result.seconds.directLight =
        result.secondsPerRay * patches * directRaysPerPatch(*meshed.scene, options.directLight);
    result.bakeSeconds = kReconstructionSeconds * patches;
    const double iterates = lines != nullptr ? kLineSolveBytes : kSolveBytes;
    const std::uint64_t solveMemory =
        result.matrixBytes + result.lightBytes + static_cast<std::uint64_t>(iterates * patches);
    const std::uint64_t bakeMemory = result.lightBytes + static_cast<std::uint64_t>(kBakeBytes * patches);
    result.peakMemory = std::max(peakMemoryBytes(), meshMemory + std::max(solveMemory, bakeMemory));
    return result;
}

} // namespace lambert
