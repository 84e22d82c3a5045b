#include "cli/arguments.h"
#include "cli/bake_report.h"
#include "cli/commands.h"
#include "cli/compare_folder.h"
#include "cli/scene_files.h"
#include "cli/terminal_progress.h"
#include "cli/validators.h"

#include "comparison/form_factor_page.h"
#include "comparison/form_factor_report.h"
#include "comparison/page/gnuplot.h"
#include "core/parallel.h"
#include "core/stopwatch.h"
#include "core/whole_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>

namespace lambert {

namespace fs = std::filesystem;

namespace {

struct CompareFormFactorsArguments {
    SceneArguments scene;
    TransportArguments transport; //!< of which only the mesh
    PictureArguments picture;     //!< of which only size and camera
    RunArguments run;
    fs::path output;
    std::string methods = "all";
    std::vector<std::string> efforts; //!< METHOD=E,E,…
    std::string reference = "auto";
    int seeds = 5;
    std::optional<double> threshold;
};

using Ladder = FormFactorComparisonOptions::Ladder;

std::vector<Ladder> ladders(const CompareFormFactorsArguments& a) {
    std::vector<Ladder> result;
    const auto add = [&](const ComparedMethod& method) {
        if (std::any_of(result.begin(), result.end(), [&](const Ladder& l) { return l.method == &method; }))
            throw UsageError(fmt::format("--methods: {} is named twice", method.name));
        result.push_back({&method, method.ladder});
    };
    if (a.methods == "all")
        for (const ComparedMethod& method : comparedMethods()) add(method);
    else
        for (const std::string& name : separated(a.methods)) add(comparedMethod(name));
    for (const std::string& text : a.efforts) {
        const std::size_t equals = text.find('=');
        if (equals == std::string::npos)
            throw UsageError(fmt::format("--efforts: found \"{}\", expected METHOD=EFFORT,EFFORT,…", text));
        const ComparedMethod& method = comparedMethod(text.substr(0, equals));
        const auto ladder =
            std::find_if(result.begin(), result.end(), [&](const Ladder& l) { return l.method == &method; });
        if (ladder == result.end())
            throw UsageError(fmt::format("--efforts: {} is not among the compared methods", method.name));
        ladder->efforts.clear();
        for (const std::string& effort : separated(text.substr(equals + 1)))
            ladder->efforts.push_back(parseEffort(method, effort));
    }
    return result;
}

nlohmann::ordered_json report(const CompareFormFactorsArguments& a, const ReadReport& read, const MeshedScene& scene,
                              const FormFactorComparison& comparison, double seconds) {
    nlohmann::ordered_json json;
    json["scene"] = a.scene.path.string();
    json["patches"] = scene.mesh.size();
    json["options"] = sceneOptionsJson(a.scene, read.overrides);
    json["options"]["patch_length"] = std::isfinite(scene.meshReport.patchLength)
                                          ? nlohmann::ordered_json(scene.meshReport.patchLength)
                                          : nlohmann::ordered_json(nullptr);
    json["options"]["threads"] = threadCount();
    json["seed"] = a.run.seed;
    json["seeds"] = a.seeds;
    json["version"] = LAMBERT_VERSION;
    json["seconds"] = seconds;
    json.update(comparisonJson(comparison));
    return json;
}

ExitCode compareFormFactors(const CompareFormFactorsArguments& a) {
    FormFactorComparisonOptions options;
    options.ladders = ladders(a);
    options.reference = parseReference(a.reference);
    options.seeds = a.seeds;
    options.seed = a.run.seed;
    options.threshold = a.threshold;
    const MeshOptions mesh = meshOptions(a.transport);
    checkPicture(a.picture);
    std::vector<fs::path> inputs = inputFiles(a.scene);
    if (!options.reference.file.empty()) inputs.push_back(options.reference.file);
    checkPageFolder(a.output, std::array{a.run.json}, inputs);
    requireGnuplot();

    setThreadCount(a.run.threads);
    TerminalProgress progress(a.run.quiet);
    const Stopwatch watch;
    const ReadResult read = readScene(a.scene, &progress);
    logReport(a.run, read.report);
    const MeshedScene scene = meshScene(read.scene, mesh, progress);
    const Picture shot = picture(a.picture, *scene.scene, *scene.rays);
    logLine(a.run, fmt::format("{}: {} polygons, {} patches", a.scene.path.string(), read.scene.polygons.size(),
                               scene.mesh.size()));
    options.onRun = [&](const std::string& what) { progress.setTitle(what); };
    const FormFactorComparison comparison = compareFormFactors(scene, options, progress);

    progress.setTitle("page");
    const nlohmann::ordered_json json = report(a, read.report, scene, comparison, watch.seconds());
    std::vector<FileContent> page = formFactorPage(
        {a.scene.path.filename().string(),
         scene,
         comparison,
         {{"Seeds", fmt::format("{} per effort, from {}", a.seeds, a.run.seed)}, {"Lambert", versionText()}},
         shot.camera,
         {shot.size.width, shot.size.height, 3}},
        progress);
    writePageFolder(a.run, a.output, std::move(page), comparisonCsv(comparison, a.run.seed), json, progress);
    if (!a.run.json.empty()) writeJson(json, a.run.json);
    fmt::print("{}", comparisonText(comparison));
    return ExitCode::Ok;
}

void addCompareFormFactors(CLI::App& compare, CommandRun& run) {
    auto arguments = std::make_shared<CompareFormFactorsArguments>();
    CompareFormFactorsArguments& a = *arguments;
    CLI::App& command =
        *compare.add_subcommand("formfactors", "Methods for form factors: error against cost, as a page with plots");
    addSceneArguments(command, a.scene);
    command.option_defaults()->group("Comparison");
    command.add_option("-o,--output", a.output, "Folder for index.html, results.json, results.csv and pictures")
        ->required()
        ->type_name("DIR");
    std::vector<std::string> names;
    for (const ComparedMethod& method : comparedMethods()) names.push_back(method.name);
    command.add_option("--methods", a.methods, fmt::format("all, or some of {} [all]", fmt::join(names, ",")))
        ->type_name("A,B,…");
    command
        .add_option(
            "--efforts", a.efforts,
            "Resolutions or numbers of lines that a method is run with, such as hemicube=32,64; may be repeated")
        ->type_name("METHOD=E,E,…")
        ->allow_extra_args(false);
    command
        .add_option(
            "--reference", a.reference,
            "auto, exact (convex scenes), METHOD:EFFORT or a matrix file; auto: exact, else closed forms [auto]")
        ->type_name("REFERENCE");
    addNumber(command, "--seeds", a.seeds, "Runs of each method and effort, 1 to 1000 [5]", "K", 1.0, 1000.0);
    addNumber(command, "--threshold", a.threshold,
              "Smallest factor that counts in relative errors, 0 to 1 [0.1 / patches]", "F", 0.0, 1.0);
    addMeshArguments(command, a.transport);
    addCameraArguments(command, a.picture);
    addRunArguments(command, a.run);
    command.callback([arguments, &run] { run = [arguments] { return compareFormFactors(*arguments); }; });
}

} // namespace

void addCompareCommand(CLI::App& program, CommandRun& run) {
    CLI::App& compare = *program.add_subcommand("compare", "Methods, or results, against each other");
    compare.require_subcommand(1);
    addCompareFormFactors(compare, run);
    addCompareVpl(compare, run);
    addCompareBakes(compare, run);
}

} // namespace lambert
