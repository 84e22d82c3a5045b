#include "scene/gltf/model.h"

#include <glm/gtc/type_ptr.hpp>
#include <nlohmann/json.hpp>

#include <array>

namespace lambert::gltf {

namespace {

using nlohmann::json;

/// The extension of an object; null if it has none of that name.
const json& extension(const json& object, const char* name) {
    static const json kNone;
    const auto extensions = object.find("extensions");
    if (extensions == object.end()) return kNone;
    const auto found = extensions->find(name);
    return found != extensions->end() && found->is_object() ? *found : kNone;
}

template <typename Value>
void take(const json& source, Value& value) {
    source.get_to(value);
}
template <glm::length_t Length>
void take(const json& source, glm::vec<Length, double>& value) {
    for (glm::length_t k = 0; k < Length; ++k) source[static_cast<std::size_t>(k)].get_to(value[k]);
}

/// Pairs of a member's name and where it goes, which keeps its default where the object lacks the member.
template <typename Value, typename... Pairs>
void read(const json& object, const char* name, Value& value, Pairs&... pairs) {
    if (const auto found = object.find(name); found != object.end()) take(*found, value);
    if constexpr (sizeof...(pairs) > 0) read(object, pairs...);
}

} // namespace

// nlohmann::json finds these by their names, also for lists of what they read.

static void from_json(const json& source, Meshopt& meshopt) {
    read(source, "buffer", meshopt.buffer, "byteOffset", meshopt.byteOffset, "byteLength", meshopt.byteLength,
         "byteStride", meshopt.byteStride, "count", meshopt.count, "mode", meshopt.mode, "filter", meshopt.filter);
}

static void from_json(const json& source, BufferView& view) {
    read(source, "buffer", view.buffer, "byteOffset", view.byteOffset, "byteLength", view.byteLength, "byteStride",
         view.byteStride);
    for (const char* name : {"EXT_meshopt_compression", "KHR_meshopt_compression"}) {
        const json& compressed = extension(source, name);
        if (view.meshopt || compressed.is_null()) continue;
        view.meshopt = compressed.get<Meshopt>();
        view.meshopt->extension = name;
    }
}

static void from_json(const json& source, Sparse::Part& part) {
    read(source, "bufferView", part.bufferView, "byteOffset", part.byteOffset);
}

static void from_json(const json& source, Sparse& sparse) {
    read(source, "count", sparse.count, "indices", sparse.indices, "values", sparse.values);
    read(source["indices"], "componentType", sparse.indexType);
}

static void from_json(const json& source, Accessor& accessor) {
    read(source, "bufferView", accessor.bufferView, "byteOffset", accessor.byteOffset, "count", accessor.count,
         "componentType", accessor.componentType, "type", accessor.type, "normalized", accessor.normalized);
    const auto size = accessor.type == "SCALAR" ? 1U : static_cast<unsigned>(accessor.type.back() - '0');
    accessor.components = accessor.type.starts_with("MAT") ? size * size : size;
    if (source.contains("sparse")) accessor.sparse = source["sparse"].get<Sparse>();
}

static void from_json(const json& source, Draco& draco) {
    read(source, "bufferView", draco.bufferView, "attributes", draco.attributes);
}

static void from_json(const json& source, Primitive& primitive) {
    read(source, "attributes", primitive.attributes, "indices", primitive.indices, "material", primitive.material,
         "mode", primitive.mode);
    primitive.hasTargets = source.contains("targets") && source["targets"].is_array() && !source["targets"].empty();
    const json& draco = extension(source, "KHR_draco_mesh_compression");
    if (!draco.is_null()) primitive.draco = draco.get<Draco>();
}

static void from_json(const json& source, Mesh& mesh) {
    read(source, "name", mesh.name, "primitives", mesh.primitives);
}

static void from_json(const json& source, TextureInfo& info) {
    read(source, "index", info.index, "texCoord", info.texCoord);
    read(extension(source, "KHR_texture_transform"), "offset", info.offset, "scale", info.scale, "rotation",
         info.rotation, "texCoord", info.texCoord);
}

static void from_json(const json& source, SpecularGlossiness& glossy) {
    read(source, "diffuseFactor", glossy.diffuseFactor, "diffuseTexture", glossy.diffuseTexture);
}

static void from_json(const json& source, Material& material) {
    read(source, "name", material.name, "doubleSided", material.doubleSided, "alphaMode", material.alphaMode,
         "alphaCutoff", material.alphaCutoff, "emissiveFactor", material.emissiveFactor, "emissiveTexture",
         material.emissiveTexture);
    if (source.contains("pbrMetallicRoughness"))
        read(source["pbrMetallicRoughness"], "baseColorFactor", material.baseColorFactor, "baseColorTexture",
             material.baseColorTexture, "metallicFactor", material.metallicFactor, "metallicRoughnessTexture",
             material.metallicRoughnessTexture);
    read(extension(source, "KHR_materials_emissive_strength"), "emissiveStrength", material.emissiveStrength);
    read(extension(source, "KHR_materials_transmission"), "transmissionFactor", material.transmissionFactor);
    material.isUnlit = !extension(source, "KHR_materials_unlit").is_null();
    const json& glossy = extension(source, "KHR_materials_pbrSpecularGlossiness");
    if (!glossy.is_null()) material.specularGlossiness = glossy.get<SpecularGlossiness>();
}

static void from_json(const json& source, Texture& texture) {
    read(source, "sampler", texture.sampler, "source", texture.source);
    read(extension(source, "EXT_texture_webp"), "source", texture.webpSource);
    texture.hasBasis = !extension(source, "KHR_texture_basisu").is_null();
}

static void from_json(const json& source, Image& image) {
    read(source, "name", image.name, "uri", image.uri, "bufferView", image.bufferView);
}

static void from_json(const json& source, Sampler& sampler) {
    read(source, "wrapS", sampler.wrapS, "wrapT", sampler.wrapT);
}

static void from_json(const json& source, Camera& camera) {
    read(source, "name", camera.name, "type", camera.type);
    if (camera.type == "perspective") read(source["perspective"], "yfov", camera.yfov);
}

static void from_json(const json& source, Light& light) {
    read(source, "name", light.name, "type", light.type, "color", light.color, "intensity", light.intensity);
    if (light.type == "spot")
        read(source["spot"], "innerConeAngle", light.innerConeAngle, "outerConeAngle", light.outerConeAngle);
}

static void from_json(const json& source, Node& node) {
    read(source, "name", node.name, "children", node.children, "mesh", node.mesh, "camera", node.camera, "translation",
         node.translation, "rotation", node.rotation, "scale", node.scale);
    if (source.contains("matrix")) node.matrix = glm::make_mat4(source["matrix"].get<std::array<double, 16>>().data());
    node.hasSkin = source.contains("skin") && source["skin"].is_number_unsigned();
    read(extension(source, "KHR_lights_punctual"), "light", node.light);
    read(extension(source, "EXT_mesh_gpu_instancing"), "attributes", node.instances);
}

static void from_json(const json& source, Scene& scene) { read(source, "name", scene.name, "nodes", scene.nodes); }

Model modelOf(const json& document) {
    Model model;
    read(document, "extensionsRequired", model.extensionsRequired, "bufferViews", model.bufferViews, "accessors",
         model.accessors, "meshes", model.meshes, "materials", model.materials, "textures", model.textures, "images",
         model.images, "samplers", model.samplers, "cameras", model.cameras, "nodes", model.nodes, "scenes",
         model.scenes, "scene", model.scene);
    read(extension(document, "KHR_lights_punctual"), "lights", model.lights);
    return model;
}

} // namespace lambert::gltf
