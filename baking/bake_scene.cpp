#include "baking/bake_scene.h"

#include "baking/dark_result.h"
#include "baking/solution_file.h"
#include "baking/stray_light.h"
#include "core/checksum.h"
#include "core/error.h"
#include "core/stopwatch.h"
#include "formfactors/matrix_quality.h"
#include "solver/computed_rows.h"
#include "solver/emitter_light.h"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>

namespace lambert {

namespace {

constexpr double kUndividedWarning = 1e-3; ///< of the area

/// What is solved, and from where.
struct Task {
    const SolverProblem& problem;
    std::span<const RgbSum> start; ///< see SolverContext
    const LightOfMaterials& emitters;
};

void bakeLights(const BakeOptions& options, const LightOfMaterials& emitters, const LightSolver& solver,
                BakedScene& result, Progress& progress) {
    if (options.perLight)
        result.lights = bakePerLight(result, solver, {options.directLight, options.reconstruction, emitters}, progress);
}

/// Light of emitters is found apart from form factors; lines from the emitters miss nothing. By material where each light is to be baked alone.
LightOfMaterials lightOfEmitters(const BakeOptions& options, BakedScene& result, Progress& progress) {
    LightOfMaterials light;
    if (options.instantRadiosity || usesLines(options.solver.method)) return light;
    const EmitterLight emitters(*result.rays, result.mesh, options.directLight.seed);
    if (emitters.empty()) return light;
    light.materials.assign(emitters.materials().begin(), emitters.materials().end());
    result.emittersIrradiance =
        emitters.irradiance(result.mesh, progress, options.perLight ? &light.irradiance : nullptr);
    return light;
}

CheckpointOptions solverCheckpoint(const BakeOptions& options, std::size_t solve) {
    CheckpointOptions result = options.formFactors.checkpoint;
    result.path = solverCheckpointPath(result, solve);
    return result;
}

/// Throws for files of solves from `first` on that cannot be used, before hours of work.
void checkCheckpoints(const BakeOptions& options, std::size_t first, std::size_t solves) {
    if (options.formFactors.checkpoint.path.empty()) return;
    for (std::size_t k = first; k < solves; ++k) SolverCheckpoint::check(solverCheckpoint(options, k));
}

/// The checkpoint of the next solve; null if there are to be none.
SolverCheckpoint* nextCheckpoint(const BakeOptions& options, std::string identity, BakedScene& result) {
    const CheckpointOptions checkpoint = solverCheckpoint(options, result.checkpoints.size());
    if (checkpoint.path.empty()) return nullptr;
    result.checkpoints.push_back(std::make_unique<SolverCheckpoint>(checkpoint, std::move(identity)));
    return result.checkpoints.back().get();
}

/// The whole and, if wanted, each group of lights. `formFactors` names what the rows depend on, in one line.
void solveFor(const BakeOptions& options, const Task& task, FormFactorRows& rows, const std::string& formFactors,
              BakedScene& result, Progress& progress) {
    const auto run = [&](const Task& t, const SolverOptions& solver) {
        SolverContext context{t.start};
        context.checkpoint = nextCheckpoint(
            options, fmt::format("{}; {}", formFactors, solverIdentity(t.problem, solver, context)), result);
        return solve(t.problem, rows, solver, progress, context);
    };
    result.solution = run(task, options.solver);
    SolverOptions solver = options.solver;
    solver.keepBounces = false;
    bakeLights(
        options, task.emitters,
        [&](const SolverProblem& light) {
            return run({light, {}, task.emitters}, solver);
        },
        result, progress);
}

/// Without form factors.
void solveWithLines(const BakeOptions& options, const Task& task, BakedScene& result, Progress& progress) {
    Stopwatch watch;
    const bool kept = !options.formFactors.checkpoint.path.empty();
    const std::string identity = fmt::format("lambert {}, scene {:016x}", options.formFactors.version,
                                             kept ? sceneChecksum(result.mesh, *result.scene) : 0);
    const auto run = [&](const SolverProblem& light) {
        SolverContext context;
        context.checkpoint = nextCheckpoint(
            options, fmt::format("{}; {}", identity, lineSolverIdentity(light, options.lineSolver)), result);
        StochasticSolution solution = solveByLines(light, *result.rays, options.lineSolver, progress, context);
        result.rayCount += solution.rays;
        return solution;
    };
    result.stochastic = run(task.problem);
    result.solution = std::move(static_cast<RadiositySolution&>(*result.stochastic));
    bakeLights(options, task.emitters, run, result, progress);
    result.seconds.solve = watch.lap();
}

/// Without form factors or solver.
void solveWithVirtualLights(const BakeOptions& options, const Task& task, BakedScene& result, Progress& progress) {
    Stopwatch watch;
    result.instantRadiosity =
        solveInstantRadiosity(task.problem, *result.rays, options.instantRadiosity.value(), progress);
    result.solution = std::move(static_cast<RadiositySolution&>(*result.instantRadiosity));
    result.rayCount = result.instantRadiosity->rays;
    result.seconds.solve = watch.lap();
}

std::string checksumOf(const FormFactorMatrix& matrix) {
    Checksum sum;
    std::vector<std::byte> row;
    for (std::size_t patch = 0; patch < matrix.size(); ++patch) {
        row.clear();
        matrix.appendBytes(patch, row);
        sum.add(row);
    }
    return fmt::format("{:016x}", sum.value());
}

/// The matrix first, then the light.
void solveStored(const BakeOptions& options, const Task& task, BakedScene& result, Progress& progress) {
    Stopwatch watch;
    SceneMatrix obtained = obtainMatrix(options.formFactors, result.mesh, *result.rays, progress);
    const FormFactorMatrix& matrix = obtained.matrix;
    result.plan = std::move(obtained.plan);
    result.repair = std::move(obtained.repair);
    result.matrixCheckpoint = std::move(obtained.checkpoint);
    result.rayCount = result.plan ? result.plan->rays : 0;
    StoredRows rows(matrix);
    for (std::size_t i = 0; i < matrix.size(); ++i) {
        result.rows.largestClosureError =
            std::max(result.rows.largestClosureError, std::abs(matrix.row(i).sum() - 1.0));
        const auto error = static_cast<double>(matrix.error(i));
        result.rows.meanError += error / static_cast<double>(matrix.size());
        result.rows.largestError = std::max(result.rows.largestError, error);
    }
    result.rows.entries = matrix.entryCount();
    result.rows.bytes = matrix.bytes();
    const std::vector<double> deficit =
        result.repair ? std::move(obtained.deficit) : columnDeficit(matrix, result.mesh.area);
    result.seconds.formFactors = watch.lap();
    const bool kept = !options.formFactors.checkpoint.path.empty();
    const std::string identity = fmt::format("lambert {}, form factors {}", options.formFactors.version,
                                             kept ? checksumOf(matrix) : std::string());
    solveFor(options, task, rows, identity, result, progress);
    result.energyCheck = checkEnergy(result, options, deficit, lossOfEmitters(result, matrix));
    result.seconds.solve = watch.lap();
}

/// Rows are computed as the solver asks for them.
void solveComputed(const BakeOptions& options, const Task& task, BakedScene& result, Progress& progress) {
    Stopwatch watch;
    result.plan = planTransport(options.formFactors.transport, result.mesh, *result.rays, progress);
    const auto method = makeMethod(*result.plan, result.mesh, *result.rays);
    ComputedRows rows(*method);
    const std::string identity = matrixIdentity(*result.plan, result.mesh, *result.scene, options.formFactors.version);
    solveFor(options, task, rows, identity, result, progress);
    result.rayCount = rows.rowsComputed() * method->raysPerRow();
    result.rows.largestClosureError = rows.largestClosureError();
    result.seconds.solve = watch.lap();
}

/// Of a scene that has light.
void solveLit(const BakeOptions& options, const LightOfMaterials& emitters, BakedScene& result, Progress& progress) {
    const SolverProblem problem(result.mesh, result.lightsIrradiance, result.emittersIrradiance);
    std::vector<RgbSum> start;
    if (!options.warmStart.empty()) start = readStart(options.warmStart, result.mesh, result.scene->origin);
    const auto solveBy = options.instantRadiosity               ? solveWithVirtualLights
                         : usesLines(options.solver.method)     ? solveWithLines
                         : options.formFactors.transport.stored ? solveStored
                                                                : solveComputed;
    solveBy(options, {problem, start, emitters}, result, progress);
    if (!result.energyCheck.beforeRepair) result.energyCheck = checkEnergy(result, options, {});
    dropStrayLight(result, result.solution);
}

void collectWarnings(const BakeOptions& options, std::size_t strayRays, BakedScene& result) {
    const auto warn = [&](std::string text) { result.warnings.push_back(std::move(text)); };
    for (std::string& text : warningsOfDarkness(result, result.solution, strayRays)) warn(std::move(text));
    if (const auto text = warningOf(result.blackBacks)) warn(*text);
    for (std::string& text : energyWarnings(result, options)) warn(std::move(text));
    // Specks as small as the weld tolerance are no news; where they matter for the picture, they are.
    const double area = std::accumulate(result.mesh.area.begin(), result.mesh.area.end(), 0.0);
    if (result.meshReport.undividedArea > kUndividedWarning * area)
        warn(fmt::format(
            "{} polygons could not be divided cleanly and stay whole ({:.2g} % of the area), with one value "
            "of light each; slivers and outlines that nearly touch are the usual cause",
            result.meshReport.undividedPolygons, 100.0 * result.meshReport.undividedArea / area));
}

} // namespace

std::filesystem::path solverCheckpointPath(const CheckpointOptions& rows, std::size_t solve) {
    std::filesystem::path path = rows.path;
    if (path.empty()) return path;
    return path += solve == 0 ? std::string(".solver") : fmt::format(".solver.{}", solve);
}

void removeCheckpoints(const BakedScene& baked) {
    if (baked.matrixCheckpoint) baked.matrixCheckpoint->remove();
    for (const auto& checkpoint : baked.checkpoints) checkpoint->remove();
}

BakedScene bakeScene(const Scene& scene, const BakeOptions& options, Progress& progress) {
    Stopwatch watch;
    checkCheckpoints(options, 0, 1);
    BakedScene result{meshLitScene(scene, options.mesh, progress)};
    if (options.perLight) checkCheckpoints(options, 1, 1 + lightGroups(*result.scene, result.mesh).size());
    result.seconds.mesh = watch.lap();

    DirectIrradiance direct =
        directIrradiance(result.mesh, *result.rays, options.directLight, lightsOf(*result.scene), progress);
    const bool dark = isDark(result.mesh, direct.values);
    result.lightsIrradiance = std::move(direct.values);
    LightOfMaterials emitters;
    if (!dark) emitters = lightOfEmitters(options, result, progress);
    result.seconds.directLight = watch.lap();
    if (dark)
        result.solution = darkness(result.mesh.size());
    else
        solveLit(options, emitters, result, progress);
    result.blackBacks = findBlackBacks(result.mesh, *result.rays, result.solution);
    watch.lap();

    progress.begin("bake", 0);
    result.baked =
        reconstructAverage(result.mesh, *result.scene, result.solution, options.reconstruction, &result.separatedFaces);
    progress.end();
    result.seconds.bake = watch.lap();
    collectWarnings(options, direct.strayRays, result);
    return result;
}

} // namespace lambert
