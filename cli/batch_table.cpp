#include "cli/batch_table.h"
#include "cli/terminal_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

namespace lambert {

namespace {

using NamedStatus = std::pair<BatchStatus, const char*>;
constexpr std::array kStatuses{NamedStatus{BatchStatus::Baked, "baked"},
                               NamedStatus{BatchStatus::Predicted, "predicted"},
                               NamedStatus{BatchStatus::Skipped, "skipped"},
                               NamedStatus{BatchStatus::Failed, "failed"},
                               NamedStatus{BatchStatus::Interrupted, "interrupted"},
                               NamedStatus{BatchStatus::NotRun, "not run"}};

std::string rowText(const BatchRow& row) {
    const BakeOutcome& o = row.outcome;
    const bool done = row.status == BatchStatus::Baked || row.status == BatchStatus::Predicted;
    const std::string remark = row.status == BatchStatus::Baked && row.exitCode == ExitCode::TargetMissed
                                   ? "missed a target, see the warnings"
                                   : row.error;
    const auto cell = [](bool known, const std::string& text) { return known ? text : std::string("-"); };
    return fmt::format(
        "{:<11} {:>9} {:>9} {:>9} {:>9} {:>10} {:>8}{}{}", nameOf(row.status), cell(done, fmt::format("{}", o.patches)),
        cell(done, fmt::format("{:.2g}", static_cast<double>(o.rays))), cell(done, fmt::format("{:.1f}", o.seconds)),
        cell(done, fmt::format("{:.0f}", static_cast<double>(o.peakMemory) / 1e6)),
        cell(o.imbalance.has_value(), fmt::format("{:.1e}", o.imbalance.value_or(0.0))),
        cell(row.status != BatchStatus::NotRun, fmt::format("{}", row.warnings.size())), remark.empty() ? "" : "   ",
        remark);
}

} // namespace

const char* nameOf(BatchStatus status) { return std::ranges::find(kStatuses, status, &NamedStatus::first)->second; }

std::string batchTable(const std::vector<BakeJob>& jobs, const std::vector<BatchRow>& rows, double seconds) {
    std::size_t width = 5;
    for (const BakeJob& job : jobs) width = std::max(width, job.scene.string().size());
    std::string text = fmt::format("{:<{}} {:<11} {:>9} {:>9} {:>9} {:>9} {:>10} {:>8}\n", "scene", width, "status",
                                   "patches", "rays", "seconds", "memory MB", "imbalance", "warnings");
    for (std::size_t i = 0; i < rows.size(); ++i)
        text += fmt::format("{:<{}} {}\n", printable(jobs[i].scene.string()), width, rowText(rows[i]));

    text += fmt::format("{} scene{}", rows.size(), rows.size() == 1 ? "" : "s");
    const char* separator = ": ";
    for (const auto& [status, name] : kStatuses) {
        const auto count = std::ranges::count(rows, status, &BatchRow::status);
        if (count == 0) continue;
        text += fmt::format("{}{} {}", separator, count, name);
        separator = ", ";
    }
    double predicted = 0.0;
    for (const BatchRow& row : rows)
        if (row.status == BatchStatus::Predicted) predicted += row.outcome.seconds;
    if (predicted > 0.0) return text + fmt::format("; a bake takes about {:.3g} s\n", predicted);
    return text + fmt::format("; {:.1f} s\n", seconds);
}

} // namespace lambert
