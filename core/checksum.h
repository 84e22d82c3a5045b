#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <string_view>
#include <type_traits>
#include <vector>

namespace lambert {

/// A running 64-bit check sum of bytes, eight at a time: tells torn or changed files apart, no protection against malice.
/// The mixer is that of MurmurHash3 (A. Appleby).
class Checksum {
public:
    void add(std::span<const std::byte> bytes) {
        mix(bytes.size());
        for (; bytes.size() >= 8; bytes = bytes.subspan(8)) mix(word(bytes.first(8)));
        if (!bytes.empty()) mix(word(bytes));
    }
    void add(std::string_view text) { add(std::as_bytes(std::span(text.data(), text.size()))); }
    void add(std::uint64_t number) { mix(number); }
    /// Elements without padding.
    template <typename Element>
    requires std::is_trivially_copyable_v<Element>
    void add(const std::vector<Element>& elements) { add(std::as_bytes(std::span(elements))); }

    std::uint64_t value() const { return state_; }

private:
    static std::uint64_t word(std::span<const std::byte> bytes) {
        std::uint64_t result = 0;
        std::memcpy(&result, bytes.data(), bytes.size());
        return result;
    }
    void mix(std::uint64_t number) {
        state_ = (state_ ^ number) * 0xFF51AFD7ED558CCDULL;
        state_ ^= state_ >> 33;
        state_ *= 0xC4CEB9FE1A85EC53ULL;
        state_ ^= state_ >> 33;
    }

    std::uint64_t state_ = 0x9E3779B97F4A7C15ULL;
};

} // namespace lambert
