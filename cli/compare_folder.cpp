#include "cli/compare_folder.h"

#include "cli/bake_report.h"
#include "cli/targets.h"
#include "core/error.h"
#include "core/parallel.h"

#include <fmt/format.h>

#include <system_error>

namespace lambert {

namespace fs = std::filesystem;

std::string versionText() {
    const int threads = threadCount();
    return fmt::format("version {}, {} thread{}", LAMBERT_VERSION, threads, threads == 1 ? "" : "s");
}

void checkPageFolder(const fs::path& folder, std::span<const fs::path> others, std::span<const fs::path> inputs) {
    std::vector<fs::path> targets(others.begin(), others.end());
    std::error_code ignored;
    if (fs::exists(folder, ignored)) {
        for (const char* file : {"index.html", "results.json", "results.csv"}) targets.push_back(folder / file);
        checkTargets(targets, inputs);
        return;
    }
    checkTargets(targets, inputs);
    fs::path existing = fs::absolute(folder);
    while (existing.has_relative_path() && !fs::exists(existing, ignored)) existing = existing.parent_path();
    requireWritable(existing / "index.html");
}

void writePageFolder(const RunArguments& run, const fs::path& folder, std::vector<FileContent> page, std::string csv,
                     const nlohmann::ordered_json& results, const Progress& progress) {
    page.push_back({"results.csv", std::move(csv)});
    page.push_back({"results.json", jsonText(results)});
    progress.throwIfCancelled();
    std::error_code error;
    fs::create_directories(folder, error);
    if (error) throw SystemError(fmt::format("{}: cannot create the folder: {}", folder.string(), error.message()));
    for (FileContent& file : page) file.path = folder / file.path;
    writeWholeFiles(page);
    logLine(run, fmt::format("{}: open index.html in a browser", folder.string()));
}

} // namespace lambert
