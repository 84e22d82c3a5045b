#include "scene/gltf_schema.h"

#include "scene/gltf_document.h"
#include "scene/input_file.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <limits>
#include <span>

namespace lambert {

namespace {

using nlohmann::json;

enum class Kind { Object, Array, String, Bool, Number, Index, Size, Vector2, Vector3, Vector4, Matrix };

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
    {"/extensions", Kind::Object},
    {"/extensions/KHR_lights_punctual", Kind::Object},
    {"/extensions/KHR_lights_punctual/lights", Kind::Array, true},
    {"/extensions/KHR_lights_punctual/lights/*", Kind::Object},
    {"/extensions/KHR_lights_punctual/lights/*/name", Kind::String},
    {"/extensions/KHR_lights_punctual/lights/*/type", Kind::String, true},
    {"/extensions/KHR_lights_punctual/lights/*/color", Kind::Vector3},
    {"/extensions/KHR_lights_punctual/lights/*/intensity", Kind::Number},
    {"/extensions/KHR_lights_punctual/lights/*/spot", Kind::Object},
    {"/extensions/KHR_lights_punctual/lights/*/spot/innerConeAngle", Kind::Number},
    {"/extensions/KHR_lights_punctual/lights/*/spot/outerConeAngle", Kind::Number},
    {"/scene", Kind::Index},
    {"/scenes", Kind::Array},
    {"/scenes/*", Kind::Object},
    {"/scenes/*/name", Kind::String},
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
    {"/nodes/*/extensions", Kind::Object},
    {"/nodes/*/extensions/KHR_lights_punctual", Kind::Object},
    {"/nodes/*/extensions/KHR_lights_punctual/light", Kind::Index, true},
    {"/nodes/*/extensions/EXT_mesh_gpu_instancing", Kind::Object},
    {"/nodes/*/extensions/EXT_mesh_gpu_instancing/attributes", Kind::Object, true},
    {"/nodes/*/extensions/EXT_mesh_gpu_instancing/attributes/*", Kind::Index},
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
    {"/meshes/*/primitives/*/extensions", Kind::Object},
    {"/meshes/*/primitives/*/extensions/KHR_draco_mesh_compression", Kind::Object},
    {"/meshes/*/primitives/*/extensions/KHR_draco_mesh_compression/bufferView", Kind::Index, true},
    {"/meshes/*/primitives/*/extensions/KHR_draco_mesh_compression/attributes", Kind::Object, true},
    {"/meshes/*/primitives/*/extensions/KHR_draco_mesh_compression/attributes/*", Kind::Index},
    {"/materials", Kind::Array},
    {"/materials/*", Kind::Object},
    {"/materials/*/name", Kind::String},
    {"/materials/*/doubleSided", Kind::Bool},
    {"/materials/*/emissiveFactor", Kind::Vector3},
    {"/materials/*/alphaMode", Kind::String},
    {"/materials/*/alphaCutoff", Kind::Number},
    {"/materials/*/pbrMetallicRoughness", Kind::Object},
    {"/materials/*/pbrMetallicRoughness/baseColorFactor", Kind::Vector4},
    {"/materials/*/pbrMetallicRoughness/metallicFactor", Kind::Number},
    {"/materials/*/extensions", Kind::Object},
    {"/materials/*/extensions/KHR_materials_emissive_strength", Kind::Object},
    {"/materials/*/extensions/KHR_materials_emissive_strength/emissiveStrength", Kind::Number},
    {"/materials/*/extensions/KHR_materials_unlit", Kind::Object},
    {"/materials/*/extensions/KHR_materials_transmission", Kind::Object},
    {"/materials/*/extensions/KHR_materials_transmission/transmissionFactor", Kind::Number},
    {"/materials/*/extensions/KHR_materials_pbrSpecularGlossiness", Kind::Object},
    {"/materials/*/extensions/KHR_materials_pbrSpecularGlossiness/diffuseFactor", Kind::Vector4},
    {"/textures", Kind::Array},
    {"/textures/*", Kind::Object},
    {"/textures/*/source", Kind::Index},
    {"/textures/*/sampler", Kind::Index},
    {"/textures/*/extensions", Kind::Object},
    {"/textures/*/extensions/EXT_texture_webp", Kind::Object},
    {"/textures/*/extensions/EXT_texture_webp/source", Kind::Index},
    {"/images", Kind::Array},
    {"/images/*", Kind::Object},
    {"/images/*/name", Kind::String},
    {"/images/*/uri", Kind::String},
    {"/images/*/bufferView", Kind::Index},
    {"/samplers", Kind::Array},
    {"/samplers/*", Kind::Object},
    {"/samplers/*/wrapS", Kind::Index},
    {"/samplers/*/wrapT", Kind::Index},
    {"/accessors", Kind::Array},
    {"/accessors/*", Kind::Object},
    {"/accessors/*/bufferView", Kind::Index},
    {"/accessors/*/byteOffset", Kind::Size},
    {"/accessors/*/componentType", Kind::Index, true},
    {"/accessors/*/count", Kind::Size, true},
    {"/accessors/*/type", Kind::String, true},
    {"/accessors/*/normalized", Kind::Bool},
    {"/accessors/*/sparse", Kind::Object},
    {"/accessors/*/sparse/count", Kind::Index, true},
    {"/accessors/*/sparse/indices", Kind::Object, true},
    {"/accessors/*/sparse/indices/bufferView", Kind::Index, true},
    {"/accessors/*/sparse/indices/byteOffset", Kind::Index},
    {"/accessors/*/sparse/indices/componentType", Kind::Index, true},
    {"/accessors/*/sparse/values", Kind::Object, true},
    {"/accessors/*/sparse/values/bufferView", Kind::Index, true},
    {"/accessors/*/sparse/values/byteOffset", Kind::Index},
    {"/bufferViews", Kind::Array},
    {"/bufferViews/*", Kind::Object},
    {"/bufferViews/*/buffer", Kind::Index, true},
    {"/bufferViews/*/byteOffset", Kind::Size},
    {"/bufferViews/*/byteLength", Kind::Size, true},
    {"/bufferViews/*/byteStride", Kind::Size},
    {"/bufferViews/*/extensions", Kind::Object},
    {"/buffers", Kind::Array},
    {"/buffers/*", Kind::Object},
    {"/buffers/*/extensions", Kind::Object},
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

/// Below every member of kMeshopt.
constexpr Member kMeshoptMembers[] = {
    {"", Kind::Object},
    {"/buffer", Kind::Index, true},
    {"/byteOffset", Kind::Size},
    {"/byteLength", Kind::Size, true},
    {"/byteStride", Kind::Size, true},
    {"/count", Kind::Size, true},
    {"/mode", Kind::String, true},
    {"/filter", Kind::String},
};
constexpr std::string_view kMeshopt[] = {
    "/bufferViews/*/extensions/EXT_meshopt_compression",
    "/bufferViews/*/extensions/KHR_meshopt_compression",
};

/// Below every member of kTextureInfos.
constexpr Member kTextureInfoMembers[] = {
    {"", Kind::Object},
    {"/index", Kind::Index, true},
    {"/texCoord", Kind::Index},
    {"/extensions", Kind::Object},
    {"/extensions/KHR_texture_transform", Kind::Object},
    {"/extensions/KHR_texture_transform/offset", Kind::Vector2},
    {"/extensions/KHR_texture_transform/rotation", Kind::Number},
    {"/extensions/KHR_texture_transform/scale", Kind::Vector2},
    {"/extensions/KHR_texture_transform/texCoord", Kind::Index},
};
constexpr std::string_view kTextureInfos[] = {
    "/materials/*/emissiveTexture",
    "/materials/*/pbrMetallicRoughness/baseColorTexture",
    "/materials/*/pbrMetallicRoughness/metallicRoughnessTexture",
    "/materials/*/extensions/KHR_materials_pbrSpecularGlossiness/diffuseTexture",
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
    case Kind::Vector2:
        return isNumbers(value, 2);
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
        return "an integer of 0 to 2147483647";
    case Kind::Size:
        return "an integer of at least 0";
    case Kind::Vector2:
        return "2 numbers";
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
    const auto checkAll = [&](std::span<const std::string_view> parents, std::span<const Member> members) {
        for (const std::string_view parent : parents)
            for (const Member& member : members)
                checkBelow(file, member, fmt::format("{}{}", parent, member.path), document, "");
    };
    checkAll(kMeshopt, kMeshoptMembers);
    checkAll(kTextureInfos, kTextureInfoMembers);
}

} // namespace lambert
