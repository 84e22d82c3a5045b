#include "baking/prediction.h"

#include "baking/prediction_pilots.h"
#include "core/error.h"
#include "core/process.h"
#include "core/stopwatch.h"

#include <algorithm>

namespace lambert {

namespace {

// Measured on two cores; all but the pilots is a small part of a bake.
constexpr double kSecondsPerPatch = 5e-6; // of reconstruction
// Per patch, beside the mesh: solution and iterates, and thereafter solution and reconstruction.
constexpr double kSolveBytes = 300.0, kLineSolveBytes = 140.0, kBakeBytes = 180.0;

double directRaysPerPatch(const Scene& scene, const DirectLightOptions& options) {
    return static_cast<double>(scene.lights.size()) * options.points +
           (scene.environment ? static_cast<double>(options.skyRays) : 0.0);
}

} // namespace

BakePrediction predictBake(const Scene& scene, const BakeOptions& options, Progress& progress) {
    Stopwatch watch;
    const MeshedScene meshed = meshLitScene(scene, options.mesh, progress);
    BakePrediction result;
    result.seconds.mesh = watch.lap();
    result.patches = meshed.mesh.size();
    const std::uint64_t meshMemory = residentMemoryBytes();
    if (!options.formFactors.file.empty())
        throw UsageError("--dry-run: predicts nothing of a bake from a matrix file (--form-factors)");
    if (options.instantRadiosity)
        pilotInstantRadiosity(meshed, options, result, progress);
    else if (usesLines(options.solver.method))
        pilotLines(meshed, options, result, progress);
    else
        pilotFormFactors(meshed, options, result, progress);
    const auto patches = static_cast<double>(result.patches);
    result.seconds.directLight =
        result.secondsPerRay * patches * directRaysPerPatch(*meshed.scene, options.directLight);
    result.seconds.bake = kSecondsPerPatch * patches;
    const double iterates = usesLines(options.solver.method) ? kLineSolveBytes : kSolveBytes;
    const std::uint64_t solveMemory =
        result.matrixBytes + result.lightBytes + static_cast<std::uint64_t>(iterates * patches);
    const std::uint64_t bakeMemory = result.lightBytes + static_cast<std::uint64_t>(kBakeBytes * patches);
    result.peakMemory = std::max(peakMemoryBytes(), meshMemory + std::max(solveMemory, bakeMemory));
    return result;
}

} // namespace lambert
