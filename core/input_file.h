#pragma once

#include <filesystem>
#include <fstream>
#include <string>

namespace lambert {

/// The whole content of a file. Throws InputError, with the path and the reason, if it is missing, not a
/// regular file, unreadable or empty.
std::string readInputFile(const std::filesystem::path& path);

/// The same file at its first byte, to be read in pieces. Throws InputError as readInputFile.
std::ifstream openInputFile(const std::filesystem::path& path);

} // namespace lambert
