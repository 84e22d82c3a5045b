#pragma once

#include "solver/solver.h"

namespace lambert {

/// Solves the problem by Jacobi iteration from B = B_e: one iteration gathers one bounce, the first one that of E_0 too.
///
/// 10,000 iterations without reaching the tolerance are not an error; see `residual`. Throws Cancelled, and what a checkpoint throws.
RadiositySolution solveJacobi(const SolverProblem& problem, FormFactorRows& rows, const SolverOptions& options,
                              Progress& progress, const SolverContext& context = {});

} // namespace lambert
