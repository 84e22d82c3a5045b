#include "solver/jacobi.h"

#include "core/stopwatch.h"
#include "solver/energy_balance.h"

#include <algorithm>

namespace lambert {

RadiositySolution solveJacobi(const SolverProblem& problem, FormFactorRows& rows, const JacobiOptions& options,
                              Progress& progress) {
    const Stopwatch watch;
    const std::size_t count = problem.size();
    RadiositySolution solution;
    solution.radiosity = problem.emitted();
    solution.irradiance.resize(count);
    std::vector<RgbSum> change(count);
    const int limit = options.bounces > 0 ? std::min(options.bounces, options.maxIterations) : options.maxIterations;
    progress.begin("solve", 0);
    for (int iteration = 1; iteration <= limit; ++iteration) {
        gatherAll(rows, solution.radiosity, solution.irradiance, progress);
        for (std::size_t i = 0; i < count; ++i) {
            solution.irradiance[i] += problem.direct(i);
            const RgbSum next = problem.radiosity(i, solution.irradiance[i]);
            change[i] = next - solution.radiosity[i];
            solution.radiosity[i] = next;
        }
        if (options.keepBounces) solution.bounces.emplace_back(change.begin(), change.end());
        solution.iterations = iteration;
        solution.residual = problem.relativeNorm(change);
        solution.history.push_back({iteration, solution.residual, watch.seconds()});
        progress.advance();
        if (solution.residual <= options.tolerance) break;
    }
    progress.end();
    settle(problem, rows, solution, progress);
    return solution;
}

} // namespace lambert
