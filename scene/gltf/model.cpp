#include "scene/gltf/model.h"

#include "scene/gltf/member.h"

#include <algorithm>
#include <array>

namespace lambert::gltf {

// What of each object is read, with the types that it must have. Types that are not read may stand in accessors that are not
// either.

static void take(const Member& member, ComponentType& type) {
    member.require(member.isUpTo(5130) && !member.isUpTo(5119), "an integer of 5120 to 5130");
    type = static_cast<ComponentType>(member->get<int>());
}

static void take(const Member& source, BufferSource& buffer) {
    source.need("byteLength", buffer.byteLength);
    source.read("uri", buffer.uri);
    for (const char* name : {"EXT_meshopt_compression", "KHR_meshopt_compression"})
        if (const auto compressed = source.extension(name))
            buffer.isFallback |= compressed->find("fallback") && **compressed->find("fallback") == true;
}

static void take(const Member& source, Meshopt& meshopt) {
    source.need("buffer", meshopt.buffer, "byteLength", meshopt.byteLength, "byteStride", meshopt.byteStride, "count",
                meshopt.count, "mode", meshopt.mode);
    source.read("byteOffset", meshopt.byteOffset, "filter", meshopt.filter);
}

static void take(const Member& source, BufferView& view) {
    source.need("buffer", view.buffer, "byteLength", view.byteLength);
    if (const auto stride = source.find("byteStride"))
        stride->require(stride->isUpTo(252) && (*stride)->get<int>() % 4 == 0, "a multiple of 4 from 0 to 252");
    source.read("byteOffset", view.byteOffset, "byteStride", view.byteStride);
    for (const char* name : {"EXT_meshopt_compression", "KHR_meshopt_compression"}) {
        const auto compressed = source.extension(name);
        if (view.meshopt || !compressed) continue;
        take(*compressed, view.meshopt);
        view.meshopt->extension = name;
    }
}

static void take(const Member& source, Sparse::Part& part) {
    source.need("bufferView", part.bufferView);
    source.read("byteOffset", part.byteOffset);
}

static void take(const Member& source, Sparse& sparse) {
    source.need("count", sparse.count, "indices", sparse.indices, "values", sparse.values);
    source.find("indices")->need("componentType", sparse.indexType);
}

static void take(const Member& source, Accessor& accessor) {
    constexpr std::array kTypes{"SCALAR", "VEC2", "VEC3", "VEC4", "MAT2", "MAT3", "MAT4"};
    source.need("componentType", accessor.componentType, "count", accessor.count, "type", accessor.type);
    source.find("type")->require(std::find(kTypes.begin(), kTypes.end(), accessor.type) != kTypes.end(),
                                 "SCALAR, VEC2 to VEC4 or MAT2 to MAT4");
    source.read("bufferView", accessor.bufferView, "byteOffset", accessor.byteOffset, "normalized", accessor.normalized,
                "sparse", accessor.sparse);
    const auto size = accessor.type == "SCALAR" ? 1U : static_cast<unsigned>(accessor.type.back() - '0');
    accessor.components = accessor.type.starts_with("MAT") ? size * size : size;
}

static void take(const Member& source, Draco& draco) {
    source.need("bufferView", draco.bufferView, "attributes", draco.attributes);
}

static void take(const Member& source, Primitive& primitive) {
    source.need("attributes", primitive.attributes);
    source.read("indices", primitive.indices, "material", primitive.material, "mode", primitive.mode);
    const auto targets = source.find("targets");
    primitive.hasTargets = targets && (*targets)->is_array() && !(*targets)->empty();
    if (const auto draco = source.extension("KHR_draco_mesh_compression")) take(*draco, primitive.draco);
}

static void take(const Member& source, Mesh& mesh) {
    source.need("primitives", mesh.primitives);
    source.read("name", mesh.name);
}

static void take(const Member& source, TextureInfo& info) {
    source.need("index", info.index);
    source.read("texCoord", info.texCoord);
    if (const auto transform = source.extension("KHR_texture_transform"))
        transform->read("offset", info.offset, "scale", info.scale, "rotation", info.rotation, "texCoord",
                        info.texCoord);
}

static void take(const Member& source, SpecularGlossiness& glossy) {
    source.read("diffuseFactor", glossy.diffuseFactor, "diffuseTexture", glossy.diffuseTexture);
}

static void take(const Member& source, Material& material) {
    source.read("name", material.name, "doubleSided", material.doubleSided, "alphaMode", material.alphaMode,
                "alphaCutoff", material.alphaCutoff, "emissiveFactor", material.emissiveFactor, "emissiveTexture",
                material.emissiveTexture);
    if (const auto metallic = source.find("pbrMetallicRoughness"))
        metallic->read("baseColorFactor", material.baseColorFactor, "baseColorTexture", material.baseColorTexture,
                       "metallicFactor", material.metallicFactor, "metallicRoughnessTexture",
                       material.metallicRoughnessTexture);
    if (const auto strength = source.extension("KHR_materials_emissive_strength"))
        strength->read("emissiveStrength", material.emissiveStrength);
    if (const auto transmission = source.extension("KHR_materials_transmission"))
        transmission->read("transmissionFactor", material.transmissionFactor);
    material.isUnlit = source.extension("KHR_materials_unlit").has_value();
    if (const auto glossy = source.extension("KHR_materials_pbrSpecularGlossiness"))
        take(*glossy, material.specularGlossiness);
}

static void take(const Member& source, Texture& texture) {
    source.read("sampler", texture.sampler, "source", texture.source);
    if (const auto webp = source.extension("EXT_texture_webp")) webp->read("source", texture.webpSource);
    texture.hasBasis = source.extension("KHR_texture_basisu").has_value();
}

static void take(const Member& source, Image& image) {
    source.read("name", image.name, "uri", image.uri, "bufferView", image.bufferView);
}

static void take(const Member& source, Sampler& sampler) {
    source.read("wrapS", sampler.wrapS, "wrapT", sampler.wrapT);
}

/// The member that an object must have because of its type, of the same name.
static Member ofType(const Member& source, const std::string& type) {
    static const nlohmann::json kNothing(nlohmann::json::value_t::discarded);
    const auto found = source.find(type.c_str());
    if (!found) Member(source, type, kNothing).require(false, fmt::format("an object: the type is {}", inQuotes(type)));
    return *found;
}

static void take(const Member& source, Camera& camera) {
    source.need("type", camera.type);
    source.read("name", camera.name);
    const bool isPerspective = camera.type == "perspective";
    source.find("type")->require(isPerspective || camera.type == "orthographic", "\"perspective\" or \"orthographic\"");
    const Member definition = ofType(source, camera.type);
    double unused = 0.0;
    if (isPerspective)
        definition.need("yfov", camera.yfov, "znear", unused);
    else
        definition.need("xmag", unused, "ymag", unused, "zfar", unused, "znear", unused);
}

static void take(const Member& source, Light& light) {
    source.need("type", light.type);
    source.read("name", light.name, "color", light.color, "intensity", light.intensity);
    if (light.type == "spot")
        ofType(source, light.type).read("innerConeAngle", light.innerConeAngle, "outerConeAngle", light.outerConeAngle);
}

static void take(const Member& source, Node& node) {
    source.read("name", node.name, "children", node.children, "mesh", node.mesh, "camera", node.camera, "matrix",
                node.matrix, "translation", node.translation, "rotation", node.rotation, "scale", node.scale);
    const auto skin = source.find("skin");
    node.hasSkin = skin && (*skin)->is_number_unsigned();
    if (const auto light = source.extension("KHR_lights_punctual")) light->need("light", node.light);
    if (const auto instances = source.extension("EXT_mesh_gpu_instancing"))
        instances->need("attributes", node.instances);
}

static void take(const Member& source, Scene& scene) { source.read("name", scene.name, "nodes", scene.nodes); }

/// Of which only the version is looked at, see requireVersion2.
struct Asset {
    std::string version;
};
static void take(const Member& source, Asset& asset) { source.need("version", asset.version); }

Model modelOf(const std::string& file, const nlohmann::json& document) {
    const Member root(file, document);
    Asset asset;
    root.need("asset", asset);
    Model model;
    root.read("extensionsRequired", model.extensionsRequired, "buffers", model.bufferSources, "bufferViews",
              model.bufferViews, "accessors", model.accessors, "meshes", model.meshes, "materials", model.materials,
              "textures", model.textures, "images", model.images, "samplers", model.samplers, "cameras", model.cameras,
              "nodes", model.nodes, "scenes", model.scenes, "scene", model.scene);
    if (const auto lights = root.extension("KHR_lights_punctual")) lights->need("lights", model.lights);
    return model;
}

} // namespace lambert::gltf
