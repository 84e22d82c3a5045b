#include "cli/compare_bakes.h"

#include "cli/arguments.h"
#include "cli/bake_report.h"
#include "cli/interrupt.h"
#include "cli/targets.h"
#include "cli/terminal_progress.h"
#include "cli/terminal_text.h"

#include "comparison/compare_bakes.h"
#include "comparison/patch_picture.h"
#include "comparison/scale_bar.h"

#include <fmt/format.h>

#include <array>
#include <memory>

namespace lambert {

namespace fs = std::filesystem;

namespace {

constexpr int kDecades = 4; ///< of the picture's scale at most

struct CompareBakesArguments {
    fs::path reference, other;
    std::string quantity = "irradiance";
    PictureArguments picture;
    RunArguments run;
};

using Json = nlohmann::ordered_json;

struct Column {
    const char* title;
    const char* key;
    double FieldErrors::*value;
};

constexpr std::array kColumns{Column{"mean of A", "mean", &FieldErrors::mean},
                              Column{"bias", "bias", &FieldErrors::bias},
                              Column{"mean abs", "mean_absolute", &FieldErrors::meanAbsolute},
                              Column{"RMS", "rms", &FieldErrors::rms},
                              Column{"rel. RMS", "relative_rms", &FieldErrors::relativeRms},
                              Column{"99 %", "percentile_99", &FieldErrors::percentile99},
                              Column{"maximum", "maximum", &FieldErrors::maximum},
                              Column{"energy B/A", "energy_ratio", &FieldErrors::energyRatio}};

constexpr std::array<const char*, 3> kChannels{"red", "green", "blue"};

Json errorsJson(const FieldErrors& errors) {
    Json json;
    for (const Column& column : kColumns) json[column.key] = errors.*column.value;
    return json;
}

std::string errorsText(const char* name, const FieldErrors& errors) {
    std::string text = fmt::format("{:<8}", name);
    for (const Column& column : kColumns) text += fmt::format(" {:>11.5g}", errors.*column.value);
    return text + "\n";
}

std::string tableOf(const BakeComparison& comparison) {
    std::string text = fmt::format("{:<8}", "");
    for (const Column& column : kColumns) text += fmt::format(" {:>11}", column.title);
    text += "\n" + errorsText("mean", comparison.overall);
    for (std::size_t c = 0; c < 3; ++c) text += errorsText(kChannels[c], comparison.channels[c]);
    return text;
}

Json originJson(const fs::path& file, const StoredSolution& solution) {
    return {{"file", file.string()},
            {"scene", solution.origin.scene},
            {"method", solution.origin.method},
            {"solver", solution.origin.solver},
            {"patches", solution.meshed.mesh.size()}};
}

Json reportOf(const CompareBakesArguments& a, const StoredSolution& reference, const StoredSolution& other,
              const BakeComparison& comparison) {
    Json channels = Json::object();
    for (std::size_t c = 0; c < 3; ++c) channels[kChannels[c]] = errorsJson(comparison.channels[c]);
    return {{"a", originJson(a.reference, reference)},
            {"b", originJson(a.other, other)},
            {"quantity", a.quantity},
            {"same_patches", comparison.samePatches},
            {"unmatched_area", comparison.unmatchedArea},
            {"overall", errorsJson(comparison.overall)},
            {"channels", channels},
            {"version", LAMBERT_VERSION}};
}

void writePicture(const CompareBakesArguments& a, const StoredSolution& reference, const BakeComparison& comparison,
                  Progress& progress) {
    if (reference.meshed.scene->polygons.empty())
        throw InputError(fmt::format("{}: no patch has any size: there is nothing to show", a.reference.string()));
    const RayCaster rays(*reference.meshed.scene);
    const Picture shot = picture(a.picture, *reference.meshed.scene, rays);
    const ColourScale scale(comparison.difference, kDecades);
    const Image image = patchPicture(reference.meshed.mesh, rays, comparison.difference, scale, shot.camera,
                                     {shot.width, shot.height, shot.samples}, progress);
    writeImage(withScaleBar(image, scale), shot.path, 0.0F);
}

ExitCode compareBakes(const CompareBakesArguments& a) {
    checkPicture(a.picture);
    checkTargets(std::array{a.picture.path, a.run.json}, std::array{a.reference, a.other});
    applyThreads(a.run);
    TerminalProgress progress(a.run.quiet);
    const InterruptGuard interrupt(progress);
    const StoredSolution reference = readSolution(a.reference);
    const StoredSolution other = readSolution(a.other);
    const BakeComparison comparison =
        compareBakes(reference, other, a.quantity == "radiosity" ? Quantity::Radiosity : Quantity::Irradiance);
    if (!comparison.samePatches)
        logLine(a.run, oneLine(fmt::format("the patches differ: B is looked up at the centres of A's ({:.2g} % of the "
                                           "area without counterpart)",
                                           100.0 * comparison.unmatchedArea)));
    if (!a.picture.path.empty()) writePicture(a, reference, comparison, progress);
    if (!a.run.json.empty()) writeJson(reportOf(a, reference, other, comparison), a.run.json);
    fmt::print("{}", tableOf(comparison));
    return ExitCode::Ok;
}

} // namespace

void addCompareBakes(CLI::App& compare, CommandRun& run) {
    auto arguments = std::make_shared<CompareBakesArguments>();
    CompareBakesArguments& a = *arguments;
    CLI::App& command =
        *compare.add_subcommand("bakes", "Two solutions of the same scene: how far the light of B is from that of A");
    command.add_option("A", a.reference, "The reference: a file by bake --solution")->required()->type_name("FILE");
    command.add_option("B", a.other, "Another, of the same patches or of others")->required()->type_name("FILE");
    command.add_option("--quantity", a.quantity, "What is compared: radiosity or irradiance [irradiance]")
        ->check(CLI::IsMember({"radiosity", "irradiance"}))
        ->group("Comparison");
    addPictureArguments(command, a.picture);
    addRunArguments(command, a.run);
    command.callback([arguments, &run] { run = [arguments] { return compareBakes(*arguments); }; });
}

} // namespace lambert
