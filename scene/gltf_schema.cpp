#include "scene/gltf_schema.h"

#include "scene/gltf_document.h"
#include "scene/input_file.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <limits>

namespace lambert {

namespace {

using nlohmann::json;

enum class Kind { Object, Array, String, Bool, Number, Index, Size, Vector3, Vector4, Matrix };

struct Member {
    std::string_view path; //!< `*` stands for every element
    Kind kind;
    bool required = false; //!< where its parent exists
};

constexpr Member kMembers[] = {
    {"/asset", Kind::Object, true},
    {"/asset/version", Kind::String, true},
    {"/extensionsRequired", Kind::Array},
    {"/extensionsRequired/*", Kind::String},
    {"/scene", Kind::Index},
    {"/scenes", Kind::Array},
    {"/scenes/*", Kind::Object},
    {"/scenes/*/nodes", Kind::Array},
    {"/scenes/*/nodes/*", Kind::Index},
    {"/nodes", Kind::Array},
    {"/nodes/*", Kind::Object},
    {"/nodes/*/name", Kind::String},
    {"/nodes/*/children", Kind::Array},
    {"/nodes/*/children/*", Kind::Index},
    {"/nodes/*/mesh", Kind::Index},
    {"/nodes/*/camera", Kind::Index},
    {"/nodes/*/matrix", Kind::Matrix},
    {"/nodes/*/translation", Kind::Vector3},
    {"/nodes/*/rotation", Kind::Vector4},
    {"/nodes/*/scale", Kind::Vector3},
    {"/meshes", Kind::Array},
    {"/meshes/*", Kind::Object},
    {"/meshes/*/name", Kind::String},
    {"/meshes/*/primitives", Kind::Array, true},
    {"/meshes/*/primitives/*", Kind::Object},
    {"/meshes/*/primitives/*/attributes", Kind::Object, true},
    {"/meshes/*/primitives/*/attributes/*", Kind::Index},
    {"/meshes/*/primitives/*/indices", Kind::Index},
    {"/meshes/*/primitives/*/material", Kind::Index},
    {"/meshes/*/primitives/*/mode", Kind::Index},
    {"/materials", Kind::Array},
    {"/materials/*", Kind::Object},
    {"/materials/*/name", Kind::String},
    {"/materials/*/doubleSided", Kind::Bool},
    {"/materials/*/emissiveFactor", Kind::Vector3},
    {"/materials/*/emissiveTexture", Kind::Object},
    {"/materials/*/emissiveTexture/index", Kind::Index, true},
    {"/materials/*/pbrMetallicRoughness", Kind::Object},
    {"/materials/*/pbrMetallicRoughness/baseColorFactor", Kind::Vector4},
    {"/materials/*/pbrMetallicRoughness/metallicFactor", Kind::Number},
    {"/materials/*/pbrMetallicRoughness/baseColorTexture", Kind::Object},
    {"/materials/*/pbrMetallicRoughness/baseColorTexture/index", Kind::Index, true},
    {"/materials/*/extensions", Kind::Object},
    {"/materials/*/extensions/KHR_materials_emissive_strength", Kind::Object},
    {"/materials/*/extensions/KHR_materials_emissive_strength/emissiveStrength", Kind::Number},
    {"/accessors", Kind::Array},
    {"/accessors/*", Kind::Object},
    {"/accessors/*/bufferView", Kind::Index},
    {"/accessors/*/byteOffset", Kind::Size},
    {"/accessors/*/componentType", Kind::Index, true},
    {"/accessors/*/count", Kind::Size, true},
    {"/accessors/*/type", Kind::String, true},
    {"/accessors/*/sparse", Kind::Object},
    {"/bufferViews", Kind::Array},
    {"/bufferViews/*", Kind::Object},
    {"/bufferViews/*/buffer", Kind::Index, true},
    {"/bufferViews/*/byteOffset", Kind::Size},
    {"/bufferViews/*/byteLength", Kind::Size, true},
    {"/bufferViews/*/byteStride", Kind::Size},
    {"/buffers", Kind::Array},
    {"/buffers/*", Kind::Object},
    {"/buffers/*/uri", Kind::String},
    {"/buffers/*/byteLength", Kind::Size, true},
    {"/cameras", Kind::Array},
    {"/cameras/*", Kind::Object},
    {"/cameras/*/name", Kind::String},
    {"/cameras/*/type", Kind::String, true},
    {"/cameras/*/perspective", Kind::Object},
    {"/cameras/*/perspective/yfov", Kind::Number, true},
    {"/cameras/*/perspective/znear", Kind::Number, true},
};

bool isNumbers(const json& value, std::size_t count) {
    if (!value.is_array() || value.size() != count) return false;
    for (const json& element : value)
        if (!element.is_number()) return false;
    return true;
}

bool hasKind(const json& value, Kind kind) {
    constexpr std::uint64_t kLargestIndex = std::numeric_limits<std::int32_t>::max();
    switch (kind) {
    case Kind::Object:
        return value.is_object();
    case Kind::Array:
        return value.is_array();
    case Kind::String:
        return value.is_string();
    case Kind::Bool:
        return value.is_boolean();
    case Kind::Number:
        return value.is_number();
    case Kind::Index:
        return value.is_number_unsigned() && value.get<std::uint64_t>() <= kLargestIndex;
    case Kind::Size:
        return value.is_number_unsigned();
    case Kind::Vector3:
        return isNumbers(value, 3);
    case Kind::Vector4:
        return isNumbers(value, 4);
    case Kind::Matrix:
        return isNumbers(value, 16);
    }
    return false;
}

const char* nameOf(Kind kind) {
    switch (kind) {
    case Kind::Object:
        return "an object";
    case Kind::Array:
        return "an array";
    case Kind::String:
        return "a string";
    case Kind::Bool:
        return "true or false";
    case Kind::Number:
        return "a number";
    case Kind::Index:
    case Kind::Size:
        return "an integer of at least 0";
    case Kind::Vector3:
        return "3 numbers";
    case Kind::Vector4:
        return "4 numbers";
    case Kind::Matrix:
        return "16 numbers";
    }
    return "";
}

std::string shortForm(const json& value) {
    if (value.is_array() && value.size() > 16) return fmt::format("an array of {}", value.size());
    if (value.is_object()) return "an object";
    return oneLine(value.dump(), 60);
}

/// Follows the rest of a member's path down from `value`, which stands at `place`.
void checkBelow(const std::string& file, const Member& member, std::string_view rest, const json& value,
                const std::string& place) {
    if (rest.empty()) {
        if (!hasKind(value, member.kind)) failAtMember(file, place, shortForm(value), nameOf(member.kind));
        return;
    }
    rest.remove_prefix(1); // the slash
    const std::string_view step = rest.substr(0, rest.find('/'));
    rest.remove_prefix(step.size());
    if (step == "*" && value.is_array()) {
        for (std::size_t k = 0; k < value.size(); ++k)
            checkBelow(file, member, rest, value[k], fmt::format("{}/{}", place, k));
    } else if (step == "*" && value.is_object()) {
        for (const auto& [key, element] : value.items())
            checkBelow(file, member, rest, element, place + '/' + oneLine(key, 60));
    } else if (value.is_object()) {
        const auto found = value.find(std::string(step));
        const std::string below = fmt::format("{}/{}", place, step);
        if (found != value.end()) {
            checkBelow(file, member, rest, *found, below);
        } else if (member.required && rest.empty()) {
            failAtMember(file, below, "nothing", nameOf(member.kind));
        }
    }
}

} // namespace

void checkGltfMembers(const std::string& file, const json& document) {
    for (const Member& member : kMembers) checkBelow(file, member, member.path, document, "");
}

} // namespace lambert
