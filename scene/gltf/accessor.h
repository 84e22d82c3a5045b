#pragma once

#include "scene/gltf/model.h"

#include <glm/vec4.hpp>

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

namespace lambert {

/// The elements of an accessor, checked against its buffer views and buffers before the first is read. Refers to the
/// model's memory, and needs none of its own.
class GltfAccessor {
public:
    /// What the elements stand for, which decides the types that are allowed.
    enum class Use {
        Indices,            //!< SCALAR of 8, 16 or 32 bits, unsigned
        Vectors,            //!< VEC3, float or quantised (KHR_mesh_quantization): positions, translations, scales
        TextureCoordinates, //!< VEC2, float or quantised
        Colours,            //!< VEC3 or VEC4, float or normalised and unsigned
        Rotations,          //!< VEC4, float or normalised and signed
        Numbers             //!< SCALAR, float
    };

    /// Throws InputError with `file` and the JSON path if the accessor does not exist, has another type, reaches past its
    /// memory, or has more elements without memory than the file's buffers have bytes. `referrer` is the JSON path of the
    /// member that holds `index`.
    GltfAccessor(const std::string& file, const gltf::Model& model, int index, Use use, const std::string& referrer);

    std::size_t count() const { return count_; }

    /// Element `k` < count() of anything but indices, normalised where the file says so; components that it does not have
    /// are 0.
    glm::vec4 element(std::size_t k) const;
    /// Element `k` < count() of indices.
    std::uint32_t index(std::size_t k) const;

private:
    void setBase(const std::string& file, const gltf::Model& model, const gltf::Accessor& accessor,
                 const std::string& place);
    void setSparse(const std::string& file, const gltf::Model& model, const gltf::Sparse& sparse,
                   const std::string& place);
    std::size_t elementSize() const { return components_ * componentSize_; }
    std::uint32_t sparseIndex(std::size_t k) const;
    const unsigned char* bytes(std::size_t k) const; //!< null: all zero

    std::size_t count_ = 0;
    std::size_t components_ = 0, componentSize_ = 0;
    gltf::ComponentType componentType_ = gltf::ComponentType::Float;
    bool normalised_ = false;
    const unsigned char* base_ = nullptr; //!< null: all elements are zero
    std::size_t stride_ = 0;
    // The elements that replace some of the base's:
    std::size_t sparseCount_ = 0, sparseIndexSize_ = 0;
    const unsigned char* sparseIndices_ = nullptr; //!< ascending
    const unsigned char* sparseValues_ = nullptr;
};

} // namespace lambert
