#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace lambert {

/// `text` without the spaces and tabs around it.
std::string_view trimmed(std::string_view text);

/// Takes the next word off `text`; empty at the end or where a comment begins.
std::string_view nextWord(std::string_view& text);

/// All words of `text`, also those after a #.
std::vector<std::string_view> wordsOf(std::string_view text);

/// A number as C++ writes it, `nan` and `inf` in the spellings of the usual exporters included; nothing if
/// the word is something else.
std::optional<double> parseNumber(std::string_view word);

[[noreturn]] void failAt(const std::string& file, std::size_t line, std::string_view found,
                         const std::string& expected);

} // namespace lambert
