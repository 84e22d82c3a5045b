#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace lambert {

/// The whole content of a file. Throws InputError, with the path and the reason, if it is missing, not a
/// regular file, unreadable or empty.
std::string readInputFile(const std::filesystem::path& path);

/// `text` in double quotes for a message of one line: at most 60 characters, control characters made
/// harmless.
std::string inQuotes(std::string_view text);

/// `text` as one line of at most `maxLength` characters: line breaks become "; ", other control characters
/// '?'.
std::string oneLine(std::string_view text, std::size_t maxLength = 300);

} // namespace lambert
