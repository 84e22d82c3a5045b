#include "cli/arguments.h"
#include "cli/bake_report.h"
#include "cli/bake_verdict.h"
#include "cli/commands.h"
#include "cli/points_file.h"
#include "cli/scene_files.h"
#include "cli/targets.h"
#include "cli/terminal_progress.h"

#include "baking/probe.h"
#include "core/parallel.h"
#include "core/stopwatch.h"
#include "core/whole_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <memory>

namespace lambert {

namespace {

struct ProbeArguments {
    SceneArguments scene;
    TransportArguments transport;
    RunArguments run;
    std::filesystem::path points, output;
};

std::string table(const std::vector<SensorPoint>& points, const std::vector<ProbeReading>& readings) {
    std::string text = "# x,y,z,nx,ny,nz,E_r,E_g,E_b,stderr_r,stderr_g,stderr_b\n";
    for (std::size_t i = 0; i < points.size(); ++i) {
        const auto& [p, n] = points[i];
        const RgbSum& e = readings[i].irradiance;
        const RgbSum& s = readings[i].standardError;
        text += fmt::format("{},{},{},{},{},{},{:.9g},{:.9g},{:.9g},{:.6g},{:.6g},{:.6g}\n", p.x, p.y, p.z, n.x, n.y,
                            n.z, e.x, e.y, e.z, s.x, s.y, s.z);
    }
    return text;
}

/// Numbers that are none become null.
nlohmann::ordered_json probesJson(const std::vector<ProbeReading>& readings) {
    auto probes = nlohmann::ordered_json::array();
    for (const ProbeReading& reading : readings)
        probes.push_back({{"irradiance", jsonVector(reading.irradiance)},
                          {"standard_error", jsonVector(reading.standardError)},
                          {"on_surface", reading.onSurface}});
    return probes;
}

ExitCode probe(const ProbeArguments& a) {
    const SolveOptions options = solveOptions(a.transport, a.run);
    std::vector<std::filesystem::path> inputs = inputFiles(a.scene);
    inputs.push_back(a.points);
    addTransportInputs(a.transport, inputs);
    const auto& rows = a.transport.checkpoint;
    checkTargets(std::array{a.output, a.run.json, rows, solverCheckpointPath(rows)}, inputs);
    setThreadCount(a.run.threads);
    TerminalProgress progress(a.run.quiet);
    const Stopwatch total;
    const std::vector<SensorPoint> points = readPoints(a.points);
    ReadResult read = readScene(a.scene, &progress);
    addDaylight(read.scene, a.transport.light);
    const double readSeconds = total.seconds();
    logReport(a.run, read.report);
    const SolvedScene solved = solveScene(read.scene, options, progress);
    for (const std::string& warning : solved.warnings) warnLine(warning);
    const std::vector<ProbeReading> readings = probeIrradiance(solved, gatherOptions(a.transport, a.run, kProbeError),
                                                               pointsInScene(points, *solved.scene), progress);
    const auto inSpace = std::count_if(readings.begin(), readings.end(), [](const auto& r) { return !r.onSurface; });
    if (inSpace > 0)
        logLine(a.run, fmt::format("{} of {} points lie on no surface: light gathered there", inSpace, points.size()));
    const std::string text = table(points, readings);
    const Stopwatch writing;
    if (a.output.empty())
        fmt::print("{}", text);
    else
        writeWholeFile(a.output, text);
    const BakeVerdict verdict = judge(options.method, solved);
    for (const std::string& warning : verdict.warnings) warnLine(warning);
    if (!a.run.json.empty()) {
        auto report = bakeReport({solved, options, read.report, a.scene, a.transport, a.run, readSeconds,
                                  writing.seconds(), total.seconds()});
        for (const std::string& warning : verdict.warnings) report["warnings"].push_back(warning);
        report["probes"] = probesJson(readings);
        writeJson(report, a.run.json);
    }
    removeCheckpoints(solved);
    return verdict.exitCode;
}

} // namespace

void addProbeCommand(CLI::App& program, CommandRun& run) {
    auto arguments = std::make_shared<ProbeArguments>();
    CLI::App& command = *program.add_subcommand("probe", "Irradiance at points: virtual sensors");
    addSceneArguments(command, arguments->scene);
    command.add_option("points", arguments->points, "CSV with x,y,z,nx,ny,nz in metres; # starts a comment")
        ->required()
        ->type_name("POINTS.csv");
    command.add_option("-o,--output", arguments->output, "CSV with E and its standard error [standard output]")
        ->type_name("OUT.csv")
        ->group("Options");
    addTransportArguments(command, arguments->transport);
    addRunArguments(command, arguments->run);
    command.callback([arguments, &run] { run = [arguments] { return probe(*arguments); }; });
}

} // namespace lambert
