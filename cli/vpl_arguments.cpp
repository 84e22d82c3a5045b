#include "cli/arguments.h"
#include "cli/validators.h"

#include "core/error.h"
#include "scene/words.h"

#include <fmt/format.h>

#include <cmath>
#include <utility>

namespace lambert {

namespace {

constexpr int kMostBounces = 126;           ///< see TraceOptions
constexpr std::uint32_t kRecoveryRays = 16; ///< from each of a patch's points

void refuseOthers(const TransportArguments& a) {
    const auto refuse = [](bool given, const char* option) {
        if (given) throw UsageError(fmt::format("{}: means nothing to the method {}", option, kInstantRadiosity));
    };
    refuse(a.resolution.has_value(), "--resolution");
    refuse(a.hemicubes.has_value(), "--hemicubes");
    refuse(a.rotation.has_value(), "--rotation");
    refuse(a.lines.has_value(), "--lines");
    refuse(a.lineSet.has_value(), "--line-set");
    refuse(a.formFactorError.has_value(), "--form-factor-error");
    refuse(a.storage != "auto", "--storage");
    refuse(a.memoryLimit != TransportArguments{}.memoryLimit, "--memory-limit");
    refuse(a.repair, "--repair");
    refuse(!a.formFactors.empty(), "--form-factors");
    refuse(!a.checkpoint.empty(), "--checkpoint");
    refuse(a.solver.has_value(), "--solver");
    refuse(a.tolerance.has_value(), "--tolerance");
    refuse(a.relaxation.has_value(), "--relaxation");
    refuse(a.rays.has_value(), "--rays");
    refuse(a.targetError.has_value(), "--target-error");
    refuse(a.keepBounces, "--keep-bounces");
    refuse(!a.warmStart.empty(), "--warm-start");
}

} // namespace

void addInstantRadiosityArguments(CLI::App& command, TransportArguments& a) {
    command.option_defaults()->group("Instant radiosity");
    addNumber(command, "--vpls", a.vpls,
              "Particles from the lights, 1 to 16777216: each leaves virtual point lights at its start and wherever "
              "it is reflected [4096]",
              "N", 1.0, 16777216.0);
    command
        .add_option(
            "--walk", a.walk,
            "How particles end: quasi, as a part of them that falls by the mean reflectance; roulette, by chance; "
            "fixed, after --bounces [quasi]")
        ->type_name("HOW")
        ->check(CLI::IsMember({"quasi", "roulette", "fixed"}));
    command
        .add_option("--clamp", a.clamp,
                    "Bound of the geometric term cosθ cosθ' / d², in units of six to the scene's area; or none [10]")
        ->type_name("G");
    command.add_flag("--compensate", a.compensate, "Recovers by rays what the bound takes away");
}

double geometricBound(const std::string& text) {
    if (text == "none") return kUnbounded;
    const auto bound = parseNumber(text);
    if (!bound || !(*bound > 0.0) || !std::isfinite(*bound))
        throw UsageError(fmt::format("--clamp: found \"{}\", allowed are numbers above 0 and none", text));
    return *bound;
}

bool usesVirtualLights(const TransportArguments& a) { return a.method == kInstantRadiosity; }

void refuseInstantRadiosity(const TransportArguments& a) {
    for (const auto& [given, option] :
         {std::pair{a.vpls.has_value(), "--vpls"}, std::pair{a.walk.has_value(), "--walk"},
          std::pair{a.clamp.has_value(), "--clamp"}, std::pair{a.compensate, "--compensate"}})
        if (given) throw UsageError(fmt::format("{}: is for --method {}", option, kInstantRadiosity));
}

InstantRadiosityOptions instantRadiosityOptions(const TransportArguments& a, const RunArguments& run) {
    refuseOthers(a);
    InstantRadiosityOptions options;
    options.trace.particles = a.vpls.value_or(qualityOf(a.quality).particles);
    if (a.walk) options.trace.walk = walkByName(*a.walk).value();
    if (a.bounces > 0) {
        if (options.trace.walk != Walk::Fixed)
            throw UsageError("--bounces: is for --walk fixed; other walks end by themselves");
        if (a.bounces > kMostBounces)
            throw UsageError(
                fmt::format("--bounces: found {}, allowed with --walk fixed are 1 to {}", a.bounces, kMostBounces));
        options.trace.bounces = static_cast<std::uint32_t>(a.bounces);
    }
    if (a.sampler && *a.sampler != "halton" && *a.sampler != "random")
        throw UsageError(fmt::format("--sampler: found {}, allowed with --method {} are halton and random", *a.sampler,
                                     kInstantRadiosity));
    options.trace.sampler = samplerByName(a.sampler.value_or("halton")).value();
    options.trace.seed = options.gather.seed = run.seed;
    if (a.clamp) options.gather.bound = geometricBound(*a.clamp);
    if (a.compensate && options.gather.bound == kUnbounded)
        throw UsageError("--compensate: there is nothing to recover with --clamp none");
    options.gather.recoveryRays = a.compensate ? kRecoveryRays : 0;
    checkInstantRadiosity(options);
    return options;
}

nlohmann::ordered_json instantRadiosityOptionsJson(const InstantRadiosityOptions& options) {
    using Json = nlohmann::ordered_json;
    Json json;
    json["vpls"] = options.trace.particles;
    json["walk"] = nameOf(options.trace.walk);
    json["bounces"] = options.trace.walk == Walk::Fixed ? Json(options.trace.bounces) : Json(nullptr);
    json["clamp"] = options.gather.bound == kUnbounded ? Json("none") : Json(options.gather.bound);
    json["compensate"] = options.gather.recoveryRays > 0;
    json["sampler"] = nameOf(options.trace.sampler);
    return json;
}

} // namespace lambert
