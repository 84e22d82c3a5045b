#include "solver/line_solvers.h"

#include "core/error.h"
#include "solver/random_walks.h"

#include <fmt/format.h>

namespace lambert {

namespace {

std::uint64_t mostRays(const LineSolverOptions& o) { return o.rays.value_or(LineSolverOptions::kMostRays); }

/// 0: the rays decide.
double target(const LineSolverOptions& o) { return o.targetError.value_or(o.rays ? 0.0 : o.kTargetError); }

StochasticSolution relax(const SolverProblem& problem, const RayCaster& rays, const LineSolverOptions& o,
                         Progress& progress, const SolverContext& context) {
    StochasticRelaxationOptions options;
    options.rays = mostRays(o);
    options.targetError = target(o);
    options.lines = o.lines;
    options.lineSet = o.lineSet;
    options.sampler = o.sampler;
    options.seed = o.seed;
    return solveStochasticRelaxation(problem, rays, options, progress, context);
}

StochasticSolution walk(const SolverProblem& problem, const RayCaster& rays, const LineSolverOptions& o,
                        Progress& progress, const SolverContext& context) {
    RandomWalkOptions options;
    options.walks = mostRays(o);
    options.targetError = target(o);
    options.sampler = o.sampler;
    options.seed = o.seed;
    return solveRandomWalks(problem, rays, options, progress, context);
}

} // namespace

void checkLineSolver(const LineSolverOptions& o) {
    if (o.rays && *o.rays == 0) throw UsageError("--rays: found 0, at least 1 is needed");
    if (o.targetError && !(*o.targetError > 0.0 && *o.targetError < 1.0))
        throw UsageError(
            fmt::format("--target-error: found {}, allowed are numbers above 0 and below 1", *o.targetError));
    if (o.sampler != Sampler::Sobol && o.sampler != Sampler::Random)
        throw UsageError(fmt::format("--sampler: the solver {} draws its rays from sobol or random, not from {}",
                                     nameOf(o.method), nameOf(o.sampler)));
    if (o.method == SolverMethod::RandomWalk && o.lines == RelaxationLines::Global)
        throw UsageError("--method: random walks go along local-lines");
}

StochasticSolution solveByLines(const SolverProblem& problem, const RayCaster& rays, const LineSolverOptions& options,
                                Progress& progress, const SolverContext& context) {
    checkLineSolver(options);
    return (options.method == SolverMethod::RandomWalk ? walk : relax)(problem, rays, options, progress, context);
}

std::string lineSolverIdentity(const SolverProblem& problem, const LineSolverOptions& o) {
    const char* const lines = o.lines == RelaxationLines::Local ? "local lines"
                              : o.lineSet == LineSet::Chords    ? "global chords"
                                                                : "global bundles";
    return fmt::format("{}, {}, {}, at most {} rays, target error {}, seed {}, {} patches, light {:016x}",
                       nameOf(o.method), lines, nameOf(o.sampler), mostRays(o), target(o), o.seed, problem.size(),
                       problem.checksum());
}

} // namespace lambert
