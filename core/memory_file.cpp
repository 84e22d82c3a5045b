#include "core/memory_file.h"

#include "core/error.h"

#include <fmt/format.h>
#include <sys/mman.h>
#include <unistd.h>

#include <fstream>

namespace lambert {

MemoryFile::MemoryFile(std::string_view content) : descriptor_(::memfd_create("lambert", MFD_CLOEXEC)) {
    std::ofstream file(path(), std::ios::binary);
    file << content << std::flush;
    if (descriptor_ >= 0 && file) return;
    if (descriptor_ >= 0) ::close(descriptor_);
    throw SystemError("not enough memory for a file in memory");
}

MemoryFile::~MemoryFile() { ::close(descriptor_); }

std::filesystem::path MemoryFile::path() const { return fmt::format("/proc/self/fd/{}", descriptor_); }

} // namespace lambert
