#include "solver/line_solvers.h"

#include "core/error.h"
#include "core/named.h"
#include "solver/random_walks.h"

#include <fmt/format.h>

#include <array>

namespace lambert {

namespace {

constexpr std::array kSolvers{Named{LineSolver::Stochastic, "stochastic"},
                              Named{LineSolver::RandomWalk, "random-walk"}};

std::uint64_t mostRays(const LineSolverOptions& o) { return o.rays.value_or(LineSolverOptions::kMostRays); }

/// 0: the rays decide.
double target(const LineSolverOptions& o) { return o.targetError.value_or(o.rays ? 0.0 : o.kTargetError); }

} // namespace

std::optional<LineSolver> lineSolverByName(std::string_view name) { return valueNamed(kSolvers, name); }
std::string_view nameOf(LineSolver solver) { return rowOf(kSolvers, solver).name; }
std::vector<std::string> lineSolverNames() { return namesIn(kSolvers); }

void checkLineSolver(const LineSolverOptions& o) {
    if (o.rays && *o.rays == 0) throw UsageError("--rays: found 0, at least 1 is needed");
    if (o.targetError && !(*o.targetError > 0.0 && *o.targetError < 1.0))
        throw UsageError(
            fmt::format("--target-error: found {}, allowed are numbers above 0 and below 1", *o.targetError));
    if (o.sampler != Sampler::Sobol && o.sampler != Sampler::Random)
        throw UsageError(fmt::format("--sampler: the solver {} draws its rays from sobol or random, not from {}",
                                     nameOf(o.solver), nameOf(o.sampler)));
    if (o.solver == LineSolver::RandomWalk && o.lines == RelaxationLines::Global)
        throw UsageError("--method: random walks go along local-lines");
}

StochasticSolution solveByLines(const SolverProblem& problem, const PatchMesh& mesh, const RayCaster& rays,
                                const LineSolverOptions& o, Progress& progress, const SolverContext& context) {
    checkLineSolver(o);
    if (o.solver == LineSolver::RandomWalk)
        return solveRandomWalks(problem, mesh, rays,
                                {.walks = mostRays(o), .targetError = target(o), .sampler = o.sampler, .seed = o.seed},
                                progress, context);
    return solveStochasticRelaxation(problem, mesh, rays,
                                     {.rays = mostRays(o),
                                      .targetError = target(o),
                                      .lines = o.lines,
                                      .lineSet = o.lineSet,
                                      .sampler = o.sampler,
                                      .seed = o.seed},
                                     progress, context);
}

std::string lineSolverIdentity(const SolverProblem& problem, const LineSolverOptions& o) {
    const char* const lines = o.lines == RelaxationLines::Local ? "local lines"
                              : o.lineSet == LineSet::Chords    ? "global chords"
                                                                : "global bundles";
    return fmt::format("{}, {}, {}, at most {} rays, target error {}, seed {}, {} patches, light {:016x}",
                       nameOf(o.solver), lines, nameOf(o.sampler), mostRays(o), target(o), o.seed, problem.size(),
                       problem.checksum());
}

} // namespace lambert
