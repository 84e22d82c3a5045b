#include "solver/solver.h"

#include "core/checksum.h"
#include "core/error.h"
#include "core/named.h"
#include "solver/conjugate_gradient.h"
#include "solver/gauss_seidel.h"
#include "solver/jacobi.h"
#include "solver/southwell.h"

#include <fmt/format.h>

#include <array>

namespace lambert {

namespace {

constexpr std::array kSolvers{Named{SolverMethod::Jacobi, "jacobi"}, Named{SolverMethod::GaussSeidel, "gauss-seidel"},
                              Named{SolverMethod::Southwell, "southwell"},
                              Named{SolverMethod::ConjugateGradient, "conjugate-gradient"}};

} // namespace

std::optional<SolverMethod> solverByName(std::string_view name) { return valueNamed(kSolvers, name); }
std::string_view nameOf(SolverMethod method) { return rowOf(kSolvers, method).name; }
std::vector<std::string> solverNames() { return namesIn(kSolvers); }

void checkSolver(const SolverOptions& o, bool warmStart) {
    const auto refuse = [&](const char* option) {
        throw UsageError(fmt::format("{}: means nothing to the solver {}", option, nameOf(o.method)));
    };
    if (o.method != SolverMethod::Jacobi) {
        if (o.bounces != 0) refuse("--bounces");
        if (o.keepBounces) refuse("--keep-bounces");
    }
    if (warmStart && (o.bounces != 0 || o.keepBounces))
        throw UsageError("--warm-start: --bounces and --keep-bounces count from the dark; leave them out");
    if (!(o.tolerance > 0.0) && o.bounces == 0)
        throw UsageError("--tolerance: 0 is never reached; allowed with --bounces");
    if (o.relaxation && o.method != SolverMethod::GaussSeidel) refuse("--relaxation");
    if (o.relaxation && !(*o.relaxation > 0.0 && *o.relaxation < 2.0))
        throw UsageError(fmt::format("--relaxation: found {}, allowed are numbers above 0 and below 2", *o.relaxation));
}

std::string solverIdentity(const SolverProblem& problem, const SolverOptions& o, const SolverContext& context) {
    Checksum sum;
    sum.add(problem.checksum());
    sum.add(std::as_bytes(context.start));
    return fmt::format("{}, tolerance {}, {} bounces{}, relaxation {}, {} patches, light {:016x}", nameOf(o.method),
                       o.tolerance, o.bounces, o.keepBounces ? " kept" : "", o.relaxation.value_or(1.0), problem.size(),
                       sum.value());
}

RadiositySolution solve(const SolverProblem& problem, FormFactorRows& rows, const SolverOptions& o, Progress& progress,
                        const SolverContext& context) {
    checkSolver(o, !context.start.empty());
    switch (o.method) {
    case SolverMethod::Jacobi:
        return solveJacobi(problem, rows, o, progress, context);
    case SolverMethod::GaussSeidel:
        return solveGaussSeidel(problem, rows, o, progress, context);
    case SolverMethod::Southwell:
        return solveSouthwell(problem, rows, o, progress, context);
    case SolverMethod::ConjugateGradient:
        return solveConjugateGradient(problem, rows, o, progress, context);
    }
    return {}; // not reached
}

} // namespace lambert
