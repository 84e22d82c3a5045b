#pragma once

#include "solver/solver.h"

#include <vector>

namespace lambert {

/// Solves the problem by Gauss-Seidel iteration from B = B_e: patch by patch, in their order, each from the newest
/// radiosities of all others. Residuals in the history are the changes of a sweep, extrapolated to the next one; the last is
/// measured.
///
/// 10,000 sweeps without reaching the tolerance are not an error; see `residual`. Throws Cancelled, and what a checkpoint throws.
RadiositySolution solveGaussSeidel(const SolverProblem& problem, FormFactorRows& rows, const SolverOptions& options,
                                   Progress& progress, const SolverContext& context = {});

/// One sweep over `radiosity`, #patches: B_i += W (B_e,i + ρ_i (E_0,i + Σ_j F_ij B_j) − B_i). Returns Σ A |change|² over
/// patches and channels. Throws Cancelled.
double gaussSeidelSweep(const SolverProblem& problem, FormFactorRows& rows, double relaxation,
                        std::vector<RgbSum>& radiosity, const Progress& progress);

} // namespace lambert
