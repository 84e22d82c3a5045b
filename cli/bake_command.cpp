#include "cli/bake_job.h"
#include "cli/bake_report.h"
#include "cli/batch.h"
#include "cli/batch_plan.h"
#include "cli/commands.h"
#include "cli/scene_files.h"
#include "cli/targets.h"
#include "cli/terminal_progress.h"

#include "core/parallel.h"

#include <fmt/format.h>

#include <memory>

namespace lambert {

namespace {

BakeJob jobOfOneScene(const BakeArguments& a) {
    BakeJob job;
    job.scene = a.scenes.front();
    job.image = a.picture.path;
    job.solution = a.solution;
    for (const auto& path : a.outputs) {
        const auto format = formatOf(a.format.empty() ? path : std::filesystem::path("x." + a.format));
        if (!format)
            throw UsageError(fmt::format(
                "-o: found \"{}\", allowed are names ending in .glb, .gltf, .ply or .obj, or --format", path.string()));
        job.outputs.push_back({path, *format});
    }
    return job;
}

ExitCode bakeOneScene(const BakeArguments& a, const BakePlan& plan) {
    const BakeJob job = jobOfOneScene(a);
    if (a.dryRun || a.skipExisting) return runBatch(a, plan, {job}, false);
    std::vector<std::filesystem::path> targets = resultFiles(job);
    const auto& rows = a.transport.checkpoint;
    for (const auto& target : {a.run.json, rows, solverCheckpointPath(rows)}) targets.push_back(target);
    checkTargets(targets, filesRead(a, job));
    setThreadCount(a.run.threads);
    TerminalProgress progress(a.run.quiet);
    SceneLog log(a.run.quiet, "", job.scene.string());
    const BakeOutcome outcome = bakeJob(a, plan, job, log, progress);
    if (!a.run.json.empty()) writeJson(outcome.report, a.run.json);
    if (!a.run.quiet) fmt::print("{}", outcome.summary);
    return outcome.exitCode;
}

ExitCode bake(const BakeArguments& a) {
    const BakePlan plan = planOf(a);
    if (a.outputs.empty() && a.outputDir.empty() && a.picture.path.empty() && a.solution.empty() &&
        a.run.json.empty() && !a.dryRun)
        throw UsageError("nothing to write: give -o FILE, --output-dir DIR, --image FILE, --solution FILE or "
                         "--json FILE");
    std::error_code ignored;
    if (a.scenes.size() > 1 && !a.outputs.empty())
        throw UsageError("-o: is for one scene; for several give --output-dir DIR");
    const bool several =
        a.scenes.size() > 1 || (a.outputs.empty() && std::filesystem::is_directory(a.scenes.front(), ignored));
    if (several && a.outputDir.empty() && !a.dryRun) throw UsageError("several scenes: give --output-dir DIR");
    if (several &&
        !(a.transport.formFactors.empty() && a.transport.warmStart.empty() && a.transport.checkpoint.empty()))
        throw UsageError("--form-factors, --warm-start and --checkpoint: are for one scene");
    if (!a.outputDir.empty() || several) return runBatch(a, plan, planBatch(a), several);
    return bakeOneScene(a, plan);
}

} // namespace

void addBakeCommand(CLI::App& program, CommandRun& run) {
    auto arguments = std::make_shared<BakeArguments>();
    CLI::App& command = *program.add_subcommand("bake", "Bakes the light of scenes into vertex colours");
    command.add_option("scenes", arguments->scenes, "Scenes: " + sceneExtensions() + "; or folders with such files")
        ->required()
        ->type_name("SCENE");
    addSceneOptions(command, arguments->scene);
    command.option_defaults()->group("Bake");
    auto* output = command.add_option("-o,--output", arguments->outputs, "Baked scene; may be given several times")
                       ->type_name("FILE")
                       ->allow_extra_args(false);
    command
        .add_option("--output-dir", arguments->outputDir,
                    "Folder of the baked scenes, under their own names, with a .log beside each")
        ->type_name("DIR")
        ->excludes(output);
    command.add_option("--format", arguments->format, "glb, gltf, ply or obj [by the name's end; glb in a folder]")
        ->check(CLI::IsMember({"glb", "gltf", "ply", "obj"}));
    command
        .add_option("--reconstruction", arguments->reconstruction,
                    "Of light at the vertices: average of the patches about each, or gathered there [average]")
        ->check(CLI::IsMember({"average", "gather"}));
    command.add_option("--quantity", arguments->quantity, "What the colours show: radiosity or irradiance [radiosity]")
        ->check(CLI::IsMember({"radiosity", "irradiance"}));
    command
        .add_option("--exposure", arguments->exposure,
                    "EV, display = value · 2^EV; auto: 99 % of all is below 0.9 [auto]")
        ->type_name("EV");
    command.add_flag("--per-light", arguments->perLight,
                     "Also writes each light on its own: emitting materials, lights by name, the sky");
    addTransportArguments(command, arguments->transport);
    command
        .add_option("--solution", arguments->solution,
                    "Patches with their light, for `compare bakes` and --warm-start: a .glb; with --output-dir, {} "
                    "in it stands for a scene's name")
        ->type_name("FILE")
        ->group("Solution");
    addPictureArguments(command, arguments->picture);
    addRunArguments(command, arguments->run);
    command
        .add_flag("--skip-existing", arguments->skipExisting,
                  "Leaves out scenes whose results are there and newer than the scene's files")
        ->group("Run");
    command
        .add_flag("--dry-run", arguments->dryRun, "Predicts patches, rays, time and memory; bakes and writes nothing")
        ->group("Run");
    command.callback([arguments, &run] { run = [arguments] { return bake(*arguments); }; });
}

} // namespace lambert
