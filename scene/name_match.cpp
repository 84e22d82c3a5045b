#include "scene/name_match.h"

#include "core/text.h"

#include <algorithm>
#include <numeric>
#include <utility>

namespace lambert {

namespace {

constexpr std::size_t kComparedBytes = 64;
constexpr std::size_t kComparedNames = 20'000; // more would take longer than the message is worth

/// Letters changed, added or left out: V. Levenshtein's distance, by the table of R. Wagner and M. Fischer (1974), of which
/// only one row is kept.
std::size_t editDistance(std::string_view one, std::string_view two) {
    std::vector<std::size_t> row(two.size() + 1);
    std::iota(row.begin(), row.end(), std::size_t{0});
    for (std::size_t i = 0; i < one.size(); ++i) {
        std::size_t diagonal = std::exchange(row[0], i + 1);
        for (std::size_t j = 0; j < two.size(); ++j) {
            const std::size_t changed = diagonal + (one[i] == two[j] ? 0 : 1);
            diagonal = row[j + 1];
            row[j + 1] = std::min({changed, row[j + 1] + 1, row[j] + 1});
        }
    }
    return row.back();
}

} // namespace

bool matchesPattern(std::string_view name, std::string_view pattern) {
    // The last star takes one character more whenever what follows it does not fit.
    std::size_t at = 0, next = 0;
    std::size_t star = std::string_view::npos, taken = 0;
    while (at < name.size()) {
        if (next < pattern.size() && pattern[next] == '*') {
            star = next++;
            taken = at;
        } else if (next < pattern.size() && pattern[next] == name[at]) {
            ++next;
            ++at;
        } else if (star != std::string_view::npos) {
            next = star + 1;
            at = ++taken;
        } else {
            return false;
        }
    }
    return pattern.find_first_not_of('*', next) == std::string_view::npos;
}

std::vector<std::uint32_t> matchingNames(std::span<const std::string> names, std::string_view pattern) {
    std::vector<std::uint32_t> found;
    for (std::uint32_t i = 0; i < names.size(); ++i)
        if (names[i] == pattern) found.push_back(i);
    if (!found.empty() || pattern.find('*') == std::string_view::npos) return found;
    for (std::uint32_t i = 0; i < names.size(); ++i)
        if (matchesPattern(names[i], pattern)) found.push_back(i);
    return found;
}

std::vector<std::string> closestNames(std::string_view wanted, std::span<const std::string> names, std::size_t count) {
    const auto comparable = [](std::string_view name) { return lowerCase(name.substr(0, kComparedBytes)); };
    const std::string compared = comparable(wanted);
    std::vector<std::pair<std::size_t, std::string>> ranked;
    for (const std::string& name : names.first(std::min(names.size(), kComparedNames)))
        ranked.emplace_back(editDistance(compared, comparable(name)), name);
    std::sort(ranked.begin(), ranked.end());
    ranked.erase(std::unique(ranked.begin(), ranked.end()), ranked.end());
    std::vector<std::string> closest;
    for (std::size_t i = 0; i < std::min(count, ranked.size()); ++i) closest.push_back(std::move(ranked[i].second));
    return closest;
}

} // namespace lambert
