#pragma once

#include <glm/vec3.hpp>

#include <cstddef>
#include <cstdint>
#include <string>

namespace tinygltf {
class Model;
}

namespace lambert {

/// The elements of an accessor, checked against its buffer view and buffer before the first is read. Refers
/// to the model's memory.
class GltfAccessor {
public:
    /// Positions: float VEC3. Indices: unsigned integers of 8, 16 or 32 bits, SCALAR.
    enum class Use { Positions, Indices };

    /// Throws InputError with `file` and the JSON path if the accessor does not exist, has another type, is
    /// sparse, or reaches past its memory. `referrer` is the JSON path of the member that holds `index`.
    GltfAccessor(const std::string& file, const tinygltf::Model& model, int index, Use use,
                 const std::string& referrer);

    std::size_t count() const { return count_; }

    /// Element `k` < count() of positions.
    glm::vec3 position(std::size_t k) const;
    /// Element `k` < count() of indices.
    std::uint32_t index(std::size_t k) const;

private:
    const unsigned char* data_ = nullptr;
    std::size_t count_ = 0;
    std::size_t stride_ = 0;
    std::size_t componentSize_ = 0;
};

} // namespace lambert
