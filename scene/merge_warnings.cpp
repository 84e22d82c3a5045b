#include "scene/merge_warnings.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <string_view>
#include <unordered_map>

namespace lambert {

namespace {

constexpr std::size_t kFewest = 4;     // alike lines that are merged
constexpr std::size_t kNamesShown = 3; // beside the first line's own

/// What stands between the first two double quotes, with them.
std::optional<std::string_view> firstQuoted(std::string_view text) {
    const std::size_t begin = text.find('"');
    if (begin == std::string_view::npos) return std::nullopt;
    const std::size_t end = text.find('"', begin + 1);
    if (end == std::string_view::npos) return std::nullopt;
    return text.substr(begin, end + 1 - begin);
}

bool isPartOfNumber(char c) { return (c >= '0' && c <= '9') || c == '.' || c == '-' || c == '+' || c == 'e'; }

/// The line without what is quoted and without numbers: alike lines have the same.
std::string kindOf(std::string_view line) {
    std::string kind;
    for (std::size_t i = 0; i < line.size(); ++i) {
        const std::size_t closing = line[i] == '"' ? line.find('"', i + 1) : std::string_view::npos;
        if (closing != std::string_view::npos) {
            kind += '"';
            i = closing;
        } else if (line[i] >= '0' && line[i] <= '9') {
            kind += '0';
            while (i + 1 < line.size() && isPartOfNumber(line[i + 1])) ++i;
        } else {
            kind += line[i];
        }
    }
    return kind;
}

std::string merged(const std::vector<std::string>& lines) {
    std::vector<std::string_view> names;
    for (std::size_t i = 1; i < lines.size() && names.size() < kNamesShown; ++i)
        if (const auto name = firstQuoted(lines[i]);
            name && std::find(names.begin(), names.end(), *name) == names.end())
            names.push_back(*name);
    const char* more = names.size() == kNamesShown && lines.size() - 1 > kNamesShown ? ", ..." : "";
    return names.empty() ? fmt::format("{} (and {} more of this kind)", lines.front(), lines.size() - 1)
                         : fmt::format("{} (and {} more of this kind: {}{})", lines.front(), lines.size() - 1,
                                       fmt::join(names, ", "), more);
}

} // namespace

std::vector<std::string> mergeWarnings(const std::vector<std::string>& warnings) {
    std::unordered_map<std::string, std::size_t> groupOf;
    std::vector<std::vector<std::string>> groups;
    for (const std::string& warning : warnings) {
        const auto [entry, isNew] = groupOf.try_emplace(kindOf(warning), groups.size());
        if (isNew) groups.emplace_back();
        groups[entry->second].push_back(warning);
    }
    std::vector<std::string> result;
    for (const std::vector<std::string>& lines : groups) {
        if (lines.size() < kFewest)
            result.insert(result.end(), lines.begin(), lines.end());
        else
            result.push_back(merged(lines));
    }
    return result;
}

} // namespace lambert
