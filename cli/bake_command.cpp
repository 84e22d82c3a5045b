#include "cli/arguments.h"
#include "cli/bake_report.h"
#include "cli/commands.h"
#include "cli/interrupt.h"
#include "cli/targets.h"
#include "cli/terminal_progress.h"
#include "cli/terminal_text.h"

#include "baking/exposure.h"
#include "core/stopwatch.h"
#include "rendering/render.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <memory>
#include <optional>

namespace lambert {

namespace {

struct BakeArguments {
    SceneArguments scene;
    TransportArguments transport;
    RunArguments run;
    PictureArguments picture;
    std::vector<std::filesystem::path> outputs;
    std::string format;
    std::string reconstruction = "average";
    std::string quantity = "radiosity";
    std::string exposure = "auto";
};

struct Output {
    std::filesystem::path path;
    BakedFormat format;
};

std::vector<Output> outputs(const BakeArguments& a) {
    std::vector<Output> result;
    for (const auto& path : a.outputs) {
        const auto format = formatOf(a.format.empty() ? path : std::filesystem::path("x." + a.format));
        if (!format)
            throw UsageError(fmt::format(
                "-o: found \"{}\", allowed are names ending in .glb, .gltf, .ply or .obj, or --format", path.string()));
        result.push_back({path, *format});
    }
    return result;
}

/// Everything that will be written: an OBJ comes with an MTL.
std::vector<std::filesystem::path> targetFiles(const BakeArguments& a, const std::vector<Output>& outputs) {
    std::vector<std::filesystem::path> files;
    for (const Output& output : outputs) {
        files.push_back(output.path);
        if (output.format == BakedFormat::Obj)
            files.push_back(std::filesystem::path(output.path).replace_extension(".mtl"));
    }
    for (const auto& path : {a.picture.path, a.run.json})
        if (!path.empty()) files.push_back(path);
    if (files.empty()) throw UsageError("nothing to write: give -o FILE, --image FILE or --json FILE");
    return files;
}

Quantity quantityOf(const BakeArguments& a) {
    return a.quantity == "irradiance" ? Quantity::Irradiance : Quantity::Radiosity;
}

/// The EV that was typed, none for auto. Throws UsageError.
std::optional<float> typedExposure(const std::string& text) {
    if (text == "auto") return std::nullopt;
    float value = 0.0F;
    const char* const begin = text.data() + (text.starts_with('+') ? 1 : 0);
    const auto [end, error] = std::from_chars(begin, text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(value) || std::abs(value) > 100.0F)
        throw UsageError(fmt::format("--exposure: found \"{}\", allowed are auto or an EV from -100 to 100", text));
    return value;
}

Image renderPicture(const BakeArguments& a, const BakedScene& baked, const Picture& shot, float exposure,
                    Progress& progress) {
    RenderOptions options;
    options.width = shot.width;
    options.height = shot.height;
    options.samplesPerAxis = shot.samples;
    options.quantity = quantityOf(a);
    if (imageFormatOf(shot.path) == ImageFormat::Png) options.toneMapExposure = exposure;
    return renderBaked(baked.mesh, baked.baked, *baked.rays, shot.camera, options, progress);
}

void printSummary(const BakedScene& baked, float exposure, double seconds) {
    fmt::print("{:<20} {:>10} {:>11} {:>11} {:>11}   mean irradiance (r g b)\n", "material", "area m²", "", "", "");
    for (const MaterialLight& light : materialLight(baked))
        fmt::print("{:<20} {:>10.4g} {:>11.5g} {:>11.5g} {:>11.5g}\n", oneLine(light.name), light.area,
                   light.meanIrradiance.x, light.meanIrradiance.y, light.meanIrradiance.z);
    fmt::print("{} patches, {} bounces, residual {:.2g}, energy imbalance {:.2g}, exposure {:.2f} EV, {:.1f} s\n",
               baked.mesh.size(), baked.solution.iterations, baked.solution.residual, baked.solution.energy.imbalance(),
               exposure, seconds);
}

ExitCode bake(const BakeArguments& a) {
    const Stopwatch total;
    const std::vector<Output> targets = outputs(a);
    const std::optional<float> typed = typedExposure(a.exposure);
    checkPicture(a.picture);
    const BakeOptions options = bakeOptions(a.transport, a.run);
    const std::vector<std::filesystem::path> files = targetFiles(a, targets);
    checkTargets(files, filesOfScene(a.scene.path));
    applyThreads(a.run);
    TerminalProgress progress(a.run.quiet);
    const InterruptGuard interrupt(progress);

    const Stopwatch reading;
    ReadResult read = readScene(a.scene, &progress);
    const double readSeconds = reading.seconds();
    for (const std::string& warning : read.report.warnings) warnLine(oneLine(warning));
    checkCamera(a.picture, read.scene);
    progress.throwIfCancelled();
    logLine(a.run, fmt::format("{}: {} polygons, {} materials", a.scene.path.string(), read.scene.polygons.size(),
                               read.scene.materials.size()));

    const BakedScene baked = bakeScene(read.scene, options, progress);
    for (const std::string& warning : baked.warnings) warnLine(oneLine(warning));
    logLine(a.run, fmt::format("{} patches, hemicubes {}: {:.3g} rays in {:.1f} s, {} bounces to {:.1e}",
                               baked.mesh.size(), baked.resolution, static_cast<double>(baked.rayCount),
                               baked.seconds.formFactors, baked.solution.iterations, baked.solution.residual));

    const float exposure = typed ? *typed : automaticExposure(baked.baked, quantityOf(a));
    const Stopwatch writing;
    for (const Output& target : targets)
        writeBaked(baked.baked, target.path, target.format, {quantityOf(a), exposure, LAMBERT_VERSION});
    std::optional<Picture> shot;
    if (!a.picture.path.empty()) {
        shot = picture(a.picture, *baked.scene, *baked.rays);
        writeImage(renderPicture(a, baked, *shot, exposure, progress), shot->path, exposure);
    }
    const double writeSeconds = writing.seconds();
    if (!a.run.json.empty())
        writeJson(bakeReport({baked, read.report, a.scene, a.transport, a.run, shot, static_cast<double>(exposure),
                              readSeconds, writeSeconds, total.seconds()}),
                  a.run.json);
    if (!a.run.quiet) printSummary(baked, exposure, total.seconds());
    if (baked.solution.residual > options.jacobi.tolerance && options.jacobi.bounces == 0) {
        warnLine(fmt::format("residual {:.2g} is above --tolerance {:.2g}", baked.solution.residual,
                             options.jacobi.tolerance));
        return ExitCode::TargetMissed;
    }
    return ExitCode::Ok;
}

} // namespace

void addBakeCommand(CLI::App& program, CommandRun& run) {
    auto arguments = std::make_shared<BakeArguments>();
    CLI::App& command = *program.add_subcommand("bake", "Bakes the light of a scene into vertex colours");
    addSceneArguments(command, arguments->scene);
    command.add_option("-o,--output", arguments->outputs, "Baked scene; may be given several times")
        ->type_name("FILE")
        ->allow_extra_args(false)
        ->group("Bake");
    command.add_option("--format", arguments->format, "glb, gltf, ply or obj [by the name's end]")
        ->check(CLI::IsMember({"glb", "gltf", "ply", "obj"}))
        ->group("Bake");
    command.add_option("--reconstruction", arguments->reconstruction, "Of light at the vertices [average]")
        ->check(CLI::IsMember({"average"}))
        ->group("Bake");
    command.add_option("--quantity", arguments->quantity, "What the colours show: radiosity or irradiance [radiosity]")
        ->check(CLI::IsMember({"radiosity", "irradiance"}))
        ->group("Bake");
    command
        .add_option("--exposure", arguments->exposure,
                    "EV, display = value · 2^EV; auto: 99 % of all is below 0.9 [auto]")
        ->type_name("EV")
        ->group("Bake");
    addTransportArguments(command, arguments->transport);
    addPictureArguments(command, arguments->picture);
    addRunArguments(command, arguments->run);
    command.callback([arguments, &run] { run = [arguments] { return bake(*arguments); }; });
}

} // namespace lambert
