#include "cli/arguments.h"
#include "cli/validators.h"

#include <fmt/format.h>

namespace lambert {

void addSolverArguments(CLI::App& command, TransportArguments& a) {
    command
        .add_option("--solver", a.solver,
                    fmt::format("How the light of all bounces is found: {} [conjugate-gradient; jacobi for --bounces "
                                "and --keep-bounces]",
                                fmt::join(solverNames(), ", ")))
        ->check(CLI::IsMember(solverNames()))
        ->type_name("SOLVER")
        ->group("Solution");
    command.add_option("--tolerance", a.tolerance, "Relative residual at which the solver stops [1e-4]")
        ->type_name("T")
        ->check(between(0.0, 1.0))
        ->group("Solution");
    command.add_option("--bounces", a.bounces, "Jacobi: at most so many bounces; 0: no limit [0]")
        ->type_name("K")
        ->check(between(0, 1e6))
        ->group("Solution");
    command
        .add_flag("--keep-bounces", a.keepBounces,
                  "Jacobi: keeps what each bounce adds, 12 bytes per patch each, and reports it (--json)")
        ->group("Solution");
    command
        .add_option("--relaxation", a.relaxation,
                    "Gauss-Seidel: above 1, below 2 over-relaxes, which pays in bright rooms [1]")
        ->type_name("W")
        ->check(between(0.0, 2.0))
        ->group("Solution");
}

SolverOptions solverOptions(const TransportArguments& a) {
    SolverOptions options;
    const bool byBounce = a.bounces > 0 || a.keepBounces;
    options.method = a.solver   ? solverByName(*a.solver).value()
                     : byBounce ? SolverMethod::Jacobi
                                : SolverMethod::ConjugateGradient;
    options.tolerance = a.tolerance.value_or(qualityOf(a.quality).tolerance);
    options.bounces = a.bounces;
    options.keepBounces = a.keepBounces;
    options.relaxation = a.relaxation;
    checkSolver(options);
    return options;
}

nlohmann::ordered_json solverOptionsJson(const SolverOptions& options) {
    using Json = nlohmann::ordered_json;
    Json json;
    json["tolerance"] = options.tolerance;
    json["bounces"] = options.bounces;
    json["keep_bounces"] = options.keepBounces;
    json["relaxation"] =
        options.method == SolverMethod::GaussSeidel ? Json(options.relaxation.value_or(1.0)) : Json(nullptr);
    return json;
}

} // namespace lambert
