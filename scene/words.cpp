#include "scene/words.h"

#include "core/error.h"
#include "core/text.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cstdlib>
#include <limits>

namespace lambert {

namespace {

bool isSpace(char c) { return c == ' ' || c == '\t' || c == '\v' || c == '\f'; }

} // namespace

std::string_view trimmed(std::string_view text) {
    while (!text.empty() && isSpace(text.front())) text.remove_prefix(1);
    while (!text.empty() && isSpace(text.back())) text.remove_suffix(1);
    return text;
}

std::string_view nextWord(std::string_view& text) {
    std::size_t begin = 0;
    while (begin < text.size() && isSpace(text[begin])) ++begin;
    text.remove_prefix(begin);
    if (text.starts_with('#')) text = {};
    std::size_t end = 0;
    while (end < text.size() && !isSpace(text[end])) ++end;
    const std::string_view word = text.substr(0, end);
    text.remove_prefix(end);
    return word;
}

std::vector<std::string_view> wordsOf(std::string_view text) {
    constexpr std::string_view kSpaces = " \t\v\f\r\n";
    std::vector<std::string_view> words;
    for (std::size_t begin = text.find_first_not_of(kSpaces); begin != std::string_view::npos;) {
        const std::size_t end = std::min(text.find_first_of(kSpaces, begin), text.size());
        words.push_back(text.substr(begin, end - begin));
        begin = text.find_first_not_of(kSpaces, end);
    }
    return words;
}

std::optional<double> parseNumber(std::string_view word) {
    std::string_view digits = word;
    if (digits.starts_with('+') && !digits.starts_with("+-")) digits.remove_prefix(1);
    double value = 0.0;
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
    if (error == std::errc::result_out_of_range) value = std::strtod(std::string(digits).c_str(), nullptr);
    if (error != std::errc::invalid_argument && end == digits.data() + digits.size()) return value;

    // Old Microsoft libraries print 1.#INF, -1.#IND, 1.#QNAN.
    if (digits.starts_with('-')) digits.remove_prefix(1);
    if (digits.starts_with("1.#")) return std::numeric_limits<double>::quiet_NaN();
    return std::nullopt;
}

void failAt(const std::string& file, std::size_t line, std::string_view found, const std::string& expected) {
    throw InputError(fmt::format("{}:{}: found {}, expected {}", file, line, inQuotes(found), expected));
}

} // namespace lambert
