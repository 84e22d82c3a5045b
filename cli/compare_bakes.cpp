#include "cli/arguments.h"
#include "cli/bake_report.h"
#include "cli/commands.h"
#include "cli/compare_folder.h"
#include "cli/targets.h"
#include "cli/terminal_progress.h"

#include "comparison/bake_comparison_report.h"
#include "comparison/bake_page.h"
#include "comparison/page/scale_bar.h"
#include "core/parallel.h"

#include <fmt/format.h>

#include <array>
#include <memory>

namespace lambert {

namespace fs = std::filesystem;

namespace {

struct CompareBakesArguments {
    fs::path reference, other;
    std::string quantity = "irradiance";
    PictureArguments picture;
    RunArguments run;
    fs::path output; //!< a folder; empty: none
};

using Json = nlohmann::ordered_json;

Json originJson(const fs::path& file, const StoredSolution& solution) {
    return {{"file", file.string()},
            {"scene", solution.origin.scene},
            {"method", solution.origin.method},
            {"solver", solution.origin.solver},
            {"patches", solution.meshed.mesh.size()}};
}

Json reportOf(const CompareBakesArguments& a, const StoredSolution& reference, const StoredSolution& other,
              const BakeComparison& comparison) {
    Json json = {
        {"a", originJson(a.reference, reference)}, {"b", originJson(a.other, other)}, {"quantity", a.quantity}};
    json.update(bakeComparisonJson(comparison));
    json["version"] = LAMBERT_VERSION;
    return json;
}

Quantity quantityOf(const CompareBakesArguments& a) {
    return a.quantity == "radiosity" ? Quantity::Radiosity : Quantity::Irradiance;
}

/// The picture and the folder, where they are wanted.
void show(const CompareBakesArguments& a, const StoredSolution& reference, const StoredSolution& other,
          const BakeComparison& comparison, Progress& progress) {
    if (a.picture.path.empty() && a.output.empty()) return;
    if (reference.meshed.scene->polygons.empty())
        throw InputError(fmt::format("{}: no patch has any size: there is nothing to show", a.reference.string()));
    const RayCaster rays(*reference.meshed.scene);
    const Picture shot = picture(a.picture, *reference.meshed.scene, rays);
    if (!a.output.empty()) {
        std::vector<FileContent> page = bakePage({a.reference.filename().string(),
                                                  a.other.filename().string(),
                                                  reference,
                                                  other,
                                                  quantityOf(a),
                                                  comparison,
                                                  {{"Lambert", fmt::format("version {}", LAMBERT_VERSION)}},
                                                  rays,
                                                  shot.camera,
                                                  shot.size},
                                                 progress);
        writePageFolder(a.run, a.output, std::move(page), bakeComparisonCsv(comparison),
                        reportOf(a, reference, other, comparison), progress);
    }
    if (!a.picture.path.empty()) {
        const DifferencePicture found =
            differencePicture(reference, comparison, rays, shot.camera, shot.size, progress);
        writeImage(withScaleBar(found.image, found.scale), shot.path, 0.0F);
    }
}

ExitCode compareBakes(const CompareBakesArguments& a) {
    PictureArguments pictures = a.picture;
    if (pictures.path.empty() && !a.output.empty()) pictures.path = a.output / "difference.png";
    checkPicture(pictures);
    const std::array inputs{a.reference, a.other};
    const std::array others{a.picture.path, a.run.json};
    if (a.output.empty())
        checkTargets(others, inputs);
    else
        checkPageFolder(a.output, others, inputs);
    setThreadCount(a.run.threads);
    TerminalProgress progress(a.run.quiet);
    const StoredSolution reference = readSolution(a.reference);
    const StoredSolution other = readSolution(a.other);
    const BakeComparison comparison = compareBakes(reference, other, quantityOf(a));
    if (!comparison.samePatches)
        logLine(a.run, fmt::format("the patches differ: B is looked up at the centres of A's ({:.2g} % of the "
                                   "area without counterpart)",
                                   100.0 * comparison.unmatchedArea));
    show(a, reference, other, comparison, progress);
    if (!a.run.json.empty()) writeJson(reportOf(a, reference, other, comparison), a.run.json);
    fmt::print("{}", bakeComparisonText(comparison));
    return ExitCode::Ok;
}

} // namespace

void addCompareBakes(CLI::App& compare, CommandRun& run) {
    auto arguments = std::make_shared<CompareBakesArguments>();
    CompareBakesArguments& a = *arguments;
    CLI::App& command =
        *compare.add_subcommand("bakes", "Two solutions of the same scene: how far the light of B is from that of A");
    command.option_defaults()->group("Comparison");
    command.add_option("A", a.reference, "The reference: a file by bake --solution")->required()->type_name("FILE");
    command.add_option("B", a.other, "Another, of the same patches or of others")->required()->type_name("FILE");
    command
        .add_option("-o,--output", a.output,
                    "Folder for index.html, results.json, results.csv and pictures of the difference")
        ->type_name("DIR");
    command.add_option("--quantity", a.quantity, "What is compared: radiosity or irradiance [irradiance]")
        ->check(CLI::IsMember({"radiosity", "irradiance"}));
    addPictureArguments(command, a.picture);
    addRunArguments(command, a.run);
    command.callback([arguments, &run] { run = [arguments] { return compareBakes(*arguments); }; });
}

} // namespace lambert
