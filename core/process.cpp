#include "core/process.h"

#include <malloc.h>
#include <sys/resource.h>

#include <fstream>
#include <limits>
#include <optional>
#include <string>
#include <string_view>

namespace lambert {

namespace {

/// A line of proc(5) status in bytes; none if it is not there.
std::optional<std::uint64_t> statusBytes(std::string_view name) {
    std::ifstream status("/proc/self/status");
    for (std::string word; status >> word; status.ignore(std::numeric_limits<std::streamsize>::max(), '\n')) {
        std::uint64_t kibibytes = 0;
        if (word == name && status >> kibibytes) return kibibytes * 1024;
    }
    return std::nullopt;
}

} // namespace

std::uint64_t residentMemoryBytes() { return statusBytes("VmRSS:").value_or(0); }

std::uint64_t peakMemoryBytes() {
    // Unlike getrusage, this peak can be reset.
    if (const auto bytes = statusBytes("VmHWM:")) return *bytes;
    rusage usage{};
    ::getrusage(RUSAGE_SELF, &usage);
    return static_cast<std::uint64_t>(usage.ru_maxrss) * 1024;
}

bool resetPeakMemory() {
    returnFreedMemory();
    std::ofstream references("/proc/self/clear_refs");
    references << "5" << std::flush; // proc(5): resets VmHWM to what is resident now
    return references.good();
}

void returnLargeBlocks() { ::mallopt(M_MMAP_THRESHOLD, 1 << 20); }

void returnFreedMemory() { ::malloc_trim(0); }

double processorSeconds() {
    rusage usage{};
    ::getrusage(RUSAGE_SELF, &usage);
    const auto seconds = [](const timeval& t) {
        return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
    };
    return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

} // namespace lambert
