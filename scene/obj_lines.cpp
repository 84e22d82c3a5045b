#include "scene/obj_lines.h"

#include "core/error.h"
#include "scene/input_file.h"

#include <fmt/format.h>

#include <charconv>
#include <cstdlib>
#include <limits>

namespace lambert {

namespace {

constexpr std::string_view kSpaces = " \t\v\f";

std::string_view trimmed(std::string_view text) {
    const std::size_t begin = text.find_first_not_of(kSpaces);
    if (begin == std::string_view::npos) return {};
    return text.substr(begin, text.find_last_not_of(kSpaces) + 1 - begin);
}

} // namespace

ObjLines::ObjLines(std::string_view text) : text_(text) {
    if (text_.starts_with("\xEF\xBB\xBF")) text_.remove_prefix(3);
}

std::string_view ObjLines::physicalLine() {
    ++number_;
    const std::size_t end = std::min(text_.find_first_of("\r\n"), text_.size());
    const std::string_view line = text_.substr(0, end);
    text_.remove_prefix(end);
    text_.remove_prefix(text_.starts_with("\r\n") ? 2 : (text_.empty() ? 0 : 1));
    return line;
}

std::optional<ObjLine> ObjLines::next() {
    while (!text_.empty()) {
        std::string_view text = trimmed(physicalLine());
        if (text.empty() || text.front() == '#') continue;
        const std::size_t number = number_;
        if (text.back() == '\\') {
            joined_.clear();
            while (!text.empty() && text.back() == '\\') {
                joined_.append(text.substr(0, text.size() - 1)).append(" ");
                text = text_.empty() ? std::string_view{} : trimmed(physicalLine());
            }
            joined_.append(text);
            text = trimmed(joined_);
            if (text.empty()) continue;
        }
        std::string_view rest = text;
        const std::string_view keyword = nextWord(rest);
        return ObjLine{number, text, keyword, trimmed(rest)};
    }
    return std::nullopt;
}

std::string_view nextWord(std::string_view& text) {
    text.remove_prefix(std::min(text.find_first_not_of(kSpaces), text.size()));
    if (text.starts_with('#')) text = {};
    const std::string_view word = text.substr(0, text.find_first_of(kSpaces));
    text.remove_prefix(word.size());
    return word;
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
