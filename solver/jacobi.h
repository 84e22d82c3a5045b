#pragma once

#include "core/progress.h"
#include "solver/form_factor_rows.h"
#include "solver/problem.h"
#include "solver/solution.h"
#include "solver/solver_checkpoint.h"

namespace lambert {

struct JacobiOptions {
    double tolerance = 1e-4;  //!< stop once the relative residual is at most this; 0: only `bounces` decides
    int bounces = 0;          //!< stop after so many iterations, each of which adds one bounce; 0: no limit
    bool keepBounces = false; //!< keep what each iteration added: 12 bytes per patch and bounce
    int maxIterations = 10'000;
};

/// Solves the problem by Jacobi iteration from B = B_e: one iteration gathers one bounce, the first one that of E_0 too.
///
/// A limit reached before the tolerance is not an error; see `residual`. Throws Cancelled, and what a checkpoint throws.
RadiositySolution solveJacobi(const SolverProblem& problem, FormFactorRows& rows, const JacobiOptions& options,
                              Progress& progress, const SolverContext& context = {});

} // namespace lambert
