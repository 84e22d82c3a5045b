#pragma once

#include <filesystem>

namespace lambert {

/// A file open for reading and writing that no other LockedFile, of this process or another, has open.
class LockedFile {
public:
    /// Opens or creates `path`. Throws UsageError that `checkpoint` is in use by another run, SystemError if the file cannot be opened.
    LockedFile(std::filesystem::path path, const std::filesystem::path& checkpoint);
    ~LockedFile();
    LockedFile(const LockedFile&) = delete;
    LockedFile& operator=(const LockedFile&) = delete;

    int descriptor() const { return file_; }
    /// Removes the name; the file stays open and locked.
    void remove();

private:
    std::filesystem::path path_;
    int file_ = -1;
};

} // namespace lambert
