#include "solver/stochastic_relaxation.h"

#include "core/error.h"
#include "solver/relaxation_run.h"
#include "solver/sub_run_statistics.h"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>

namespace lambert {

namespace {

void check(const StochasticRelaxationOptions& o) {
    const auto require = [](bool holds, std::string_view what, auto found) {
        if (!holds) throw UsageError(fmt::format("{}: found {}", what, found));
    };
    require(o.rays > 0, "rays: allowed are 1 and more", o.rays);
    require(o.lines == RelaxationLines::Local || o.rays < (std::uint64_t{1} << 32),
            "rays: allowed with global lines are fewer than 2^32", o.rays);
    require(o.targetError >= 0.0, "target error: allowed are 0 and more", o.targetError);
    require(o.subRuns >= 3, "sub-runs: allowed are 3 and more", o.subRuns);
    require(o.shootingShare > 0.0 && o.shootingShare <= 1.0, "share of shooting: allowed are above 0 to 1",
            o.shootingShare);
    require(o.gatheringShare >= 0.0 && o.gatheringShare <= 1.0, "share of gathering: allowed are 0 to 1",
            o.gatheringShare);
    require(o.regularIterations >= 1, "regular iterations: allowed are 1 and more", o.regularIterations);
    require(o.unshot >= 0.0 && o.unshot <= 1.0, "unshot power: allowed are 0 to 1", o.unshot);
}

} // namespace

StochasticSolution solveStochasticRelaxation(const SolverProblem& problem, const PatchMesh& mesh, const RayCaster& rays,
                                             const StochasticRelaxationOptions& options, Progress& progress,
                                             const SolverContext& context) {
    check(options);
    const std::size_t count = problem.size();
    const SubRunSchedule schedule(options.rays, options.targetError, options.subRuns, count);
    SubRunStatistics statistics(problem);
    StochasticSolution solution;
    {
        RelaxationRun run(problem, mesh, rays, options);
        const auto state = [&](auto& archive) {
            statistics.keep(archive);
            archive(solution.unshot);
            archive(solution.history);
            run.keep(archive);
        };
        context.restore(state);
        const SolverClock clock(solution.history);
        progress.begin("stochastic relaxation", options.rays - std::min(options.rays, statistics.rays()));
        while (const std::uint64_t budget = schedule.next(statistics)) {
            run.run(budget, subRunSeed(options.seed, statistics.runs()), progress, [&] { context.offer(state); });
            statistics.add(run.irradiance(), run.losses(), run.rays());
            solution.unshot += run.unshot();
            if (statistics.runs() > 1)
                solution.history.push_back({statistics.runs(), statistics.relativeError(), clock.seconds()});
        }
        progress.end();
        solution.covered.reserve(count);
        for (std::size_t i = 0; i < count; ++i) solution.covered.push_back(run.counts().backShare(i));
    }
    solution.unshot /= statistics.runs();
    statistics.finish(solution);
    solution.targetReached = options.targetError == 0.0 || solution.upperRelativeError <= options.targetError;
    return solution;
}

} // namespace lambert
