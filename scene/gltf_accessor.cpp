#include "scene/gltf_accessor.h"

#include "core/error.h"
#include "scene/gltf_document.h"

#include <fmt/format.h>
#include <tiny_gltf.h>

#include <array>
#include <cstring>

namespace lambert {

namespace {

struct Element {
    std::size_t components;
    std::size_t componentSize;
};

std::string typeName(const tinygltf::Accessor& accessor) {
    static constexpr std::array<const char*, 7> kComponents = {"BYTE", "UNSIGNED_BYTE", "SHORT", "UNSIGNED_SHORT",
                                                               "INT",  "UNSIGNED_INT",  "FLOAT"};
    const auto component = static_cast<std::size_t>(accessor.componentType - TINYGLTF_COMPONENT_TYPE_BYTE);
    const char* shape = "a matrix";
    if (accessor.type == TINYGLTF_TYPE_SCALAR) shape = "SCALAR";
    if (accessor.type == TINYGLTF_TYPE_VEC2) shape = "VEC2";
    if (accessor.type == TINYGLTF_TYPE_VEC3) shape = "VEC3";
    if (accessor.type == TINYGLTF_TYPE_VEC4) shape = "VEC4";
    return fmt::format("{} {}",
                       component < kComponents.size() ? kComponents[component] : std::to_string(accessor.componentType),
                       shape);
}

Element elementOf(const std::string& file, const std::string& place, const tinygltf::Accessor& accessor,
                  GltfAccessor::Use use) {
    if (use == GltfAccessor::Use::Positions) {
        if (accessor.componentType != TINYGLTF_COMPONENT_TYPE_FLOAT || accessor.type != TINYGLTF_TYPE_VEC3)
            failAtMember(file, place, typeName(accessor), "FLOAT VEC3 for positions");
        return {3, 4};
    }
    if (accessor.type == TINYGLTF_TYPE_SCALAR) {
        if (accessor.componentType == TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE) return {1, 1};
        if (accessor.componentType == TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT) return {1, 2};
        if (accessor.componentType == TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT) return {1, 4};
    }
    failAtMember(file, place, typeName(accessor), "UNSIGNED_BYTE, _SHORT or _INT SCALAR for indices");
}

template <typename List>
const typename List::value_type& at(const std::string& file, const List& list, const char* name, int index,
                                    const std::string& referrer) {
    if (index < 0 || static_cast<std::size_t>(index) >= list.size())
        failAtMember(file, referrer, std::to_string(index),
                     list.empty() ? fmt::format("none: the file has no {}", name)
                                  : fmt::format("0 to {} ({})", list.size() - 1, name));
    return list[static_cast<std::size_t>(index)];
}

} // namespace

GltfAccessor::GltfAccessor(const std::string& file, const tinygltf::Model& model, int index, Use use,
                           const std::string& referrer) {
    const auto& accessor = at(file, model.accessors, "accessors", index, referrer);
    const std::string place = fmt::format("/accessors/{}", index);
    if (accessor.sparse.isSparse)
        failAtMember(file, place + "/sparse", "a sparse accessor", "only accessors without \"sparse\"");
    const Element element = elementOf(file, place, accessor, use);
    const std::size_t elementSize = element.components * element.componentSize;
    if (accessor.bufferView < 0) failAtMember(file, place + "/bufferView", "nothing", "a buffer view");

    const auto& view = at(file, model.bufferViews, "bufferViews", accessor.bufferView, place + "/bufferView");
    const std::string viewPlace = fmt::format("/bufferViews/{}", accessor.bufferView);
    const auto& buffer = at(file, model.buffers, "buffers", view.buffer, viewPlace + "/buffer");
    if (view.byteOffset > buffer.data.size())
        failAtMember(file, viewPlace + "/byteOffset", std::to_string(view.byteOffset),
                     fmt::format("at most {} (buffer {} has so many bytes)", buffer.data.size(), view.buffer));
    if (view.byteLength > buffer.data.size() - view.byteOffset)
        failAtMember(file, viewPlace + "/byteLength", std::to_string(view.byteLength),
                     fmt::format("at most {} (buffer {} has {} bytes)", buffer.data.size() - view.byteOffset,
                                 view.buffer, buffer.data.size()));
    stride_ = view.byteStride == 0 ? elementSize : view.byteStride;
    if (stride_ < elementSize)
        failAtMember(file, viewPlace + "/byteStride", std::to_string(stride_),
                     fmt::format("at least {} ({})", elementSize, typeName(accessor)));

    std::size_t fitting = 0;
    if (accessor.byteOffset <= view.byteLength && elementSize <= view.byteLength - accessor.byteOffset)
        fitting = (view.byteLength - accessor.byteOffset - elementSize) / stride_ + 1;
    if (accessor.count > fitting)
        failAtMember(
            file, place + "/count", std::to_string(accessor.count),
            fmt::format("at most {} (bufferView {} has {} bytes)", fitting, accessor.bufferView, view.byteLength));
    count_ = accessor.count;
    componentSize_ = element.componentSize;
    if (count_ > 0) data_ = buffer.data.data() + view.byteOffset + accessor.byteOffset;
}

glm::vec3 GltfAccessor::position(std::size_t k) const {
    std::array<float, 3> xyz;
    std::memcpy(xyz.data(), data_ + k * stride_, sizeof xyz);
    return {xyz[0], xyz[1], xyz[2]};
}

std::uint32_t GltfAccessor::index(std::size_t k) const {
    std::uint32_t value = 0; // little-endian: the low bytes are the first
    std::memcpy(&value, data_ + k * stride_, componentSize_);
    return value;
}

} // namespace lambert
