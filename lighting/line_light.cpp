// Light without form factors.
#include "core/stopwatch.h"
#include "lighting/light_solves.h"

#include <fmt/format.h>

#include <utility>

namespace lambert {

void findLight(const LineSolverOptions& method, const LightTask& task) {
    SolvedScene& scene = task.scene;
    Stopwatch watch;
    const CheckpointOptions& checkpoint = task.options.checkpoint;
    const std::string identity = fmt::format("lambert {}, scene {:016x}", checkpoint.version,
                                             checkpoint.path.empty() ? 0 : sceneChecksum(scene.mesh, *scene.scene));
    const auto run = [&](const SolverProblem& problem) {
        SolverContext context;
        context.checkpoint = nextCheckpoint(task, fmt::format("{}; {}", identity, lineSolverIdentity(problem, method)));
        StochasticSolution solution = solveByLines(problem, scene.mesh, *scene.rays, method, task.progress, context);
        scene.rayCount += solution.rays;
        return solution;
    };
    auto& solution = scene.account.emplace<StochasticSolution>(run(task.problem));
    scene.solution = std::move(static_cast<RadiositySolution&>(solution));
    scene.energyCheck = checkEnergy(scene);
    solveLights(task, run);
    scene.seconds.solve = watch.lap();
}

void findLight(const InstantRadiosityOptions& method, const LightTask& task) {
    SolvedScene& scene = task.scene;
    Stopwatch watch;
    auto& solution = scene.account.emplace<InstantRadiosity>(
        solveInstantRadiosity(task.problem, scene.mesh, *scene.rays, method, task.progress));
    scene.solution = std::move(static_cast<RadiositySolution&>(solution));
    scene.rayCount = solution.rays;
    scene.energyCheck = checkEnergy(scene);
    scene.seconds.solve = watch.lap();
}

} // namespace lambert
