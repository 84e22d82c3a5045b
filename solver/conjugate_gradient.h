#pragma once

#include "solver/solver.h"

namespace lambert {

/// Solves the problem by conjugate directions on the symmetrised system, all channels at once, each with its own step
/// lengths. One iteration gathers once over all patches, as one of Jacobi's; high reflectances slow it down only as
/// 1 / sqrt(1 − ρ).
///
/// What is solved is the problem with the rows as they are: reciprocal form factors make it fast, but the residual is that of
/// the rows also where they are not. Memory: 216 bytes per patch beside the solution.
///
/// 2,000 iterations without reaching the tolerance, or a residual that rounding keeps above it, are not an error; see `residual`.
/// Throws Cancelled, and what a checkpoint throws.
RadiositySolution solveConjugateGradient(const SolverProblem& problem, FormFactorRows& rows,
                                         const SolverOptions& options, Progress& progress,
                                         const SolverContext& context = {});

} // namespace lambert
