#include "lighting/solve_scene.h"

#include "core/stopwatch.h"
#include "lighting/dark_result.h"
#include "lighting/light_solves.h"
#include "lighting/stray_light.h"
#include "solver/emitter_light.h"

#include <fmt/format.h>

#include <numeric>
#include <utility>

namespace lambert {

namespace {

constexpr double kUndividedWarning = 1e-3; ///< of the area

CheckpointOptions solverCheckpoint(CheckpointOptions options, std::size_t solve) {
    options.path = solverCheckpointPath(options.path, solve);
    return options;
}

/// Throws for files of solves from `first` on that cannot be used, before hours of work.
void checkCheckpoints(const CheckpointOptions& options, std::size_t first, std::size_t solves) {
    if (options.path.empty()) return;
    for (std::size_t k = first; k < solves; ++k) SolverCheckpoint::check(solverCheckpoint(options, k));
}

/// Light of emitters is found apart from form factors; lines from the emitters miss nothing. By material where each light is
/// to be solved for alone.
LightOfMaterials lightOfEmitters(const SolveOptions& options, bool byMaterial, SolvedScene& result,
                                 Progress& progress) {
    LightOfMaterials light;
    if (!std::holds_alternative<FormFactorLight>(options.method)) return light;
    const EmitterLight emitters(*result.rays, result.mesh, result.optics, options.directLight.seed);
    if (emitters.empty()) return light;
    light.materials.assign(emitters.materials().begin(), emitters.materials().end());
    result.emittersIrradiance = emitters.irradiance(result.mesh, progress, byMaterial ? &light.irradiance : nullptr);
    return light;
}

void collectWarnings(const SolveOptions& options, std::size_t strayRays, SolvedScene& result) {
    const auto warn = [&](std::string text) { result.warnings.push_back(std::move(text)); };
    for (std::string& text : warningsOfDarkness(result, result.solution, strayRays)) warn(std::move(text));
    if (const auto text = warningOf(result.blackBacks)) warn(*text);
    for (std::string& text : energyWarnings(result, options.method)) warn(std::move(text));
    // Specks as small as the weld tolerance are no news; where they matter for the picture, they are.
    const double area = std::accumulate(result.mesh.area.begin(), result.mesh.area.end(), 0.0);
    if (result.meshReport.undividedArea > kUndividedWarning * area)
        warn(fmt::format(
            "{} polygons could not be divided cleanly and stay whole ({:.2g} % of the area), with one value "
            "of light each; slivers and outlines that nearly touch are the usual cause",
            result.meshReport.undividedPolygons, 100.0 * result.meshReport.undividedArea / area));
}

} // namespace

std::filesystem::path solverCheckpointPath(const std::filesystem::path& rows, std::size_t solve) {
    std::filesystem::path path = rows;
    if (path.empty()) return path;
    return path += solve == 0 ? std::string(".solver") : fmt::format(".solver.{}", solve);
}

SolverCheckpoint* nextCheckpoint(const LightTask& task, std::string identity) {
    auto& checkpoints = task.scene.solverCheckpoints;
    const CheckpointOptions options = solverCheckpoint(task.options.checkpoint, checkpoints.size());
    if (options.path.empty()) return nullptr;
    checkpoints.push_back(std::make_unique<SolverCheckpoint>(options, std::move(identity)));
    return checkpoints.back().get();
}

void removeCheckpoints(const SolvedScene& solved) {
    if (solved.matrixCheckpoint) solved.matrixCheckpoint->remove();
    for (const auto& checkpoint : solved.solverCheckpoints) checkpoint->remove();
}

SolvedScene solveScene(const Scene& scene, const SolveOptions& options, Progress& progress, const LightSink& sink) {
    Stopwatch watch;
    checkCheckpoints(options.checkpoint, 0, 1);
    SolvedScene result{meshLitScene(scene, options.mesh, progress)};
    if (sink)
        checkCheckpoints(options.checkpoint, 1, 1 + lightGroups(*result.scene, result.mesh, result.optics).size());
    result.seconds.mesh = watch.lap();

    DirectIrradiance direct =
        directIrradiance(result.mesh, *result.rays, options.directLight, lightsOf(*result.scene), progress);
    result.lightsIrradiance = std::move(direct.values);
    const bool dark = isDark(result.optics, result.lightsIrradiance);
    LightOfMaterials emitters;
    if (!dark) emitters = lightOfEmitters(options, bool(sink), result, progress);
    result.seconds.directLight = watch.lap();
    if (dark) {
        result.solution = darkness(result.mesh.size());
    } else {
        const SolverProblem problem({result.mesh, result.optics}, result.lightsIrradiance, result.emittersIrradiance);
        const LightTask task{options, problem, emitters, sink, result, progress};
        std::visit([&](const auto& method) { findLight(method, task); }, options.method);
        dropStrayLight(result, result.solution);
    }
    result.blackBacks = findBlackBacks(result.mesh, result.optics, *result.rays, result.solution);
    collectWarnings(options, direct.strayRays, result);
    return result;
}

} // namespace lambert
