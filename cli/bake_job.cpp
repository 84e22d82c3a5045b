#include "cli/bake_job.h"
#include "cli/bake_report.h"
#include "cli/bake_verdict.h"
#include "cli/light_files.h"
#include "cli/overlap_text.h"
#include "cli/scene_files.h"
#include "cli/terminal_text.h"

#include "baking/exposure.h"
#include "core/process.h"
#include "core/stopwatch.h"
#include "prediction/measured_costs.h"
#include "prediction/prediction.h"
#include "scene/words.h"
#include "solver/solution_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>

namespace lambert {

namespace fs = std::filesystem;

namespace {

Quantity quantityOf(const BakeArguments& a) {
    return a.quantity == "irradiance" ? Quantity::Irradiance : Quantity::Radiosity;
}

/// The EV that was typed, none for auto. Throws UsageError.
std::optional<float> typedExposure(const std::string& text) {
    if (text == "auto") return std::nullopt;
    const auto value = parseNumber(text);
    if (!value || !(std::abs(*value) <= 100.0))
        throw UsageError(fmt::format("--exposure: found \"{}\", allowed are auto or an EV from -100 to 100", text));
    return static_cast<float>(*value);
}

Image renderPicture(const BakedScene& baked, const Picture& shot, const BakeOutputOptions& output, Progress& progress) {
    RenderOptions options{shot.size};
    options.quantity = output.quantity;
    if (imageFormatOf(shot.path) == ImageFormat::Png) options.toneMapExposure = output.exposure;
    return renderBaked(baked.mesh, baked.baked, *baked.rays, shot.camera, options, progress);
}

bool allBlack(const std::vector<Rgb>& light) {
    return std::ranges::all_of(light, [](const Rgb& value) { return value == Rgb(0.0F); });
}

std::string solverText(const SolvedScene& solved) {
    if (const InstantRadiosity* lights = solved.instantRadiosity())
        return fmt::format("{} virtual point lights, {:.3g} rays", lights->lights,
                           static_cast<double>(solved.rayCount));
    if (const StochasticSolution* lines = solved.stochastic())
        return fmt::format("{:.3g} rays in {} runs, standard error {:.2g} %", static_cast<double>(lines->rays),
                           lines->subRuns, 100.0 * lines->relativeError);
    return fmt::format("{} iterations, residual {:.2g}", solved.solution.iterations, solved.solution.residual);
}

/// Which form factors, and how many rays they took.
std::string transportText(const LightMethod& method, const SolvedScene& solved) {
    if (std::holds_alternative<std::monostate>(solved.account)) return "no light to follow";
    const FormFactorsUsed* const used = solved.formFactors();
    if (solved.instantRadiosity() != nullptr) return methodName(method, solved);
    if (used == nullptr) return methodName(method, solved) + "; " + solverName(method);
    return fmt::format("{}: {:.3g} rays; {}",
                       used->plan ? used->plan->effort()
                                  : "form factors from " + std::get<FormFactorLight>(method).formFactors.file.string(),
                       static_cast<double>(solved.rayCount), solverName(method));
}

std::string summaryOf(const BakedScene& baked, float exposure, double seconds) {
    std::string text = fmt::format("{:<20} {:>10} {:>11} {:>11} {:>11}   mean irradiance (r g b)\n", "material",
                                   "area m²", "", "", "");
    for (const MaterialLight& light : materialLight(baked))
        text += fmt::format("{:<20} {:>10.4g} {:>11.5g} {:>11.5g} {:>11.5g}\n", printable(light.name), light.area,
                            light.meanIrradiance.x, light.meanIrradiance.y, light.meanIrradiance.z);
    return text + fmt::format("{} patches, {}, {}, exposure {:.2f} EV, {:.1f} s\n", baked.mesh.size(),
                              solverText(baked), imbalanceText(baked), exposure, seconds);
}

SolutionRecord solutionOf(const LightMethod& method, const BakeJob& job, const SolvedScene& solved) {
    const StochasticSolution* const lines = solved.stochastic();
    return {*solved.scene,
            solved.mesh,
            solved.optics,
            solved.solution,
            lines != nullptr ? std::span<const Rgb>(lines->standardError) : std::span<const Rgb>(),
            {job.scene.string(), methodName(method, solved), solverName(method)},
            LAMBERT_VERSION};
}

PictureArguments pictureArguments(const BakeArguments& a, const BakeJob& job) {
    PictureArguments result = a.picture;
    result.path = job.image;
    return result;
}

ReadResult readJob(const BakeArguments& a, const BakeJob& job, SceneLog& log, Progress& progress) {
    ReadResult read = readScene(sceneOf(a, job), &progress);
    if (!read.report.overrides.file.empty())
        log.line(fmt::format("{}: changes the scene (--no-overrides ignores it)", read.report.overrides.file.string()));
    for (const std::string& warning : read.report.warnings) log.warning(warning);
    addDaylight(read.scene, a.transport.light);
    checkCamera(pictureArguments(a, job), read.scene);
    progress.throwIfCancelled();
    log.line(fmt::format("{} polygons, {} materials", read.scene.polygons.size(), read.scene.materials.size()));
    return read;
}

} // namespace

SceneArguments sceneOf(const BakeArguments& a, const BakeJob& job) {
    SceneArguments result = a.scene;
    result.path = job.scene;
    return result;
}

std::vector<fs::path> resultFiles(const BakeJob& job) {
    std::vector<fs::path> files;
    for (const BakeJob::Output& output : job.outputs) {
        files.push_back(output.path);
        if (output.format == BakedFormat::Obj) files.push_back(fs::path(output.path).replace_extension(".mtl"));
    }
    for (const fs::path& file : {job.image, job.solution})
        if (!file.empty()) files.push_back(file);
    return files;
}

std::vector<fs::path> filesRead(const BakeArguments& a, const BakeJob& job) {
    std::vector<fs::path> files = inputFiles(sceneOf(a, job));
    addTransportInputs(a.transport, files);
    return files;
}

bool isUpToDate(const BakeArguments& a, const BakeJob& job) {
    std::error_code error;
    std::optional<fs::file_time_type> oldest;
    for (const fs::path& file : resultFiles(job)) {
        const fs::file_time_type time = fs::last_write_time(file, error);
        if (error || !fs::is_regular_file(file, error)) return false;
        oldest = oldest ? std::min(*oldest, time) : time;
    }
    if (!oldest) return false;
    const std::vector<fs::path> inputs = filesRead(a, job);
    return std::none_of(inputs.begin(), inputs.end(), [&](const fs::path& input) {
        const fs::file_time_type time = fs::last_write_time(input, error);
        return !error && time > *oldest;
    });
}

BakePlan planOf(const BakeArguments& a) {
    BakePlan plan;
    plan.exposure = typedExposure(a.exposure);
    checkPicture(a.picture);
    if (!a.solution.empty()) requireSolutionName(a.solution, "--solution");
    plan.options = {solveOptions(a.transport, a.run), reconstructionOptions(a.transport), std::nullopt, a.perLight};
    if (a.reconstruction == "gather")
        plan.options.gather = gatherOptions(a.transport, a.run);
    else if (a.transport.gatherError)
        throw UsageError("--gather-error: means nothing without --reconstruction gather");
    plan.output = {quantityOf(a), plan.exposure.value_or(0.0F), LAMBERT_VERSION};
    if (a.perLight && usesVirtualLights(a.transport))
        throw UsageError(fmt::format("--per-light: is not possible with --method {}", kInstantRadiosity));
    if (a.perLight && a.skipExisting)
        throw UsageError("--per-light: which files it writes is known only once a scene is read; not with "
                         "--skip-existing");
    return plan;
}

BakeOutcome bakeJob(const BakeArguments& a, const BakePlan& plan, const BakeJob& job, SceneLog& log,
                    Progress& progress) {
    const Stopwatch total;
    const SolveOptions& options = plan.options.solve;
    const ReadResult read = readJob(a, job, log, progress);
    const double readSeconds = total.seconds();

    BakedScene baked = bakeScene(read.scene, plan.options, progress);
    const std::string overlaps = overlapText(*baked.scene, baked.prepareReport.cover);
    const bool cut = baked.prepareReport.cover.takenAway;
    if (!overlaps.empty() && !cut) baked.warnings.push_back(overlaps);
    for (const std::string& warning : baked.warnings) log.warning(warning);
    if (!overlaps.empty() && cut) log.line(overlaps);
    const std::size_t near = baked.meshReport.nearContactPatches;
    log.line(fmt::format("{} patches{}, {}: {}", baked.mesh.size(),
                         near > 0 ? fmt::format(" ({} for near contacts)", near) : "",
                         transportText(options.method, baked), solverText(baked)),
             fmt::format(", {:.1f} s", total.seconds()));
    if (baked.gather)
        log.line(fmt::format("gathered at {} vertices: {:.3g} rays, standard error {:.2g} %", baked.gather->vertices,
                             static_cast<double>(baked.gather->rays), 100.0 * baked.gather->error));
    if (baked.formFactors() != nullptr && baked.formFactors()->repair)
        log.line(repairText(*baked.formFactors()->repair));

    BakeOutputOptions output = plan.output;
    if (!plan.exposure) output.exposure = automaticExposure(baked.baked, output.quantity);
    const Stopwatch writing;
    for (const BakeJob::Output& target : job.outputs) writeBaked(baked.baked, target.path, target.format, output);
    if (!job.solution.empty()) writeSolution(solutionOf(options.method, job, baked), job.solution);
    const std::vector<WrittenLight> lights = writeLights(baked, job.outputs, output, filesRead(a, job));
    std::optional<Picture> shot;
    std::string pictureWarning;
    if (!job.image.empty()) {
        shot = picture(pictureArguments(a, job), *baked.scene, *baked.rays);
        const Image image = renderPicture(baked, *shot, output, progress);
        const BakedMesh& mesh = baked.baked;
        if (allBlack(image.pixels) &&
            !allBlack(output.quantity == Quantity::Radiosity ? mesh.radiosity : mesh.irradiance)) {
            pictureWarning =
                fmt::format("{}: the picture is black: its camera sees nothing that is lit, only backs, shadow "
                            "or nothing at all; give another with --eye and --look-at",
                            shot->path.string());
            log.warning(pictureWarning);
        }
        writeImage(image, shot->path, output.exposure);
    }

    BakeOutcome outcome;
    const double writeSeconds = writing.seconds();
    outcome.seconds = total.seconds();
    outcome.report = bakeReport({baked, options, read.report, sceneOf(a, job), a.transport, a.run, readSeconds,
                                 writeSeconds, outcome.seconds, &baked, shot, static_cast<double>(output.exposure)});
    if (!pictureWarning.empty()) outcome.report["warnings"].push_back(pictureWarning);
    if (a.perLight) outcome.report["lights"] = lightsJson(lights);
    outcome.summary = summaryOf(baked, output.exposure, outcome.seconds);
    outcome.patches = baked.mesh.size();
    outcome.rays = baked.rayCount;
    outcome.peakMemory = peakMemoryBytes();
    outcome.imbalance = worseImbalance(baked);
    removeCheckpoints(baked);
    log.line(fmt::format("{}, exposure {:.2f} EV", imbalanceText(baked), output.exposure));
    const BakeVerdict verdict = judge(options.method, baked);
    for (const std::string& warning : verdict.warnings) log.warning(warning);
    outcome.report["warnings"] = log.warnings();
    outcome.exitCode = verdict.exitCode;
    return outcome;
}

BakeOutcome predictJob(const BakeArguments& a, const BakePlan& plan, const BakeJob& job, SceneLog& log,
                       Progress& progress) {
    const Stopwatch reading;
    const ReadResult read = readJob(a, job, log, progress);
    const double readSeconds = reading.seconds();
    const LightMethod& method = plan.options.solve.method;
    const BakePrediction predicted = predictBake(read.scene, plan.options.solve, progress);

    double writeSeconds =
        kWriteSeconds * static_cast<double>(predicted.patches) * static_cast<double>(job.outputs.size());
    writeSeconds += kPictureRay * predicted.secondsPerRay * pictureRays(pictureArguments(a, job));
    const SolveSeconds& s = predicted.seconds;
    BakeOutcome outcome;
    outcome.patches = predicted.patches;
    outcome.rays = predicted.rays;
    outcome.seconds =
        readSeconds + s.mesh + s.formFactors + s.directLight + s.solve + predicted.bakeSeconds + writeSeconds;
    outcome.peakMemory = predicted.peakMemory;
    outcome.report = {{"scene", job.scene.string()},
                      {"patches", predicted.patches},
                      {"rays", predicted.rays},
                      {"peak_memory_bytes", predicted.peakMemory},
                      {"options", methodOptionsJson(method, predicted.plan)},
                      {"form_factors", {{"bytes", predicted.matrixBytes}}},
                      {"seconds",
                       {{"read", readSeconds},
                        {"mesh", s.mesh},
                        {"form_factors", s.formFactors},
                        {"direct_light", s.directLight},
                        {"solve", s.solve},
                        {"bake", predicted.bakeSeconds},
                        {"write", writeSeconds},
                        {"total", outcome.seconds}}},
                      {"warnings", read.report.warnings}};
    return outcome;
}

} // namespace lambert
