#include "scene/gltf/accessor.h"

#include "scene/gltf/buffers.h"
#include "scene/gltf/document.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstring>

namespace lambert {

namespace {

using gltf::ComponentType;

std::string typeName(const gltf::Accessor& accessor) {
    static constexpr std::array<const char*, 7> kComponents = {"BYTE", "UNSIGNED_BYTE", "SHORT", "UNSIGNED_SHORT",
                                                               "INT",  "UNSIGNED_INT",  "FLOAT"};
    const auto number = static_cast<int>(accessor.componentType);
    const auto component = static_cast<std::size_t>(number - static_cast<int>(ComponentType::Byte));
    return fmt::format("{}{} {}", accessor.normalized ? "normalised " : "",
                       component < kComponents.size() ? kComponents[component] : std::to_string(number), accessor.type);
}

const char* allowedTypes(GltfAccessor::Use use) {
    switch (use) {
    case GltfAccessor::Use::Indices:
        return "UNSIGNED_BYTE, _SHORT or _INT SCALAR for indices";
    case GltfAccessor::Use::Vectors:
        return "FLOAT VEC3, or BYTE or SHORT, signed or not";
    case GltfAccessor::Use::TextureCoordinates:
        return "FLOAT VEC2, or BYTE or SHORT, signed or not, for texture coordinates";
    case GltfAccessor::Use::Colours:
        return "FLOAT or normalised UNSIGNED_BYTE or _SHORT VEC3 or VEC4 for colours";
    case GltfAccessor::Use::Rotations:
        return "FLOAT or normalised BYTE or SHORT VEC4 for rotations";
    case GltfAccessor::Use::Numbers:
        return "FLOAT SCALAR";
    }
    return "";
}

bool isAllowed(const gltf::Accessor& accessor, GltfAccessor::Use use) {
    const ComponentType component = accessor.componentType;
    const bool isFloat = component == ComponentType::Float;
    const bool isSigned = component == ComponentType::Byte || component == ComponentType::Short;
    const bool isUnsigned = component == ComponentType::UnsignedByte || component == ComponentType::UnsignedShort;
    switch (use) {
    case GltfAccessor::Use::Indices:
        return accessor.type == "SCALAR" && (isUnsigned || component == ComponentType::UnsignedInt);
    case GltfAccessor::Use::Vectors:
        return accessor.type == "VEC3" && (isFloat || isSigned || isUnsigned);
    case GltfAccessor::Use::TextureCoordinates:
        return accessor.type == "VEC2" && (isFloat || isSigned || isUnsigned);
    case GltfAccessor::Use::Colours:
        return (accessor.type == "VEC3" || accessor.type == "VEC4") && (isFloat || (isUnsigned && accessor.normalized));
    case GltfAccessor::Use::Rotations:
        return accessor.type == "VEC4" && (isFloat || (isSigned && accessor.normalized));
    case GltfAccessor::Use::Numbers:
        return accessor.type == "SCALAR" && isFloat;
    }
    return false;
}

/// In bytes, of the types that are allowed.
std::size_t sizeOf(ComponentType type) {
    if (type == ComponentType::Byte || type == ComponentType::UnsignedByte) return 1;
    return type == ComponentType::Short || type == ComponentType::UnsignedShort ? 2 : 4;
}

/// The elements that fit into `bytes` from `offset` on.
std::size_t fittingElements(std::size_t bytes, std::size_t offset, std::size_t size, std::size_t stride) {
    if (offset > bytes || size > bytes - offset) return 0;
    return (bytes - offset - size) / stride + 1;
}

template <typename T>
float component(const unsigned char* bytes, bool normalised) {
    T value{};
    std::memcpy(&value, bytes, sizeof value);
    if (!normalised) return static_cast<float>(value);
    // -128 stands for -1 as well.
    return std::max(static_cast<float>(value) / static_cast<float>(std::numeric_limits<T>::max()), -1.0F);
}

/// A little-endian number of `size` bytes.
std::uint32_t unsignedNumber(const unsigned char* bytes, std::size_t size) {
    std::uint32_t value = 0; // the low bytes are the first
    std::memcpy(&value, bytes, size);
    return value;
}

} // namespace

GltfAccessor::GltfAccessor(const std::string& file, const gltf::Model& model, int index, Use use,
                           const std::string& referrer) {
    const auto& accessor = gltfElement(file, model.accessors, "accessors", index, referrer);
    const std::string place = fmt::format("/accessors/{}", index);
    if (!isAllowed(accessor, use)) failAtMember(file, place, typeName(accessor), allowedTypes(use));
    components_ = accessor.components;
    componentSize_ = sizeOf(accessor.componentType);
    componentType_ = accessor.componentType;
    normalised_ = accessor.normalized;
    count_ = accessor.count;
    setBase(file, model, accessor, place);
    if (accessor.sparse) setSparse(file, model, *accessor.sparse, place + "/sparse");
}

void GltfAccessor::setBase(const std::string& file, const gltf::Model& model, const gltf::Accessor& accessor,
                           const std::string& place) {
    if (accessor.bufferView < 0) {
        std::size_t bytes = 0;
        for (const gltf::Buffer& buffer : model.buffers) bytes += buffer.size();
        if (count_ > bytes)
            failAtMember(file, place + "/count", std::to_string(count_),
                         fmt::format("at most {} without a buffer view, the bytes of all buffers", bytes));
        return;
    }
    const auto view = gltfViewBytes(file, model, accessor.bufferView, place + "/bufferView");
    stride_ = model.bufferViews[static_cast<std::size_t>(accessor.bufferView)].byteStride;
    if (stride_ == 0) stride_ = elementSize();
    if (stride_ < elementSize())
        failAtMember(file, fmt::format("/bufferViews/{}/byteStride", accessor.bufferView), std::to_string(stride_),
                     fmt::format("at least {} ({})", elementSize(), typeName(accessor)));
    const std::size_t fitting = fittingElements(view.size(), accessor.byteOffset, elementSize(), stride_);
    if (count_ > fitting)
        failAtMember(file, place + "/count", std::to_string(count_),
                     fmt::format("at most {} (bufferView {} has {} bytes)", fitting, accessor.bufferView, view.size()));
    if (count_ > 0) base_ = view.data() + accessor.byteOffset;
}

void GltfAccessor::setSparse(const std::string& file, const gltf::Model& model, const gltf::Sparse& sparse,
                             const std::string& place) {
    if (sparse.indexType != ComponentType::UnsignedByte && sparse.indexType != ComponentType::UnsignedShort &&
        sparse.indexType != ComponentType::UnsignedInt)
        failAtMember(file, place + "/indices/componentType", std::to_string(static_cast<int>(sparse.indexType)),
                     "5121, 5123 or 5125");
    sparseIndexSize_ = sizeOf(sparse.indexType);
    sparseCount_ = sparse.count;
    const auto part = [&](const gltf::Sparse::Part& list, const char* name, std::size_t size) {
        const auto view = gltfViewBytes(file, model, list.bufferView, fmt::format("{}/{}/bufferView", place, name));
        const std::size_t fitting = fittingElements(view.size(), list.byteOffset, size, size);
        if (sparseCount_ > fitting)
            failAtMember(
                file, place + "/count", std::to_string(sparseCount_),
                fmt::format("at most {} {} (bufferView {} has {} bytes)", fitting, name, list.bufferView, view.size()));
        return view.data() + list.byteOffset;
    };
    sparseIndices_ = part(sparse.indices, "indices", sparseIndexSize_);
    sparseValues_ = part(sparse.values, "values", elementSize());

    for (std::size_t k = 0; k < sparseCount_; ++k) {
        const std::uint32_t index = sparseIndex(k);
        if (index >= count_ || (k > 0 && index <= sparseIndex(k - 1)))
            failAtMember(file, place + "/indices", fmt::format("index {} as element {}", index, k),
                         fmt::format("ascending indices below {} (the number of elements)", count_));
    }
}

std::uint32_t GltfAccessor::sparseIndex(std::size_t k) const {
    return unsignedNumber(sparseIndices_ + k * sparseIndexSize_, sparseIndexSize_);
}

const unsigned char* GltfAccessor::bytes(std::size_t k) const {
    std::size_t first = 0; // the sparse element at or behind k
    for (std::size_t end = sparseCount_; first < end;) {
        const std::size_t middle = first + (end - first) / 2;
        if (sparseIndex(middle) < k) {
            first = middle + 1;
        } else {
            end = middle;
        }
    }
    if (first < sparseCount_ && sparseIndex(first) == k) return sparseValues_ + first * elementSize();
    return base_ == nullptr ? nullptr : base_ + k * stride_;
}

glm::vec4 GltfAccessor::element(std::size_t k) const {
    glm::vec4 result(0.0F);
    const unsigned char* source = bytes(k);
    if (source == nullptr) return result;
    for (std::size_t c = 0; c < components_; ++c, source += componentSize_) {
        float& value = result[static_cast<int>(c)];
        switch (componentType_) {
        case ComponentType::Byte:
            value = component<std::int8_t>(source, normalised_);
            break;
        case ComponentType::UnsignedByte:
            value = component<std::uint8_t>(source, normalised_);
            break;
        case ComponentType::Short:
            value = component<std::int16_t>(source, normalised_);
            break;
        case ComponentType::UnsignedShort:
            value = component<std::uint16_t>(source, normalised_);
            break;
        default:
            value = component<float>(source, false);
        }
    }
    return result;
}

std::uint32_t GltfAccessor::index(std::size_t k) const {
    const unsigned char* source = bytes(k);
    return source == nullptr ? 0 : unsignedNumber(source, componentSize_);
}

} // namespace lambert
