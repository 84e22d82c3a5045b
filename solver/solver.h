#pragma once

#include "core/progress.h"
#include "solver/form_factor_rows.h"
#include "solver/problem.h"
#include "solver/solution.h"
#include "solver/solver_checkpoint.h"

#include <optional>
#include <string_view>
#include <vector>

namespace lambert {

/// The one place where a solver is made from its name and options: what a new one needs beside its own files is a line in the
/// table and the switch of solver.cpp.
enum class SolverMethod { Jacobi, GaussSeidel, Southwell, ConjugateGradient };

std::optional<SolverMethod> solverByName(std::string_view name);
std::string_view nameOf(SolverMethod method);
std::vector<std::string> solverNames();

struct SolverOptions {
    SolverMethod method = SolverMethod::ConjugateGradient;
    double tolerance = 1e-4;  //!< stop once the relative residual is at most this; 0: only `bounces` decides
    int bounces = 0;          //!< of Jacobi: stop after so many iterations, each of which adds one bounce; 0: no limit
    bool keepBounces = false; //!< of Jacobi: keep what each iteration added: 12 bytes per patch and bounce
    std::optional<double>
        relaxation{}; //!< of Gauss-Seidel: 0 < W < 2: above 1 over-relaxes, which pays where much is reflected; none: 1
};

/// Throws UsageError for what can be known to be wrong without a problem: options out of range, or of another solver; bounces
/// that are counted or kept from a `warmStart`, which holds many.
void checkSolver(const SolverOptions& options, bool warmStart = false);

/// Solves the problem by a method with form factors. Throws UsageError as above, Cancelled, what a checkpoint throws. A residual
/// above the tolerance is not an error.
RadiositySolution solve(const SolverProblem& problem, FormFactorRows& rows, const SolverOptions& options,
                        Progress& progress, const SolverContext& context = {});

/// One line that names all that the solution depends on, but for the form factors.
std::string solverIdentity(const SolverProblem& problem, const SolverOptions& options, const SolverContext& context);

} // namespace lambert
