#pragma once

#include "core/progress.h"
#include "solver/form_factor_rows.h"
#include "solver/problem.h"
#include "solver/solution.h"

namespace lambert {

/// Gathers E = E_0 + F B of the solution's radiosity B, and returns its relative residual. Throws Cancelled.
double gatherResidual(const SolverProblem& problem, FormFactorRows& rows, RadiositySolution& solution,
                      const Progress& progress);

} // namespace lambert
