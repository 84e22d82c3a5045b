#include "baking/prediction.h"

#include "baking/prediction_pilots.h"
#include "core/error.h"
#include "core/process.h"
#include "core/stopwatch.h"

namespace lambert {

namespace {

// Measured on two cores; all but the pilots is a small part of a bake.
constexpr double kSecondsPerPatch = 5e-6; // of reconstruction
constexpr double kBytesPerPatch = 1000.0; // solution, reconstruction and the files' bytes

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
    result.peakMemory = peakMemoryBytes() + result.matrixBytes + result.lightBytes +
                        static_cast<std::uint64_t>(kBytesPerPatch * patches);
    return result;
}

} // namespace lambert
