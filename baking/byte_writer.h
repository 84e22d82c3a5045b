#pragma once

#include <glm/vec3.hpp>

#include <bit>
#include <cstdint>
#include <string>

namespace lambert {

/// Appends numbers in little-endian order, whatever the machine's own.
class ByteWriter {
public:
    explicit ByteWriter(std::string& bytes) : bytes_(&bytes) {}

    void put(std::uint8_t value) { bytes_->push_back(static_cast<char>(value)); }
    void put(std::uint32_t value) {
        char little[4];
        for (unsigned k = 0; k < 4; ++k) little[k] = static_cast<char>(value >> (8 * k) & 0xFF);
        bytes_->append(little, 4);
    }
    /// Negative zero is written as zero, so that equal meshes have equal bytes.
    void put(float value) { put(std::bit_cast<std::uint32_t>(value + 0.0F)); }
    void put(const glm::vec3& value) {
        put(value.x);
        put(value.y);
        put(value.z);
    }

private:
    std::string* bytes_;
};

} // namespace lambert
