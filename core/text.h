#pragma once

#include <string>
#include <string_view>

namespace lambert {

/// `text` as it stands if it is UTF-8; if not, its bytes are taken as Latin-1.
std::string asUtf8(std::string_view text);

/// With the letters A to Z made small.
std::string lowerCase(std::string_view text);

/// `text` in double quotes for a message of one line: at most 60 characters, control characters made
/// harmless.
std::string inQuotes(std::string_view text);

/// `text` as one line of at most `maxLength` characters: line breaks become "; ", other control characters
/// '?'.
std::string oneLine(std::string_view text, std::size_t maxLength = 300);

} // namespace lambert
