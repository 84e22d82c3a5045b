#pragma once

#include "cli/arguments.h"
#include "core/progress.h"
#include "core/whole_file.h"

#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace lambert {

/// The folder that a comparison writes its page to.

/// What can keep the page from being written is found before the work: to be called before it. A folder that is missing is made
/// after it. `others` are further files that will be written; empty ones are none. Throws UsageError, SystemError.
void checkPageFolder(const std::filesystem::path& folder, std::span<const std::filesystem::path> others,
                     std::span<const std::filesystem::path> inputs);

/// Which Lambert compared, and on how many threads, for the page.
std::string versionText();

/// Writes all files of the folder or none: a page with paths within it, results.csv, results.json. Then logs where. Throws
/// SystemError, Cancelled.
void writePageFolder(const RunArguments& run, const std::filesystem::path& folder, std::vector<FileContent> page,
                     std::string csv, const nlohmann::ordered_json& results, const Progress& progress);

} // namespace lambert
