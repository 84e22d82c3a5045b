#include "solver/jacobi.h"

#include "solver/energy_balance.h"

#include <algorithm>

namespace lambert {

namespace {

constexpr int kMostIterations = 10'000;

} // namespace

RadiositySolution solveJacobi(const SolverProblem& problem, FormFactorRows& rows, const SolverOptions& options,
                              Progress& progress, const SolverContext& context) {
    const std::size_t count = problem.size();
    RadiositySolution solution;
    solution.radiosity = problem.startRadiosity(context.start);
    solution.irradiance.resize(count);
    std::vector<RgbSum> change(count);
    const int limit = options.bounces > 0 ? std::min(options.bounces, kMostIterations) : kMostIterations;
    const auto state = [&](auto& archive) {
        archive(solution.iterations);
        archive(solution.residual);
        archive(solution.radiosity);
        archive(solution.irradiance);
        archive(solution.bounces);
        archive(solution.history);
    };
    const auto unfinished = [&] {
        return solution.iterations == 0 || (solution.iterations < limit && solution.residual > options.tolerance);
    };
    context.restore(state);
    const SolverClock clock(solution.history);
    progress.begin("solve", 0);
    while (unfinished()) {
        gatherAll(rows, solution.radiosity, solution.irradiance, progress);
        for (std::size_t i = 0; i < count; ++i) {
            solution.irradiance[i] += problem.direct(i);
            const RgbSum next = problem.radiosity(i, solution.irradiance[i]);
            change[i] = next - solution.radiosity[i];
            solution.radiosity[i] = next;
        }
        if (options.keepBounces) solution.bounces.emplace_back(change.begin(), change.end());
        solution.residual = problem.relativeNorm(change);
        solution.history.push_back({++solution.iterations, solution.residual, clock.seconds()});
        context.offer(state);
        progress.advance();
    }
    progress.end();
    settle(problem, rows, solution, progress);
    return solution;
}

} // namespace lambert
