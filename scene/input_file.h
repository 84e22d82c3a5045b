#pragma once

#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>

namespace lambert {

/// The whole content of a file. Throws InputError, with the path and the reason, if it is missing, not a
/// regular file, unreadable or empty.
std::string readInputFile(const std::filesystem::path& path);

/// The same file at its first byte, to be read in pieces. Throws InputError as readInputFile.
std::ifstream openInputFile(const std::filesystem::path& path);

struct ReadOptions;

/// The path of a file that a scene names, relative to the scene's `folder`. Names in Latin-1, backslashes of Windows and
/// another case of letters are forgiven if that finds a file; the result need not exist. Throws InputError if it lies outside `folder` and
/// `options.allowOutsideFiles` is not set.
std::filesystem::path namedFile(const std::filesystem::path& folder, const std::string& name,
                                const ReadOptions& options);

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
