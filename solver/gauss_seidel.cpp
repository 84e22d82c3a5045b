#include "solver/gauss_seidel.h"

#include "core/parallel.h"
#include "solver/energy_balance.h"
#include "solver/residual.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <array>

namespace lambert {

namespace {

/// Patches whose rows are gathered in parallel: what they take from outside their block does not change meanwhile, and what
/// they take from inside it follows in order. So the result is that of one patch after the other, on any number of threads.
constexpr std::size_t kBlock = 128;
constexpr int kMostSweeps = 10'000;

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

RadiositySolution solveGaussSeidel(const SolverProblem& problem, FormFactorRows& rows, const SolverOptions& options,
                                   Progress& progress, const SolverContext& context) {
    const std::size_t count = problem.size();
    RadiositySolution solution;
    solution.radiosity = problem.startRadiosity(context.start);
    solution.irradiance.resize(count);
    const double relaxation = options.relaxation.value_or(1.0);
    double previous = 0.0;
    const auto state = [&](auto& archive) {
        archive(solution.iterations);
        archive(solution.residual);
        archive(previous);
        archive(solution.radiosity);
        archive(solution.irradiance);
        archive(solution.history);
    };
    context.restore(state);
    const SolverClock clock(solution.history);
    const auto unfinished = [&] {
        return solution.iterations == 0 || (solution.iterations < kMostSweeps && solution.residual > options.tolerance);
    };
    progress.begin("solve", 0);
    while (unfinished()) {
        const double change =
            problem.relativeNorm(gaussSeidelSweep(problem, rows, relaxation, solution.radiosity, progress));
        ++solution.iterations;
        // The residual is about the next sweep's change. To measure it takes as long as a sweep.
        solution.residual = solution.iterations > 1 && change < previous ? change * change / previous : change;
        previous = change;
        // The last one is always measured.
        if (!unfinished()) solution.residual = gatherResidual(problem, rows, solution, progress);
        solution.history.push_back({solution.iterations, solution.residual, clock.seconds()});
        context.offer(state);
        progress.advance();
    }
    progress.end();
    // One more bounce, which was gathered for the residual.
    for (std::size_t i = 0; i < count; ++i) solution.radiosity[i] = problem.radiosity(i, solution.irradiance[i]);
    settle(problem, rows, solution, progress);
    return solution;
}

} // namespace lambert
