#include "core/error.h"
#include "core/progress.h"
#include "core/text.h"
#include "scene/gltf/camera.h"
#include "scene/gltf/document.h"
#include "scene/gltf/draco.h"
#include "scene/gltf/instances.h"
#include "scene/gltf/light.h"
#include "scene/gltf/material.h"
#include "scene/gltf/mesh.h"
#include "scene/gltf/meshopt.h"
#include "scene/gltf/nodes.h"
#include "scene/readers.h"
#include "scene/scene_builder.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

namespace lambert {

namespace {

/// Extensions that a file may require: read here, or without influence on the geometry and the diffuse part of materials.
constexpr std::array<std::string_view, 23> kKnownExtensions = {"EXT_mesh_gpu_instancing",
                                                               "EXT_meshopt_compression",
                                                               "EXT_texture_webp",
                                                               "KHR_draco_mesh_compression",
                                                               "KHR_lights_punctual",
                                                               "KHR_materials_anisotropy",
                                                               "KHR_materials_clearcoat",
                                                               "KHR_materials_dispersion",
                                                               "KHR_materials_emissive_strength",
                                                               "KHR_materials_ior",
                                                               "KHR_materials_iridescence",
                                                               "KHR_materials_pbrSpecularGlossiness",
                                                               "KHR_materials_sheen",
                                                               "KHR_materials_specular",
                                                               "KHR_materials_transmission",
                                                               "KHR_materials_unlit",
                                                               "KHR_materials_variants",
                                                               "KHR_materials_volume",
                                                               "KHR_mesh_quantization",
                                                               "KHR_meshopt_compression",
                                                               "KHR_texture_basisu",
                                                               "KHR_texture_transform",
                                                               "KHR_xmp_json_ld"};

void refuseUnknownExtensions(const std::string& file, const gltf::Model& model) {
    for (std::size_t k = 0; k < model.extensionsRequired.size(); ++k) {
        const std::string& name = model.extensionsRequired[k];
        if (std::find(kKnownExtensions.begin(), kKnownExtensions.end(), name) == kKnownExtensions.end())
            failAtMember(file, fmt::format("/extensionsRequired/{}", k), inQuotes(name),
                         "only extensions that Lambert knows: export without it");
    }
}

class GltfReader {
public:
    GltfReader(const std::filesystem::path& path, const gltf::Model& model, const ReadOptions& options)
        : file_(path.string()),
          model_(model),
          progress_(*options.progress),
          builder_(file_, options),
          meshes_(file_, model, addGltfMaterials(file_, gltfFolder(path), model, builder_), builder_, progress_) {}

    ReadResult run() {
        for (const gltf::Buffer& buffer : model_.buffers) builder_.countBytes(buffer.size());
        const std::vector<GltfNode> nodes = collectGltfNodes(file_, model_);
        warnOfOtherScenes();
        const std::size_t triangles = countTriangles(nodes);
        progress_.begin("read", triangles);
        for (const GltfNode& node : nodes) {
            addMesh(node);
            addGltfCamera(file_, model_, node, builder_);
            addGltfLight(file_, model_, node, builder_);
        }
        progress_.end();
        meshes_.report();
        if (skinned_) builder_.warn("skins are not applied");
        return builder_.finish();
    }

private:
    const gltf::Node& sourceOf(const GltfNode& node) const {
        return model_.nodes[static_cast<std::size_t>(node.index)];
    }

    void warnOfOtherScenes() {
        if (model_.scenes.size() < 2) return;
        const std::size_t read = model_.scene < 0 ? 0 : static_cast<std::size_t>(model_.scene);
        std::string others;
        for (std::size_t k = 0; k < model_.scenes.size() && others.size() < 200; ++k) {
            if (k == read) continue;
            if (!others.empty()) others += ", ";
            others += model_.scenes[k].name.empty() ? std::to_string(k) : inQuotes(model_.scenes[k].name);
        }
        builder_.warn(
            fmt::format("scene {} of {} is read, the others are not: {}", read, model_.scenes.size(), others));
    }

    /// Throws InputError if there are too many: a mesh may stand in many places, so a small file could ask for more than any
    /// memory holds.
    std::size_t countTriangles(const std::vector<GltfNode>& nodes) const {
        const std::size_t most = builder_.mostPolygons();
        std::vector<std::optional<std::size_t>> ofMesh(model_.meshes.size());
        std::size_t sum = 0;
        for (const GltfNode& node : nodes) {
            const int mesh = sourceOf(node).mesh;
            if (mesh < 0) continue;
            auto& triangles = gltfElement(file_, ofMesh, "meshes", mesh, fmt::format("/nodes/{}/mesh", node.index));
            if (!triangles) triangles = meshes_.triangleCount(mesh);
            const std::size_t copies = GltfInstances(file_, model_, node.index).count();
            if (*triangles > 0 && copies > (most - sum) / *triangles)
                throw InputError(
                    fmt::format("{}: /nodes/{}: found {} copies of a mesh of {} triangles after {} others, "
                                "allowed at most {} triangles in all; --most-polygons allows more",
                                file_, node.index, copies, *triangles, sum, most));
            sum += copies * *triangles;
        }
        return sum;
    }

    void addMesh(const GltfNode& node) {
        const gltf::Node& source = sourceOf(node);
        if (source.mesh < 0) return;
        std::string name =
            source.name.empty() ? model_.meshes[static_cast<std::size_t>(source.mesh)].name : source.name;
        if (name.empty()) name = fmt::format("node_{}", node.index);
        const std::uint32_t sceneNode = builder_.addNode(std::move(name));
        skinned_ |= source.hasSkin;

        const GltfInstances instances(file_, model_, node.index);
        for (std::size_t k = 0; k < instances.count(); ++k) {
            const glm::dmat4 toNode = instances.toNode(k);
            builder_.noteSinglePrecision(glm::vec3(toNode[3]), largestScale(node.toWorld));
            meshes_.add(source.mesh, node.toWorld * toNode, sceneNode);
        }
    }

    std::string file_;
    const gltf::Model& model_;
    Progress& progress_;
    SceneBuilder builder_;
    GltfMeshes meshes_;
    bool skinned_ = false;
};

} // namespace

ReadResult readGltf(const std::filesystem::path& path, const ReadOptions& options) {
    if (options.metresPerUnit != 1.0)
        throw UsageError(fmt::format("{}: --unit {} is not possible, glTF is always in metres", path.string(),
                                     options.metresPerUnit));
    gltf::Model model = loadGltfModel(path, options);
    refuseUnknownExtensions(path.string(), model);
    decompressMeshopt(path.string(), model);
    decompressDraco(path.string(), model);
    return GltfReader(path, model, options).run();
}

} // namespace lambert
