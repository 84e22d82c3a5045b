#pragma once

#include <filesystem>
#include <functional>
#include <ostream>
#include <span>
#include <string>
#include <string_view>

namespace lambert {

/// Writes `content` to `path` whole or not at all: to a file in the same folder that has no name until it is on the disk,
/// then renamed over the old file. A process killed before that leaves nothing (on file systems without nameless files a
/// `.lambert-*.tmp`). Throws SystemError (with the path and the reason) and leaves the old file untouched if anything fails.
void writeWholeFile(const std::filesystem::path& path, std::string_view content);

/// The same for content too large for memory, written piece by piece; what `content` throws is passed on.
void writeWholeFile(const std::filesystem::path& path, const std::function<void(std::ostream&)>& content);

struct FileContent {
    std::filesystem::path path;
    std::string content;
};

/// The same for files that belong together (of different names): all are on the disk before the first old one is replaced, so
/// that a disk that fills up leaves every old file as it was.
void writeWholeFiles(std::span<const FileContent> files);

struct FileStream {
    std::filesystem::path path;
    std::function<void(std::ostream&)> content;
};

/// The same for content too large for memory; what a `content` throws is passed on.
void writeWholeFiles(std::span<const FileStream> files);

/// Throws SystemError if `path` cannot become a file (its folder is missing or not writable, or it is a
/// folder itself): to be called before hours of work, not after.
void requireWritable(const std::filesystem::path& path);

} // namespace lambert
