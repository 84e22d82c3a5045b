#pragma once

#include <filesystem>
#include <string_view>

namespace lambert {

/// A file that has no name of its own and lies in memory, for who reads or writes only files.
class MemoryFile {
public:
    /// Throws SystemError if there is no memory for `content`.
    explicit MemoryFile(std::string_view content = {});
    ~MemoryFile();
    MemoryFile(const MemoryFile&) = delete;
    MemoryFile& operator=(const MemoryFile&) = delete;

    int descriptor() const { return descriptor_; } //!< at its first byte
    /// Under which this process can open it.
    std::filesystem::path path() const;

private:
    int descriptor_;
};

} // namespace lambert
