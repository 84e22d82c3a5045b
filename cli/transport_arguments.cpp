#include "cli/arguments.h"
#include "cli/validators.h"

#include "core/error.h"

#include <fmt/format.h>

#include <cmath>

namespace lambert {

namespace {

/// Options that would do nothing are mistakes.
void refuseUnused(const TransportArguments& a, TransportMethod method) {
    const auto refuse = [&](const char* option) {
        throw UsageError(fmt::format("{}: means nothing to the method {}", option, nameOf(method)));
    };
    if (!hasResolution(method)) {
        if (a.resolution) refuse("--resolution");
        if (a.hemicubes) refuse("--hemicubes");
        if (a.rotation) refuse("--rotation");
    }
    if (!hasLines(method)) {
        if (a.lines) refuse("--lines");
        if (a.sampler) refuse("--sampler");
    }
    if (a.lineSet && method != TransportMethod::GlobalLines) refuse("--line-set");
    if (a.formFactorError && method != TransportMethod::ClosedForm && method != TransportMethod::Auto)
        refuse("--form-factor-error");
}

/// A solver that computes its rows takes them as they come.
void refuseWithoutMatrix(const TransportArguments& a) {
    if (a.repair) throw UsageError("--repair: needs the whole matrix, not --storage none");
    if (!a.formFactors.empty()) throw UsageError("--form-factors: is a matrix to be stored, not --storage none");
}

/// The one asked for; without one, what the options of one say is meant.
TransportMethod methodOf(const TransportArguments& a) {
    if (a.method) return methodByName(*a.method).value();
    return a.resolution || a.hemicubes || a.rotation ? TransportMethod::Hemicube : TransportMethod::Auto;
}

void refuseBesideFile(const TransportArguments& a) {
    if (a.method || a.resolution || a.hemicubes || a.rotation || a.lines || a.sampler || a.lineSet || a.formFactorError)
        throw UsageError("--form-factors: the file holds what was computed; leave out --method and its options");
}

} // namespace

void addFormFactorArguments(CLI::App& command, TransportArguments& a, const std::vector<std::string>& methods) {
    command.option_defaults()->group("Transport");
    const auto addChoice = [&](const char* name, auto& value, const std::string& text, const char* type,
                               const std::vector<std::string>& choices) {
        command.add_option(name, value, text)->check(CLI::IsMember(choices))->type_name(type);
    };
    addChoice("--method", a.method,
              fmt::format("How form factors are computed, or light without them: {} [auto; hemicube with its options]",
                          fmt::join(methods, ", ")),
              "METHOD", methods);
    addNumber(
        command, "--resolution", a.resolution,
        "Pixels along the edge of a hemicube, even, 4 to 4096 [128], or of a hemisphere's square, a multiple of 4 "
        "[220]; less if time or memory ask for it",
        "R", 4.0, 4096.0);
    addNumber(command, "--hemicubes", a.hemicubes, "Hemicubes or hemispheres spread over a patch, 1 to 1024 [1]", "K",
              1.0, 1024.0);
    addChoice("--rotation", a.rotation, "Of these about their normals: random or fixed [random]", "HOW",
              {"random", "fixed"});
    addNumber(
        command, "--lines", a.lines,
        "Local lines per patch, 1 to 16777216 [32768], or global lines in all, up to 4294967295 [an eighth of the "
        "hemicubes' rays]; less if time or memory ask for it",
        "N", 1.0, 4294967295.0);
    addChoice(
        "--sampler", a.sampler,
        "Of lines: random, stratified, halton or sobol [sobol]; of virtual point lights: halton or random [halton]",
        "SAMPLER", {"random", "stratified", "halton", "sobol"});
    addChoice("--line-set", a.lineSet, "Global lines: chords of a sphere, or bundles of parallel lines [chords]", "SET",
              {"chords", "bundles"});
    addNumber(command, "--form-factor-error", a.formFactorError,
              "auto: aimed at in a row, sum of |error| over its factors, 1e-5 to 0.5 [0.01]; closed form: in partly "
              "hidden pairs, relative, 1e-8 to 0.1 [1e-4]",
              "E", 1e-8, 0.5);
    addChoice(
        "--storage", a.storage,
        "Of factors in memory: double (12 bytes each), float (8), compact (3; to 0.017 %, exact for lines), auto: "
        "float while it fits; none: rows are computed when a solver needs them, for --solver southwell [auto]",
        "STORAGE", {"double", "float", "compact", "none", "auto"});
    addNumber(command, "--memory-limit", a.memoryLimit, "For the form factors; what would take more is refused [8 GiB]",
              "BYTES", 1.0, 1e18);
    command.add_flag("--repair", a.repair,
                     "Makes the form factors reciprocal, A_i F_ij = A_j F_ji, and their rows sum to what they must");
    command.option_defaults()->group("Run");
    auto* checkpoint =
        command
            .add_option("--checkpoint", a.checkpoint,
                        "Keeps finished rows of form factors in a file, every minute and when interrupted, and the "
                        "solver's state in FILE.solver, every minute, also that of solvers without form factors; "
                        "removed at the end")
            ->type_name("FILE");
    command.add_flag("--resume", a.resume, "Goes on with the checkpoint, if it is there")->needs(checkpoint);
    addNumber(command, "--checkpoint-interval", a.checkpointInterval, "[60]", "SECONDS", 0.0, 1e6)->needs(checkpoint);
}

MatrixSource matrixSource(const TransportArguments& a, const RunArguments& run) {
    MatrixSource source;
    TransportOptions& options = source.transport;
    const Quality& quality = qualityOf(a.quality);
    options.method = methodOf(a);
    options.resolution = a.resolution;
    options.perPatch = a.hemicubes.value_or(1);
    options.randomRotation = a.rotation.value_or("random") == "random";
    options.lines = a.lines;
    options.sampler = samplerByName(a.sampler.value_or("sobol")).value();
    options.lineSet = a.lineSet.value_or("chords") == "bundles" ? LineSet::Bundles : LineSet::Chords;
    (options.method == TransportMethod::Auto ? options.rowError : options.error) =
        a.formFactorError.value_or(options.method == TransportMethod::Auto ? options.rowError : options.error);
    options.seed = run.seed;
    options.stored = a.storage != "none";
    options.storage = storageByName(a.storage); // no value for auto
    options.memoryLimit = static_cast<std::uint64_t>(a.memoryLimit);
    options.largestResolution = quality.largestResolution;
    options.mostRays = quality.mostRays;
    source.file = a.formFactors;
    source.repair = a.repair;
    if (!options.stored) refuseWithoutMatrix(a);
    if (a.formFactors.empty())
        refuseUnused(a, options.method);
    else
        refuseBesideFile(a);
    checkTransport(options);
    return source;
}

void addTransportInputs(const TransportArguments& a, std::vector<std::filesystem::path>& inputs) {
    for (const auto& file : {a.formFactors, a.warmStart, skyPicture(a.light)})
        if (!file.empty()) inputs.push_back(file);
}

nlohmann::ordered_json matrixOptionsJson(const MatrixSource& source, const std::optional<TransportPlan>& plan) {
    using Json = nlohmann::ordered_json;
    Json json;
    const TransportMethod method = source.transport.method;
    const bool resolution = plan && hasResolution(method);
    const bool lines = plan && hasLines(method);
    json["resolution"] = resolution ? Json(*plan->options.resolution) : Json(nullptr);
    json["hemicubes"] = resolution ? Json(source.transport.perPatch) : Json(nullptr);
    json["rotation"] = resolution ? Json(source.transport.randomRotation ? "random" : "fixed") : Json(nullptr);
    json["lines"] = lines ? Json(*plan->options.lines) : Json(nullptr);
    json["sampler"] = lines ? Json(nameOf(source.transport.sampler)) : Json(nullptr);
    const bool global = plan && method == TransportMethod::GlobalLines;
    json["line_set"] = global ? Json(plan->options.lineSet == LineSet::Bundles ? "bundles" : "chords") : Json(nullptr);
    json["form_factor_error"] = !plan                                   ? Json(nullptr)
                                : method == TransportMethod::ClosedForm ? Json(plan->options.error)
                                : method == TransportMethod::Auto       ? Json(plan->options.rowError)
                                                                        : Json(nullptr);
    const auto storage = plan ? plan->options.storage : source.transport.storage;
    json["storage"] = source.transport.stored ? nameOf(storage.value_or(MatrixStorage::Double)) : "none";
    json["memory_limit"] = source.transport.memoryLimit;
    json["repair"] = source.repair;
    json["form_factors"] = source.file.empty() ? Json(nullptr) : Json(source.file.string());
    return json;
}

std::string repairText(const RepairReport& repair) {
    std::string text = fmt::format(
        "repair: reciprocity error was {:.2g}, rows off by {:.2g} at most; largest correction {:.2g} %, rows "
        "changed by {:.2g} in the mean",
        repair.reciprocityError, repair.closureError, 100.0 * repair.largestCorrection, repair.rowChange);
    if (!repair.failed.empty())
        text += fmt::format("; {} rows could not be closed, the first is {}, by {:.2g} at most", repair.failed.size(),
                            repair.failed.front() + 1, repair.remainingError);
    return text;
}

nlohmann::ordered_json repairJson(const std::optional<RepairReport>& repair) {
    if (!repair) return nullptr;
    return {{"reciprocity_error_before", repair->reciprocityError},
            {"closure_error_before", repair->closureError},
            {"largest_correction", repair->largestCorrection},
            {"row_change", repair->rowChange},
            {"closure_error_after", repair->remainingError},
            {"iterations", repair->iterations},
            {"failed_rows", repair->failed}};
}

} // namespace lambert
