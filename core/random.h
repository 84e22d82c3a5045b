#pragma once

#include <array>
#include <cstdint>

namespace lambert {

/// Counter-based random numbers: the value depends on nothing but the key and the counter, so any thread can
/// draw the numbers of any patch, iteration or ray in any order.
///
/// Philox 4x32 with 10 rounds: J. K. Salmon et al., "Parallel random numbers: as easy as 1, 2, 3", SC 2011.
inline std::array<std::uint32_t, 4> philox(std::array<std::uint32_t, 4> counter, std::uint64_t key) {
    std::uint32_t key0 = static_cast<std::uint32_t>(key);
    std::uint32_t key1 = static_cast<std::uint32_t>(key >> 32);
    for (int round = 0; round < 10; ++round) {
        const std::uint64_t product0 = std::uint64_t{0xD2511F53} * counter[0];
        const std::uint64_t product1 = std::uint64_t{0xCD9E8D57} * counter[2];
        counter = {static_cast<std::uint32_t>(product1 >> 32) ^ counter[1] ^ key0, static_cast<std::uint32_t>(product1),
                   static_cast<std::uint32_t>(product0 >> 32) ^ counter[3] ^ key1,
                   static_cast<std::uint32_t>(product0)};
        key0 += 0x9E3779B9;
        key1 += 0xBB67AE85;
    }
    return counter;
}

/// 64 random bits: the key of numbers of their own.
inline std::uint64_t randomKey(const std::array<std::uint32_t, 4>& counter, std::uint64_t key) {
    const auto bits = philox(counter, key);
    return (std::uint64_t{bits[0]} << 32) | bits[1];
}

/// Maps 32 random bits to a float in [0, 1).
inline float uniformFloat(std::uint32_t bits) { return static_cast<float>(bits >> 8) * 0x1p-24F; }

} // namespace lambert
