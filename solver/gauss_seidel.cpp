#include "solver/gauss_seidel.h"

#include "core/parallel.h"
#include "core/stopwatch.h"
#include "solver/energy_balance.h"
#include "solver/residual.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>

namespace lambert {

namespace {

/// Patches whose rows are gathered in parallel: what they take from outside their block does not change meanwhile, and what
/// they take from inside it follows in order. So the result is that of one patch after the other, on any number of threads.
constexpr std::size_t kBlock = 128;

struct Gathered {
    RgbSum outside{0.0};
    std::vector<FormFactor> inside;
};

} // namespace

double gaussSeidelSweep(const SolverProblem& problem, FormFactorRows& rows, double relaxation,
                        std::vector<RgbSum>& radiosity, const Progress& progress) {
    double squares = 0.0;
    std::array<Gathered, kBlock> gathered;
    for (std::size_t first = 0; first < problem.size(); first += kBlock) {
        const std::size_t last = std::min(first + kBlock, problem.size());
        const PatchRange block{static_cast<std::uint32_t>(first), static_cast<std::uint32_t>(last)};
        progress.throwIfCancelled();
        parallelFor(last - first, 8, [&](std::size_t begin, std::size_t end, int) {
            for (std::size_t k = begin; k < end; ++k)
                gathered[k].outside =
                    rows.gather(static_cast<std::uint32_t>(first + k), radiosity, block, gathered[k].inside);
        });
        for (std::size_t i = first; i < last; ++i) {
            const Gathered& row = gathered[i - first];
            RgbSum irradiance = problem.direct(i) + row.outside;
            for (const FormFactor& factor : row.inside) irradiance += factor.value * radiosity[factor.patch];
            const RgbSum change = relaxation * (problem.radiosity(i, irradiance) - radiosity[i]);
            radiosity[i] += change;
            squares += problem.area(i) * glm::dot(change, change);
        }
    }
    return squares;
}

RadiositySolution solveGaussSeidel(const SolverProblem& problem, FormFactorRows& rows,
                                   const GaussSeidelOptions& options, Progress& progress) {
    const Stopwatch watch;
    const std::size_t count = problem.size();
    RadiositySolution solution;
    solution.radiosity = problem.emitted();
    solution.irradiance.resize(count);
    double previous = 0.0;
    progress.begin("solve", 0);
    for (int sweep = 1; sweep <= options.maxIterations; ++sweep) {
        const double change =
            problem.relativeNorm(gaussSeidelSweep(problem, rows, options.relaxation, solution.radiosity, progress));
        // The residual is about the next sweep's change. To measure it takes as long as a sweep.
        solution.residual = sweep > 1 && change < previous ? change * change / previous : change;
        previous = change;
        const bool last = sweep == options.maxIterations;
        const bool measure = solution.residual <= options.tolerance || last;
        if (measure) solution.residual = gatherResidual(problem, rows, solution, progress);
        solution.iterations = sweep;
        solution.history.push_back({sweep, solution.residual, watch.seconds()});
        progress.advance();
        if (measure && solution.residual <= options.tolerance) break;
    }
    progress.end();
    // One more bounce, which was gathered for the residual.
    for (std::size_t i = 0; i < count; ++i) solution.radiosity[i] = problem.radiosity(i, solution.irradiance[i]);
    settle(problem, rows, solution, progress);
    return solution;
}

} // namespace lambert
