#include "scene/gltf/schema.h"

#include "core/text.h"
#include "scene/gltf/document.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <initializer_list>
#include <span>

namespace lambert {

namespace {

using nlohmann::json;

template <std::size_t Count>
bool isNumbers(const json& value) {
    return value.is_array() && value.size() == Count &&
           std::all_of(value.begin(), value.end(), [](const json& element) { return element.is_number(); });
}

bool isAmong(const json& value, std::initializer_list<const char*> texts) {
    return value.is_string() &&
           std::find(texts.begin(), texts.end(), value.get_ref<const std::string&>()) != texts.end();
}

bool isUpTo(const json& value, std::uint64_t largest) {
    return value.is_number_unsigned() && value.get<std::uint64_t>() <= largest;
}

/// What a member may be.
struct Kind {
    const char* name; //!< for errors
    bool (*holds)(const json& value);
};

constexpr Kind kObject{"an object", [](const json& value) { return value.is_object(); }};
constexpr Kind kArray{"an array", [](const json& value) { return value.is_array(); }};
constexpr Kind kString{"a string", [](const json& value) { return value.is_string(); }};
constexpr Kind kBool{"true or false", [](const json& value) { return value.is_boolean(); }};
constexpr Kind kNumber{"a number", [](const json& value) { return value.is_number(); }};
constexpr Kind kIndex{"an integer of 0 to 2147483647", [](const json& value) { return isUpTo(value, 2147483647); }};
constexpr Kind kSize{"an integer of at least 0", [](const json& value) { return value.is_number_unsigned(); }};
constexpr Kind kVector2{"2 numbers", isNumbers<2>};
constexpr Kind kVector3{"3 numbers", isNumbers<3>};
constexpr Kind kVector4{"4 numbers", isNumbers<4>};
constexpr Kind kMatrix{"16 numbers", isNumbers<16>};
constexpr Kind kStride{"a multiple of 4 from 0 to 252",
                       [](const json& value) { return isUpTo(value, 252) && value.get<int>() % 4 == 0; }};
// Types that are not read may stand in accessors that are not either.
constexpr Kind kComponentType{"an integer of 5120 to 5130",
                              [](const json& value) { return isUpTo(value, 5130) && !isUpTo(value, 5119); }};
constexpr Kind kElementType{"SCALAR, VEC2 to VEC4 or MAT2 to MAT4", [](const json& value) {
                                return isAmong(value, {"SCALAR", "VEC2", "VEC3", "VEC4", "MAT2", "MAT3", "MAT4"});
                            }};
constexpr Kind kCameraType{"\"perspective\" or \"orthographic\"", [](const json& value) {
                               return isAmong(value, {"perspective", "orthographic"});
                           }};

struct Member {
    std::string_view path; //!< `*` stands for every element
    Kind kind;
    bool required = false; //!< where its parent exists
};

constexpr Member kMembers[] = {
    {"/asset", kObject, true},
    {"/asset/version", kString, true},
    {"/extensionsRequired", kArray},
    {"/extensionsRequired/*", kString},
    {"/extensions", kObject},
    {"/extensions/KHR_lights_punctual", kObject},
    {"/extensions/KHR_lights_punctual/lights", kArray, true},
    {"/extensions/KHR_lights_punctual/lights/*", kObject},
    {"/extensions/KHR_lights_punctual/lights/*/name", kString},
    {"/extensions/KHR_lights_punctual/lights/*/type", kString, true},
    {"/extensions/KHR_lights_punctual/lights/*/color", kVector3},
    {"/extensions/KHR_lights_punctual/lights/*/intensity", kNumber},
    {"/extensions/KHR_lights_punctual/lights/*/spot", kObject},
    {"/extensions/KHR_lights_punctual/lights/*/spot/innerConeAngle", kNumber},
    {"/extensions/KHR_lights_punctual/lights/*/spot/outerConeAngle", kNumber},
    {"/scene", kIndex},
    {"/scenes", kArray},
    {"/scenes/*", kObject},
    {"/scenes/*/name", kString},
    {"/scenes/*/nodes", kArray},
    {"/scenes/*/nodes/*", kIndex},
    {"/nodes", kArray},
    {"/nodes/*", kObject},
    {"/nodes/*/name", kString},
    {"/nodes/*/children", kArray},
    {"/nodes/*/children/*", kIndex},
    {"/nodes/*/mesh", kIndex},
    {"/nodes/*/camera", kIndex},
    {"/nodes/*/matrix", kMatrix},
    {"/nodes/*/translation", kVector3},
    {"/nodes/*/rotation", kVector4},
    {"/nodes/*/scale", kVector3},
    {"/nodes/*/extensions", kObject},
    {"/nodes/*/extensions/KHR_lights_punctual", kObject},
    {"/nodes/*/extensions/KHR_lights_punctual/light", kIndex, true},
    {"/nodes/*/extensions/EXT_mesh_gpu_instancing", kObject},
    {"/nodes/*/extensions/EXT_mesh_gpu_instancing/attributes", kObject, true},
    {"/nodes/*/extensions/EXT_mesh_gpu_instancing/attributes/*", kIndex},
    {"/meshes", kArray},
    {"/meshes/*", kObject},
    {"/meshes/*/name", kString},
    {"/meshes/*/primitives", kArray, true},
    {"/meshes/*/primitives/*", kObject},
    {"/meshes/*/primitives/*/attributes", kObject, true},
    {"/meshes/*/primitives/*/attributes/*", kIndex},
    {"/meshes/*/primitives/*/indices", kIndex},
    {"/meshes/*/primitives/*/material", kIndex},
    {"/meshes/*/primitives/*/mode", kIndex},
    {"/meshes/*/primitives/*/extensions", kObject},
    {"/meshes/*/primitives/*/extensions/KHR_draco_mesh_compression", kObject},
    {"/meshes/*/primitives/*/extensions/KHR_draco_mesh_compression/bufferView", kIndex, true},
    {"/meshes/*/primitives/*/extensions/KHR_draco_mesh_compression/attributes", kObject, true},
    {"/meshes/*/primitives/*/extensions/KHR_draco_mesh_compression/attributes/*", kIndex},
    {"/materials", kArray},
    {"/materials/*", kObject},
    {"/materials/*/name", kString},
    {"/materials/*/doubleSided", kBool},
    {"/materials/*/emissiveFactor", kVector3},
    {"/materials/*/alphaMode", kString},
    {"/materials/*/alphaCutoff", kNumber},
    {"/materials/*/pbrMetallicRoughness", kObject},
    {"/materials/*/pbrMetallicRoughness/baseColorFactor", kVector4},
    {"/materials/*/pbrMetallicRoughness/metallicFactor", kNumber},
    {"/materials/*/extensions", kObject},
    {"/materials/*/extensions/KHR_materials_emissive_strength", kObject},
    {"/materials/*/extensions/KHR_materials_emissive_strength/emissiveStrength", kNumber},
    {"/materials/*/extensions/KHR_materials_unlit", kObject},
    {"/materials/*/extensions/KHR_materials_transmission", kObject},
    {"/materials/*/extensions/KHR_materials_transmission/transmissionFactor", kNumber},
    {"/materials/*/extensions/KHR_materials_pbrSpecularGlossiness", kObject},
    {"/materials/*/extensions/KHR_materials_pbrSpecularGlossiness/diffuseFactor", kVector4},
    {"/textures", kArray},
    {"/textures/*", kObject},
    {"/textures/*/source", kIndex},
    {"/textures/*/sampler", kIndex},
    {"/textures/*/extensions", kObject},
    {"/textures/*/extensions/EXT_texture_webp", kObject},
    {"/textures/*/extensions/EXT_texture_webp/source", kIndex},
    {"/images", kArray},
    {"/images/*", kObject},
    {"/images/*/name", kString},
    {"/images/*/uri", kString},
    {"/images/*/bufferView", kIndex},
    {"/samplers", kArray},
    {"/samplers/*", kObject},
    {"/samplers/*/wrapS", kIndex},
    {"/samplers/*/wrapT", kIndex},
    {"/accessors", kArray},
    {"/accessors/*", kObject},
    {"/accessors/*/bufferView", kIndex},
    {"/accessors/*/byteOffset", kSize},
    {"/accessors/*/componentType", kComponentType, true},
    {"/accessors/*/count", kSize, true},
    {"/accessors/*/type", kElementType, true},
    {"/accessors/*/normalized", kBool},
    {"/accessors/*/sparse", kObject},
    {"/accessors/*/sparse/count", kIndex, true},
    {"/accessors/*/sparse/indices", kObject, true},
    {"/accessors/*/sparse/indices/bufferView", kIndex, true},
    {"/accessors/*/sparse/indices/byteOffset", kIndex},
    {"/accessors/*/sparse/indices/componentType", kIndex, true},
    {"/accessors/*/sparse/values", kObject, true},
    {"/accessors/*/sparse/values/bufferView", kIndex, true},
    {"/accessors/*/sparse/values/byteOffset", kIndex},
    {"/bufferViews", kArray},
    {"/bufferViews/*", kObject},
    {"/bufferViews/*/buffer", kIndex, true},
    {"/bufferViews/*/byteOffset", kSize},
    {"/bufferViews/*/byteLength", kSize, true},
    {"/bufferViews/*/byteStride", kStride},
    {"/bufferViews/*/extensions", kObject},
    {"/buffers", kArray},
    {"/buffers/*", kObject},
    {"/buffers/*/extensions", kObject},
    {"/buffers/*/uri", kString},
    {"/buffers/*/byteLength", kSize, true},
    {"/cameras", kArray},
    {"/cameras/*", kObject},
    {"/cameras/*/name", kString},
    {"/cameras/*/type", kCameraType, true},
    {"/cameras/*/perspective", kObject},
    {"/cameras/*/perspective/yfov", kNumber, true},
    {"/cameras/*/perspective/znear", kNumber, true},
    {"/cameras/*/orthographic", kObject},
    {"/cameras/*/orthographic/xmag", kNumber, true},
    {"/cameras/*/orthographic/ymag", kNumber, true},
    {"/cameras/*/orthographic/zfar", kNumber, true},
    {"/cameras/*/orthographic/znear", kNumber, true},
};

/// Below every member of kMeshopt.
constexpr Member kMeshoptMembers[] = {
    {"", kObject},
    {"/buffer", kIndex, true},
    {"/byteOffset", kSize},
    {"/byteLength", kSize, true},
    {"/byteStride", kSize, true},
    {"/count", kSize, true},
    {"/mode", kString, true},
    {"/filter", kString},
};
constexpr std::string_view kMeshopt[] = {
    "/bufferViews/*/extensions/EXT_meshopt_compression",
    "/bufferViews/*/extensions/KHR_meshopt_compression",
};

/// Below every member of kTextureInfos.
constexpr Member kTextureInfoMembers[] = {
    {"", kObject},
    {"/index", kIndex, true},
    {"/texCoord", kIndex},
    {"/extensions", kObject},
    {"/extensions/KHR_texture_transform", kObject},
    {"/extensions/KHR_texture_transform/offset", kVector2},
    {"/extensions/KHR_texture_transform/rotation", kNumber},
    {"/extensions/KHR_texture_transform/scale", kVector2},
    {"/extensions/KHR_texture_transform/texCoord", kIndex},
};
constexpr std::string_view kTextureInfos[] = {
    "/materials/*/emissiveTexture",
    "/materials/*/pbrMetallicRoughness/baseColorTexture",
    "/materials/*/pbrMetallicRoughness/metallicRoughnessTexture",
    "/materials/*/extensions/KHR_materials_pbrSpecularGlossiness/diffuseTexture",
};

std::string shortForm(const json& value) {
    if (value.is_array() && value.size() > 16) return fmt::format("an array of {}", value.size());
    if (value.is_object()) return "an object";
    return oneLine(value.dump(), 60);
}

/// Follows the rest of a member's path down from `value`, which stands at `place`.
void checkBelow(const std::string& file, const Member& member, std::string_view rest, const json& value,
                const std::string& place) {
    if (rest.empty()) {
        if (!member.kind.holds(value)) failAtMember(file, place, shortForm(value), member.kind.name);
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
            failAtMember(file, below, "nothing", member.kind.name);
        }
    }
}

/// Of every element of `list` whose type is `type`, the member of that name.
void requireMemberOfType(const std::string& file, const json& document, const std::string& list, const char* type) {
    const json::json_pointer pointer(list);
    if (!document.contains(pointer)) return;
    const json& elements = document[pointer];
    for (std::size_t k = 0; k < elements.size(); ++k)
        if (elements[k]["type"] == type && !elements[k].contains(type))
            failAtMember(file, fmt::format("{}/{}/{}", list, k, type), "nothing",
                         fmt::format("an object: the type is {}", inQuotes(type)));
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
    for (const char* type : {"perspective", "orthographic"}) requireMemberOfType(file, document, "/cameras", type);
    requireMemberOfType(file, document, "/extensions/KHR_lights_punctual/lights", "spot");
}

} // namespace lambert
