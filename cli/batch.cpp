#include "cli/batch.h"
#include "cli/bake_report.h"
#include "cli/batch_table.h"
#include "cli/failure.h"
#include "cli/scene_files.h"
#include "cli/targets.h"
#include "cli/terminal_progress.h"
#include "cli/terminal_text.h"

#include "core/parallel.h"
#include "core/process.h"
#include "core/stopwatch.h"
#include "core/whole_file.h"

#include <fmt/format.h>

#include <algorithm>

namespace lambert {

namespace fs = std::filesystem;

namespace {

using Json = nlohmann::ordered_json;

void createFolder(const fs::path& folder) {
    std::error_code error;
    fs::create_directories(folder, error);
    if (error) throw SystemError(fmt::format("{}: cannot create the folder: {}", folder.string(), error.message()));
}

/// Everything that can keep a job from writing is found before hours of work.
void prepareTargets(const BakeArguments& a, const BakeJob& job) {
    std::vector<fs::path> targets = resultFiles(job);
    if (!job.log.empty()) targets.push_back(job.log);
    for (const fs::path& target : targets)
        if (!a.outputDir.empty() && target.has_parent_path()) createFolder(target.parent_path());
    checkTargets(targets, filesRead(a, job));
}

/// An abandoned job leaves nothing, not even a log.
void writeLogFile(const BakeJob& job, const BatchRow& row, SceneLog& log) {
    if (job.log.empty() || (row.status != BatchStatus::Baked && row.status != BatchStatus::Failed)) return;
    try {
        writeWholeFile(job.log, log.text());
    } catch (const Error& error) {
        log.warning(error.what());
    }
}

/// One job to its end, whatever that is.
BatchRow runJob(const BakeArguments& a, const BakePlan& plan, const BakeJob& job, const std::string& place,
                TerminalProgress& progress) {
    SceneLog log(a.run.quiet, place, job.scene.string());
    BatchRow row;
    resetPeakMemory(); // else the report holds the largest peak so far
    try {
        if (a.skipExisting && isUpToDate(a, job)) {
            row.status = BatchStatus::Skipped;
            row.exitCode = ExitCode::Ok;
            log.line("skipped: the files are there and newer than the scene");
        } else if (a.dryRun) {
            row.outcome = predictJob(a, plan, job, log, progress);
            row.exitCode = row.outcome.exitCode;
            row.status = BatchStatus::Predicted;
        } else {
            prepareTargets(a, job);
            row.outcome = bakeJob(a, plan, job, log, progress);
            row.exitCode = row.outcome.exitCode;
            row.status = BatchStatus::Baked;
        }
    } catch (const Cancelled&) {
        row.status = BatchStatus::Interrupted;
        row.error = "interrupted";
    } catch (...) {
        const Failure failure = currentFailure();
        row.status = BatchStatus::Failed;
        row.exitCode = failure.code;
        row.error = failure.message;
        log.error(failure.message);
    }
    if (!a.dryRun) writeLogFile(job, row, log);
    row.warnings = log.warnings();
    return row;
}

/// The report of a bake with how it ended; of any other job what there is to say.
Json rowJson(const BakeJob& job, const BatchRow& row) {
    Json json = row.outcome.report.is_null() ? Json{{"scene", job.scene.string()}} : row.outcome.report;
    json["status"] = nameOf(row.status);
    json["error"] = row.error.empty() ? Json(nullptr) : Json(row.error);
    json["exit_code"] = static_cast<int>(row.exitCode);
    json["outputs"] = Json::array();
    if (row.status == BatchStatus::Baked || row.status == BatchStatus::Skipped)
        for (const fs::path& file : resultFiles(job)) json["outputs"].push_back(file.string());
    json["warnings"] = row.warnings;
    return json;
}

Json batchReport(const std::vector<BakeJob>& jobs, const std::vector<BatchRow>& rows, bool several) {
    if (!several) return rowJson(jobs.front(), rows.front());
    Json runs = Json::array();
    for (std::size_t i = 0; i < jobs.size(); ++i) runs.push_back(rowJson(jobs[i], rows[i]));
    return {{"runs", runs}};
}

} // namespace

ExitCode runBatch(const BakeArguments& a, const BakePlan& plan, const std::vector<BakeJob>& jobs, bool several) {
    const Stopwatch total;
    if (!a.dryRun && !a.outputDir.empty()) createFolder(a.outputDir);
    if (!a.run.json.empty()) requireWritable(a.run.json);
    setThreadCount(a.run.threads);
    TerminalProgress progress(a.run.quiet);

    std::vector<BatchRow> rows(jobs.size());
    for (std::size_t i = 0; i < jobs.size() && !progress.cancelled(); ++i) {
        const std::string place = jobs.size() > 1 ? fmt::format("[{}/{}] ", i + 1, jobs.size()) : std::string();
        progress.setTitle(place + printable(jobs[i].scene.filename().string()));
        rows[i] = runJob(a, plan, jobs[i], place, progress);
    }

    if (!a.run.json.empty()) writeJson(batchReport(jobs, rows, several), a.run.json);
    if (!a.run.quiet) fmt::print("{}", batchTable(jobs, rows, total.seconds()));
    ExitCode worst = ExitCode::Ok;
    for (const BatchRow& row : rows) worst = std::max(worst, row.exitCode);
    if (worst == ExitCode::Interrupted) writeLog("lambert: interrupted\n");
    return worst;
}

} // namespace lambert
