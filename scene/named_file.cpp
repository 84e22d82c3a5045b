#include "scene/named_file.h"

#include "core/error.h"
#include "core/text.h"
#include "scene/reading.h"

#include <fmt/format.h>

#include <algorithm>
#include <system_error>

namespace lambert {

namespace {

/// The entry of `folder` that has this name but for the case of its letters, or the name itself.
std::filesystem::path matchCase(const std::filesystem::path& folder, const std::filesystem::path& name) {
    std::error_code error;
    const std::filesystem::path here = folder.empty() ? std::filesystem::path(".") : folder;
    if (std::filesystem::exists(here / name, error)) return name;
    std::filesystem::path found = name;
    std::size_t matches = 0;
    for (std::filesystem::directory_iterator entry(here, error), end; !error && entry != end; entry.increment(error)) {
        if (lowerCase(entry->path().filename().string()) != lowerCase(name.string())) continue;
        // The smallest of several: folders have no order of their own.
        if (matches++ == 0 || entry->path().filename() < found) found = entry->path().filename();
    }
    return found;
}

} // namespace

std::filesystem::path namedFile(const std::filesystem::path& folder, const std::string& name,
                                const ReadOptions& options) {
    std::string forward = name;
    std::error_code error;
    if (!std::filesystem::exists(folder / name, error)) {
        forward = asUtf8(name); // Latin-1 may have been converted with the file's system or not
        if (!std::filesystem::exists(folder / forward, error)) std::replace(forward.begin(), forward.end(), '\\', '/');
    }
    const std::filesystem::path start = folder.empty() ? std::filesystem::path(".") : folder;
    std::filesystem::path path = start;
    for (const std::filesystem::path& part : std::filesystem::path(forward)) path /= matchCase(path, part);
    if (options.allowOutsideFiles) return path;

    const auto home = std::filesystem::weakly_canonical(std::filesystem::absolute(start), error);
    const auto target = std::filesystem::weakly_canonical(std::filesystem::absolute(path), error);
    const auto [inHome, inTarget] = std::mismatch(home.begin(), home.end(), target.begin(), target.end());
    if (error || inHome != home.end())
        throw InputError(fmt::format("{} lies outside the scene's folder; --allow-outside-files reads it all the same",
                                     inQuotes(name)));
    return path;
}

} // namespace lambert
