#pragma once

#include "core/progress.h"
#include "core/sample_points.h"
#include "formfactors/isotropic_lines.h"
#include "scene/rays/ray_caster.h"
#include "solver/problem.h"
#include "solver/solver_checkpoint.h"
#include "solver/stochastic_relaxation.h"
#include "solver/stochastic_solution.h"

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace lambert {

/// Solvers that send light along random lines, without form factors.
enum class LineSolver : std::uint8_t { Stochastic, RandomWalk };

std::optional<LineSolver> lineSolverByName(std::string_view name);
std::string_view nameOf(LineSolver solver);
std::vector<std::string> lineSolverNames();

/// What they have in common.
struct LineSolverOptions {
    LineSolver solver = LineSolver::Stochastic;
    std::optional<std::uint64_t> rays{}; //!< at most so many in all; none: kMostRays with a target error
    std::optional<double> targetError{}; //!< relative, see StochasticSolution; none: kTargetError without `rays`
    RelaxationLines lines = RelaxationLines::Local; //!< of stochastic relaxation
    LineSet lineSet = LineSet::Chords;              //!< of its global lines
    Sampler sampler = Sampler::Sobol;               //!< or Random
    std::uint64_t seed = 1;

    static constexpr double kTargetError = 0.02;
    static constexpr std::uint64_t kMostRays = 4'000'000'000;
};

/// Throws UsageError for what can be known to be wrong without a problem.
void checkLineSolver(const LineSolverOptions& options);

/// Solves the problem without form factors. `rays` are of the scene of its mesh. Throws UsageError as above, Cancelled, what a
/// checkpoint throws. A target error that was not reached is no error.
StochasticSolution solveByLines(const SolverProblem& problem, const PatchMesh& mesh, const RayCaster& rays,
                                const LineSolverOptions& options, Progress& progress,
                                const SolverContext& context = {});

/// One line that names all that the solution depends on, but for the scene that the rays meet.
std::string lineSolverIdentity(const SolverProblem& problem, const LineSolverOptions& options);

} // namespace lambert
