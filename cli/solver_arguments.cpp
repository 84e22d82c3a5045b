#include "cli/arguments.h"
#include "cli/validators.h"

#include "core/error.h"

#include <fmt/format.h>

namespace lambert {

void addSolverArguments(CLI::App& command, TransportArguments& a) {
    command.option_defaults()->group("Solution");
    std::vector<std::string> solvers = solverNames();
    for (const std::string& name : lineSolverNames()) solvers.push_back(name);
    command
        .add_option("--solver", a.solver,
                    fmt::format("How the light of all bounces is found: {} [conjugate-gradient; jacobi for --bounces "
                                "and --keep-bounces]",
                                fmt::join(solvers, ", ")))
        ->check(CLI::IsMember(solvers))
        ->type_name("SOLVER");
    addNumber(command, "--tolerance", a.tolerance, "Relative residual at which the solver stops [1e-4]", "T", 0.0, 1.0);
    addNumber(command, "--bounces", a.bounces,
              "Jacobi: at most so many bounces; 0: no limit [0]; --walk fixed: so many [4]", "K", 0, 1e6);
    command.add_flag("--keep-bounces", a.keepBounces,
                     "Jacobi: keeps what each bounce adds, 12 bytes per patch each, and reports it (--json)");
    addNumber(command, "--relaxation", a.relaxation,
              "Gauss-Seidel: above 1, below 2 over-relaxes, which pays in bright rooms [1]", "W", 0.0, 2.0);
    addNumber(command, "--target-error", a.targetError,
              "Stochastic and random-walk: relative standard error of E, over all patches, at which to stop; kept in "
              "19 of 20 runs [0.02; with --rays none]",
              "E", 0.0, 1.0);
    addNumber(command, "--rays", a.rays,
              "Stochastic: rays in all, random-walk: walks; with --target-error at most so many [4e9]", "N", 1.0, 1e15);
    command
        .add_option(
            "--warm-start", a.warmStart,
            "A file by --solution of the same patches, to begin from: for other materials or a smaller tolerance")
        ->type_name("FILE");
}

namespace {

void refuseFormFactors(const TransportArguments& a, LineSolver solver) {
    const auto refuse = [&](bool given, const char* option, const char* why = ", which uses no form factors") {
        if (given) throw UsageError(fmt::format("{}: means nothing to the solver {}{}", option, nameOf(solver), why));
    };
    refuse(a.bounces > 0, "--bounces", "");
    refuse(a.keepBounces, "--keep-bounces", "");
    refuse(a.relaxation.has_value(), "--relaxation", "");
    refuse(a.resolution.has_value(), "--resolution");
    refuse(a.hemicubes.has_value(), "--hemicubes");
    refuse(a.rotation.has_value(), "--rotation");
    refuse(a.lines.has_value(), "--lines");
    refuse(a.formFactorError.has_value(), "--form-factor-error");
    refuse(a.storage != "auto", "--storage");
    refuse(a.repair, "--repair");
    refuse(!a.formFactors.empty(), "--form-factors");
    refuse(a.tolerance.has_value(), "--tolerance");
    refuse(!a.warmStart.empty(), "--warm-start");
}

} // namespace

LineSolverOptions lineSolverOptions(const TransportArguments& a, const RunArguments& run) {
    LineSolverOptions options;
    options.solver = lineSolverByName(a.solver.value()).value();
    refuseFormFactors(a, options.solver);
    const std::string method = a.method.value_or("local-lines");
    if (method != "local-lines" && method != "global-lines")
        throw UsageError(fmt::format("--method: the solver {} works with local-lines or global-lines, not with {}",
                                     nameOf(options.solver), method));
    options.lines = method == "global-lines" ? RelaxationLines::Global : RelaxationLines::Local;
    if (a.lineSet && options.lines == RelaxationLines::Local)
        throw UsageError("--line-set: means nothing to local-lines");
    options.lineSet = a.lineSet.value_or("chords") == "bundles" ? LineSet::Bundles : LineSet::Chords;
    options.sampler = samplerByName(a.sampler.value_or("sobol")).value();
    if (a.rays) options.rays = static_cast<std::uint64_t>(*a.rays);
    options.targetError = a.targetError;
    options.seed = run.seed;
    checkLineSolver(options);
    return options;
}

nlohmann::ordered_json lineSolverOptionsJson(const LineSolverOptions& options) {
    using Json = nlohmann::ordered_json;
    const bool global = options.lines == RelaxationLines::Global;
    Json json;
    json["rays"] = options.rays ? Json(*options.rays) : Json(nullptr);
    json["target_error"] = options.targetError ? Json(*options.targetError)
                           : options.rays      ? Json(nullptr)
                                               : Json(LineSolverOptions::kTargetError);
    json["sampler"] = nameOf(options.sampler);
    json["line_set"] = global ? Json(options.lineSet == LineSet::Bundles ? "bundles" : "chords") : Json(nullptr);
    return json;
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
    if (a.rays || a.targetError)
        throw UsageError(fmt::format("{}: means nothing to the solver {}", a.rays ? "--rays" : "--target-error",
                                     nameOf(options.method)));
    checkSolver(options, !a.warmStart.empty());
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
