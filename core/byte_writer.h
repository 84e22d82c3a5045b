#pragma once

#include <glm/vec3.hpp>

#include <bit>
#include <cstdint>
#include <ostream>
#include <string>

namespace lambert {

/// Writes numbers in little-endian order, whatever the machine's own. All are on the stream once it is destroyed.
class ByteWriter {
public:
    explicit ByteWriter(std::ostream& stream) : stream_(stream) { bytes_.reserve(kAtOnce + 4); }
    ~ByteWriter() { flush(); }
    ByteWriter(const ByteWriter&) = delete;
    ByteWriter& operator=(const ByteWriter&) = delete;

    void put(std::uint8_t value) {
        bytes_.push_back(static_cast<char>(value));
        if (bytes_.size() >= kAtOnce) flush();
    }
    void put(std::uint32_t value) {
        char little[4];
        for (unsigned k = 0; k < 4; ++k) little[k] = static_cast<char>(value >> (8 * k) & 0xFF);
        bytes_.append(little, 4);
        if (bytes_.size() >= kAtOnce) flush();
    }
    /// Negative zero is written as zero, so that equal meshes have equal bytes.
    void put(float value) { put(std::bit_cast<std::uint32_t>(value + 0.0F)); }
    void put(double value) {
        const auto bits = std::bit_cast<std::uint64_t>(value + 0.0);
        put(static_cast<std::uint32_t>(bits));
        put(static_cast<std::uint32_t>(bits >> 32U));
    }
    void put(const glm::dvec3& value) {
        for (int axis = 0; axis < 3; ++axis) put(value[axis]);
    }
    void put(const glm::vec3& value) {
        put(value.x);
        put(value.y);
        put(value.z);
    }

private:
    static constexpr std::size_t kAtOnce = 65536;

    void flush() {
        stream_.write(bytes_.data(), static_cast<std::streamsize>(bytes_.size()));
        bytes_.clear();
    }

    std::ostream& stream_;
    std::string bytes_;
};

} // namespace lambert
