#pragma once

#include "cli/bake_job.h"

#include <string>
#include <vector>

namespace lambert {

enum class BatchStatus { NotRun, Baked, Skipped, Predicted, Failed, Interrupted };

/// "not run", "baked", … as in table and report.
const char* nameOf(BatchStatus status);

/// What became of one job.
struct BatchRow {
    BatchStatus status = BatchStatus::NotRun;
    ExitCode exitCode = ExitCode::Interrupted;
    BakeOutcome outcome; //!< of a job that was done
    std::string error;   //!< one line, or empty
    std::vector<std::string> warnings;
};

/// One line per job under a heading, and one with the totals; `seconds` of the whole batch.
std::string batchTable(const std::vector<BakeJob>& jobs, const std::vector<BatchRow>& rows, double seconds);

} // namespace lambert
