#pragma once

#include "core/progress.h"
#include "solver/form_factor_rows.h"
#include "solver/problem.h"
#include "solver/solution.h"
#include "solver/solver_checkpoint.h"

#include <vector>

namespace lambert {

struct GaussSeidelOptions {
    double tolerance = 1e-4; //!< stop once the relative residual is at most this
    double relaxation = 1.0; //!< 0 < W < 2: above 1 over-relaxes, which pays where much is reflected
    int maxIterations = 10'000;
};

/// Solves the problem by Gauss-Seidel iteration from B = B_e: patch by patch, in their order, each from the newest
/// radiosities of all others. Residuals in the history are the changes of a sweep, extrapolated to the next one; the last is
/// measured.
///
/// A limit reached before the tolerance is not an error; see `residual`. Throws Cancelled, and what a checkpoint throws.
RadiositySolution solveGaussSeidel(const SolverProblem& problem, FormFactorRows& rows,
                                   const GaussSeidelOptions& options, Progress& progress,
                                   const SolverContext& context = {});

/// One sweep over `radiosity`, #patches: B_i += W (B_e,i + ρ_i (E_0,i + Σ_j F_ij B_j) − B_i). Returns Σ A |change|² over
/// patches and channels. Throws Cancelled.
double gaussSeidelSweep(const SolverProblem& problem, FormFactorRows& rows, double relaxation,
                        std::vector<RgbSum>& radiosity, const Progress& progress);

} // namespace lambert
