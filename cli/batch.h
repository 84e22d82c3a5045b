#pragma once

#include "cli/bake_job.h"

#include <vector>

namespace lambert {

/// Bakes the jobs of a plan one after the other, or under --dry-run predicts them. One that fails does not stop the
/// others; an interrupt does, and the rest are not run. Then writes the report (--json) and prints a table, one row per
/// scene. Under
/// --output-dir, creates the folders of what it writes.
///
/// `several`: the report is {"runs": [one object per scene]}, else the one object. Returns the highest exit code of the
/// jobs, or Interrupted. Throws SystemError if the output folder or the report cannot be written.
ExitCode runBatch(const BakeArguments& arguments, const BakePlan& plan, const std::vector<BakeJob>& jobs, bool several);

} // namespace lambert
