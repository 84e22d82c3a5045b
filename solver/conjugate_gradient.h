#pragma once

#include "core/progress.h"
#include "solver/form_factor_rows.h"
#include "solver/problem.h"
#include "solver/solution.h"
#include "solver/solver_checkpoint.h"

namespace lambert {

struct ConjugateGradientOptions {
    double tolerance = 1e-4; //!< stop once the relative residual is at most this
    int maxIterations = 1000;
};

/// Solves the problem by conjugate directions on the symmetrised system, all channels at once, each with its own step
/// lengths. One iteration gathers once over all patches, as one of Jacobi's; high reflectances slow it down only as
/// 1 / sqrt(1 − ρ).
///
/// What is solved is the problem with the rows as they are: reciprocal form factors make it fast, but the residual is that of
/// the rows also where they are not. Memory: 216 bytes per patch beside the solution.
///
/// A limit reached before the tolerance, or a residual that rounding keeps above it, is not an error; see `residual`.
/// Throws Cancelled, and what a checkpoint throws.
RadiositySolution solveConjugateGradient(const SolverProblem& problem, FormFactorRows& rows,
                                         const ConjugateGradientOptions& options, Progress& progress,
                                         const SolverContext& context = {});

} // namespace lambert
