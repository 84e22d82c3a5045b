#include "cli/compare_folder.h"

#include "cli/targets.h"
#include "core/error.h"

#include <fmt/format.h>

#include <array>
#include <system_error>

namespace lambert {

namespace fs = std::filesystem;

std::vector<std::string> commaSeparated(const std::string& text) {
    std::vector<std::string> result(1);
    for (const char c : text) {
        if (c == ',')
            result.emplace_back();
        else
            result.back() += c;
    }
    return result;
}

void checkPageFolder(const fs::path& folder, const fs::path& json, std::span<const fs::path> inputs) {
    std::error_code ignored;
    if (fs::exists(folder, ignored)) {
        checkTargets(std::array{folder / "index.html", folder / "results.json", folder / "results.csv", json}, inputs);
        return;
    }
    checkTargets(std::array{json}, inputs);
    fs::path existing = fs::absolute(folder);
    while (existing.has_relative_path() && !fs::exists(existing, ignored)) existing = existing.parent_path();
    requireWritable(existing / "index.html");
}

void writePageFolder(const fs::path& folder, std::vector<FileContent> files) {
    std::error_code error;
    fs::create_directories(folder, error);
    if (error) throw SystemError(fmt::format("{}: cannot create the folder: {}", folder.string(), error.message()));
    for (FileContent& file : files) file.path = folder / file.path;
    writeWholeFiles(files);
}

} // namespace lambert
