#pragma once

#include <cstdio>
#include <filesystem>
#include <functional>
#include <string_view>

namespace lambert {

/// Writes `content` to `path` whole or not at all: to a temporary name in the same folder, flushed to disk,
/// then renamed over the old file. Throws SystemError (with the path and the reason) and leaves the old file
/// untouched if anything fails.
void writeWholeFile(const std::filesystem::path& path, std::string_view content);

/// The same for a library that insists on opening the file itself: `write` is given the temporary name, which
/// keeps the extension of `path`. What `write` throws is passed on, after the temporary file is removed.
void writeWholeFile(const std::filesystem::path& path,
                    const std::function<void(const std::filesystem::path& temporary)>& write);

/// Throws SystemError if `path` cannot become a file (its folder is missing or not writable, or it is a
/// folder itself): to be called before hours of work, not after.
void requireWritable(const std::filesystem::path& path);

} // namespace lambert
