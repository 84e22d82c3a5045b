#include "cli/arguments.h"
#include "cli/bake_report.h"
#include "cli/commands.h"
#include "cli/info_report.h"
#include "cli/scene_facts.h"
#include "cli/scene_files.h"
#include "cli/targets.h"
#include "cli/terminal_progress.h"

#include <array>
#include <memory>

namespace lambert {

namespace {

struct InfoArguments {
    SceneArguments scene;
    RunArguments run;
};

ExitCode info(const InfoArguments& a) {
    checkTargets(std::array{a.run.json}, inputFiles(a.scene));
    TerminalProgress progress(a.run.quiet);
    const ReadResult read = readScene(a.scene, &progress);
    logReport(a.run, read.report);
    const SceneFacts facts = gatherFacts(read.scene, progress);
    const InfoReportInput report{a.scene.path, read, facts,
                                 worthALook(read, facts, unitIsGiven(a.scene, read.report.overrides))};
    if (!a.run.json.empty()) writeJson(infoReport(report), a.run.json);
    if (!a.run.quiet) printInfo(report);
    return ExitCode::Ok;
}

} // namespace

void addInfoCommand(CLI::App& program, CommandRun& run) {
    auto arguments = std::make_shared<InfoArguments>();
    CLI::App& command = *program.add_subcommand("info", "Tells what is in a scene, and what looks wrong with it");
    addSceneArguments(command, arguments->scene);
    command.add_option("--json", arguments->run.json, "Writes the report as JSON")->type_name("FILE")->group("Run");
    command.add_flag("--quiet", arguments->run.quiet, "Only errors and warnings")->group("Run");
    command.callback([arguments, &run] { run = [arguments] { return info(*arguments); }; });
}

} // namespace lambert
