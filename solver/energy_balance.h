#pragma once

#include "solver/form_factor_rows.h"
#include "solver/problem.h"
#include "solver/solution.h"

namespace lambert {

/// All terms of the energy balance of a solution, each from its own definition. The rows must know all back() and out().
EnergyBalance energyBalance(const SolverProblem& problem, const FormFactorRows& rows,
                            const RadiositySolution& solution);

/// What every solver ends with: completes the rows, adds B_e to the radiosity where the problem has kept it back, and sets `covered`
/// and `energy` of a solution. Throws Cancelled.
void settle(const SolverProblem& problem, FormFactorRows& rows, RadiositySolution& solution, Progress& progress);

} // namespace lambert
