#include "cli/analytic_cases.h"
#include "cli/arguments.h"
#include "cli/bake_report.h"
#include "cli/commands.h"
#include "cli/targets.h"
#include "cli/terminal_progress.h"

#include "core/parallel.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <memory>

namespace lambert {

namespace {

ExitCode verify(const RunArguments& run) {
    checkTargets(std::array{run.json}, {});
    setThreadCount(run.threads);
    TerminalProgress progress(run.quiet);
    const std::vector<AnalyticResult> results = runAnalyticCases(progress);
    nlohmann::ordered_json report = nlohmann::ordered_json::array();
    fmt::print("{:<54} {:>13} {:>13} {:>11}\n", "case", "expected", "found", "tolerance");
    for (const AnalyticResult& result : results) {
        fmt::print("{:<54} {:>13.7g} {:>13.7g} {:>11.2g}  {}\n", result.name, result.expected, result.found,
                   result.tolerance, result.passed() ? "ok" : "MISSED");
        report.push_back({{"case", result.name},
                          {"expected", result.expected},
                          {"found", result.found},
                          {"tolerance", result.tolerance},
                          {"passed", result.passed()}});
    }
    if (!run.json.empty()) writeJson(report, run.json);
    const bool passed = std::all_of(results.begin(), results.end(), [](const auto& r) { return r.passed(); });
    return passed ? ExitCode::Ok : ExitCode::TargetMissed;
}

} // namespace

void addVerifyCommand(CLI::App& program, CommandRun& run) {
    auto arguments = std::make_shared<RunArguments>();
    CLI::App& command =
        *program.add_subcommand("verify", "Computes cases with known answers: expected, found, tolerance");
    addRunArguments(command, *arguments);
    command.callback([arguments, &run] { run = [arguments] { return verify(*arguments); }; });
}

} // namespace lambert
