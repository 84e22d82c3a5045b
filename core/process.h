#pragma once

#include <cstdint>

namespace lambert {

/// Largest resident memory of this process so far, in bytes.
std::uint64_t peakMemoryBytes();

} // namespace lambert
