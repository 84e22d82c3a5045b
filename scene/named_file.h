#pragma once

#include <filesystem>
#include <string>

namespace lambert {

struct ReadOptions;

/// The path of a file that a scene names, relative to the scene's `folder`. Names in Latin-1, backslashes of Windows and
/// another case of letters are forgiven if that finds a file; the result need not exist. Throws InputError if it lies outside `folder` and
/// `options.allowOutsideFiles` is not set.
std::filesystem::path namedFile(const std::filesystem::path& folder, const std::string& name,
                                const ReadOptions& options);

} // namespace lambert
