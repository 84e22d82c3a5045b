#include "cli/arguments.h"
#include "cli/bake_report.h"
#include "cli/commands.h"
#include "cli/compare_folder.h"
#include "cli/scene_files.h"
#include "cli/terminal_progress.h"
#include "cli/validators.h"

#include "comparison/page/gnuplot.h"
#include "comparison/vpl_page.h"
#include "comparison/vpl_report.h"
#include "core/parallel.h"
#include "core/stopwatch.h"
#include "vpl/instant_radiosity_method.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <optional>

namespace lambert {

namespace fs = std::filesystem;

namespace {

constexpr double kCoarser = 0.2;       ///< of what is added to the polygons by default: the reference's mesh is finer
constexpr double kMostVpls = 16777216; ///< see TraceOptions

struct CompareVplArguments {
    SceneArguments scene;
    TransportArguments transport; //!< of which mesh and light
    PictureArguments picture;     //!< of which size and camera
    RunArguments run;
    fs::path output;
    std::string methods = "all";
    double vpls = 1024.0;
    std::vector<double> ladder;
    int seeds = 16;
    std::string walk = "quasi";
    std::optional<std::uint32_t> bounces{};
    std::string clamp = "10";
    std::string visibility = "exact";
    bool compensate = false;
    std::optional<int> perBounce{};
};

using Method = std::shared_ptr<const VplMethod>;

Method instantRadiosity(const CompareVplArguments& a) {
    InstantRadiosityChoice choice;
    choice.walk = walkByName(a.walk).value();
    if (a.bounces) choice.bounces = *a.bounces;
    if (a.bounces && choice.walk != Walk::Fixed)
        throw UsageError("--vpl-bounces: is for --walk fixed; other walks end by themselves");
    choice.bound = geometricBound(a.clamp);
    choice.indirectShadows = a.visibility == "exact";
    choice.compensate = a.compensate;
    if (a.compensate && choice.bound == kUnbounded)
        throw UsageError("--compensate: there is nothing to recover with --clamp none");
    return std::make_shared<InstantRadiosityMethod>(choice);
}

/// What --methods names.
struct NamedMethod {
    const char* name;
    Method (*make)(const CompareVplArguments&);
};
constexpr std::array kMethods{NamedMethod{"instant-radiosity", instantRadiosity}};

std::vector<std::string> vplMethodNames() {
    std::vector<std::string> names;
    for (const NamedMethod& method : kMethods) names.emplace_back(method.name);
    return names;
}

std::vector<Method> methods(const CompareVplArguments& a) {
    std::vector<std::string> names = a.methods == "all" ? vplMethodNames() : separated(a.methods);
    std::vector<Method> result;
    for (const std::string& name : names) {
        const auto found =
            std::find_if(kMethods.begin(), kMethods.end(), [&](const NamedMethod& m) { return m.name == name; });
        if (found == kMethods.end())
            throw UsageError(fmt::format("--methods: no method \"{}\": there are {}; or all alone", name,
                                         fmt::join(vplMethodNames(), ", ")));
        if (std::count(names.begin(), names.end(), name) > 1)
            throw UsageError(fmt::format("--methods: {} is named twice", name));
        result.push_back(found->make(a));
    }
    return result;
}

void checkWhole(double value, const char* option) {
    if (value != std::floor(value))
        throw UsageError(fmt::format("{}: found {:g}, allowed are whole numbers", option, value));
}

nlohmann::ordered_json report(const CompareVplArguments& a, const ReadReport& read, const MeshedScene& scene,
                              const VplComparison& comparison, const VplPictures& pictures, double seconds) {
    nlohmann::ordered_json json;
    json["scene"] = a.scene.path.string();
    json["patches"] = scene.mesh.size();
    json["options"] = sceneOptionsJson(a.scene, read.overrides);
    json["options"]["vpls"] = a.vpls;
    json["options"]["walk"] = a.walk;
    if (a.walk == "fixed") json["options"]["vpl_bounces"] = a.bounces.value_or(InstantRadiosityChoice{}.bounces);
    json["options"]["clamp"] = a.clamp;
    json["options"]["compensate"] = a.compensate;
    json["options"]["visibility"] = a.visibility;
    json["options"]["per_bounce"] =
        a.perBounce ? nlohmann::ordered_json(*a.perBounce) : nlohmann::ordered_json(nullptr);
    json["options"]["threads"] = threadCount();
    json["seed"] = a.run.seed;
    json["seeds"] = a.seeds;
    json["version"] = LAMBERT_VERSION;
    json["seconds"] = seconds;
    json.update(vplComparisonJson(comparison, pictures));
    return json;
}

void checkPerBounce(const CompareVplArguments& a, const std::vector<Method>& compared) {
    if (!a.perBounce) return;
    for (const Method& method : compared)
        if (!method->knowsBounces())
            throw UsageError(
                fmt::format("--per-bounce: what {} compensates is known only in sum, not by bounce", method->name()));
}

/// Lines have no bias: a reference that is out of balance has too few of them, or loses light.
ExitCode judgeReference(double imbalance) {
    if (std::abs(imbalance) <= kImbalanceTold) return ExitCode::Ok;
    warnLine(fmt::format("{:.1f} % of the reference's light {}: it is no better than that; try fewer --patches, which "
                         "have more lines each, and look for faces that cross or do not meet (lambert info)",
                         100.0 * std::abs(imbalance), imbalance > 0.0 ? "gets lost" : "comes from nowhere"));
    return std::abs(imbalance) > kImbalanceMissed ? ExitCode::TargetMissed : ExitCode::Ok;
}

ExitCode compareVpl(const CompareVplArguments& a) {
    VplComparisonOptions options;
    options.methods = methods(a);
    checkPerBounce(a, options.methods);
    options.perBounce = a.perBounce.has_value();
    checkWhole(a.vpls, "--vpls");
    for (const double vpls : a.ladder) checkWhole(vpls, "--ladder");
    options.effort = a.vpls;
    if (!a.ladder.empty()) options.ladder = a.ladder;
    options.seeds = a.seeds;
    options.seed = a.run.seed;
    MeshOptions mesh = meshOptions(a.transport);
    mesh.refinement *= kCoarser;
    checkPicture(a.picture);
    checkPageFolder(a.output, std::array{a.run.json}, inputFiles(a.scene));
    requireGnuplot();

    setThreadCount(a.run.threads);
    TerminalProgress progress(a.run.quiet);
    const Stopwatch watch;
    const ReadResult read = readScene(a.scene, &progress);
    logReport(a.run, read.report);
    const MeshedScene scene = meshLitScene(read.scene, mesh, progress);
    const Picture shot = picture(a.picture, *scene.scene, *scene.rays);
    logLine(a.run, fmt::format("{}: {} polygons, {} patches", a.scene.path.string(), read.scene.polygons.size(),
                               scene.mesh.size()));
    options.onStage = [&](const std::string& what) { progress.setTitle(what); };
    options.gathering.seed = a.run.seed;
    const Stopwatch referenceWatch;
    const RadiosityReference reference(
        scene, {.mesh = mesh, .bounces = a.perBounce.value_or(0), .seed = a.run.seed, .onStage = options.onStage},
        progress);
    const double referenceSeconds = referenceWatch.seconds();
    VplComparison comparison = compareVpl(scene, reference, options, progress);
    comparison.referenceSeconds = referenceSeconds;

    PictureOptions pictureOptions;
    pictureOptions.camera = shot.camera;
    pictureOptions.size = shot.size;
    pictureOptions.gathering.seed = a.run.seed;
    const VplPictures pictures = comparePictures(scene, reference, options, pictureOptions, progress);

    progress.setTitle("page");
    const nlohmann::ordered_json json = report(a, read.report, scene, comparison, pictures, watch.seconds());
    std::vector<FileContent> page =
        vplPage({a.scene.path.filename().string(),
                 scene,
                 comparison,
                 pictures,
                 {{"Seeds", fmt::format("{} each, from {}", a.seeds, a.run.seed)}, {"Lambert", versionText()}}},
                progress);
    writePageFolder(a.run, a.output, std::move(page), vplComparisonCsv(comparison, a.run.seed), json, progress);
    if (!a.run.json.empty()) writeJson(json, a.run.json);
    fmt::print("{}", vplComparisonText(comparison));
    return judgeReference(reference.imbalance());
}

} // namespace

void addCompareVpl(CLI::App& compare, CommandRun& run) {
    auto arguments = std::make_shared<CompareVplArguments>();
    CompareVplArguments& a = *arguments;
    CLI::App& command = *compare.add_subcommand(
        "vpl", "Methods by virtual point lights: their error against patch radiosity, and what it is made of");
    addSceneArguments(command, a.scene);
    command.option_defaults()->group("Comparison");
    command.add_option("-o,--output", a.output, "Folder for index.html, results.json, results.csv and pictures")
        ->required()
        ->type_name("DIR");
    command
        .add_option("--methods", a.methods, fmt::format("all, or some of {} [all]", fmt::join(vplMethodNames(), ",")))
        ->type_name("A,B,…");
    addNumber(command, "--vpls", a.vpls, "Particles of the anatomy and the pictures, 1 to 16777216 [1024]", "N", 1.0,
              kMostVpls);
    addNumber(command, "--ladder", a.ladder, "Further numbers of particles [N/16 N/4 4N 16N]", "N,N,…", 1.0, kMostVpls)
        ->delimiter(',');
    addNumber(command, "--seeds", a.seeds, "Runs of each method and number, 3 to 1000 [16]", "K", 3.0, 1000.0);
    addNumber(command, "--per-bounce", a.perBounce,
              "Also the errors of light that was reflected 0, 1, ... K times, each by itself; 0 to 16", "K", 0.0, 16.0);
    command.option_defaults()->group("Method");
    command.add_option("--walk", a.walk, "How particles end: quasi, roulette or fixed [quasi]")
        ->check(CLI::IsMember({"quasi", "roulette", "fixed"}));
    addNumber(command, "--vpl-bounces", a.bounces, "Of fixed walks, 0 to 126 [4]", "K", 0.0, 126.0);
    command
        .add_option("--clamp", a.clamp, "Bound of the geometric term, in units of 6 / area of the scene; or none [10]")
        ->type_name("G|none");
    command
        .add_option("--visibility", a.visibility,
                    "Of reflected light: exact, by shadow rays, or none, to see what leaving it out costs [exact]")
        ->check(CLI::IsMember({"exact", "none"}));
    command.add_flag("--compensate", a.compensate, "Recovers what the bound takes away (Kollig, Keller 2004)");
    addMeshArguments(command, a.transport, "theirs and a twentieth or 1000 more");
    addCameraArguments(command, a.picture);
    addRunArguments(command, a.run);
    command.callback([arguments, &run] { run = [arguments] { return compareVpl(*arguments); }; });
}

} // namespace lambert
