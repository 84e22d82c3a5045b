#include "core/error.h"
#include "scene/gltf_accessor.h"
#include "scene/gltf_document.h"
#include "scene/gltf_material.h"
#include "scene/gltf_nodes.h"
#include "scene/input_file.h"
#include "scene/scene_builder.h"

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <glm/gtc/constants.hpp>
#include <glm/matrix.hpp>
#include <tiny_gltf.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

namespace lambert {

namespace {

/// Required extensions that leave the geometry and the diffuse part of materials as they are.
constexpr std::array<std::string_view, 16> kHarmlessExtensions = {"KHR_lights_punctual",
                                                                  "KHR_materials_anisotropy",
                                                                  "KHR_materials_clearcoat",
                                                                  "KHR_materials_dispersion",
                                                                  "KHR_materials_emissive_strength",
                                                                  "KHR_materials_ior",
                                                                  "KHR_materials_iridescence",
                                                                  "KHR_materials_sheen",
                                                                  "KHR_materials_specular",
                                                                  "KHR_materials_transmission",
                                                                  "KHR_materials_unlit",
                                                                  "KHR_materials_variants",
                                                                  "KHR_materials_volume",
                                                                  "KHR_texture_basisu",
                                                                  "KHR_texture_transform",
                                                                  "EXT_texture_webp"};

class GltfReader {
public:
    GltfReader(const std::string& file, const tinygltf::Model& model, const ReadOptions& options)
        : file_(file), model_(model), builder_(file, options) {}

    ReadResult run() {
        refuseUnknownExtensions();
        for (const tinygltf::Buffer& buffer : model_.buffers) builder_.countBytes(buffer.data.size());
        materials_ = addGltfMaterials(file_, model_, builder_);
        for (const GltfNode& node : collectGltfNodes(file_, model_)) {
            const tinygltf::Node& source = model_.nodes[static_cast<std::size_t>(node.index)];
            if (source.mesh >= 0) addMesh(node, source);
            if (source.camera >= 0) addCamera(node, source);
        }
        if (ignoredPrimitives_ > 0)
            builder_.warn(fmt::format("{} primitives of points or lines were ignored", ignoredPrimitives_));
        if (deformed_) builder_.warn("skins and morph targets are not applied");
        const auto& used = model_.extensionsUsed;
        if (std::find(used.begin(), used.end(), "KHR_lights_punctual") != used.end())
            builder_.warn("lights of KHR_lights_punctual are not read");
        return builder_.finish();
    }

private:
    void refuseUnknownExtensions() const {
        for (std::size_t k = 0; k < model_.extensionsRequired.size(); ++k) {
            const std::string& name = model_.extensionsRequired[k];
            if (std::find(kHarmlessExtensions.begin(), kHarmlessExtensions.end(), name) == kHarmlessExtensions.end())
                failAtMember(file_, fmt::format("/extensionsRequired/{}", k), inQuotes(name),
                             "only extensions that Lambert knows: export without it");
        }
    }

    void addMesh(const GltfNode& node, const tinygltf::Node& source) {
        if (static_cast<std::size_t>(source.mesh) >= model_.meshes.size())
            failAtMember(file_, fmt::format("/nodes/{}/mesh", node.index), std::to_string(source.mesh),
                         fmt::format("a mesh below {} (the number of meshes)", model_.meshes.size()));
        const tinygltf::Mesh& mesh = model_.meshes[static_cast<std::size_t>(source.mesh)];
        std::string name = source.name.empty() ? mesh.name : source.name;
        if (name.empty()) name = fmt::format("node_{}", node.index);
        node_ = builder_.addNode(std::move(name));
        deformed_ |= source.skin >= 0;

        remapped_.reset();
        for (std::size_t k = 0; k < mesh.primitives.size(); ++k)
            addPrimitive(mesh.primitives[k], fmt::format("/meshes/{}/primitives/{}", source.mesh, k), node.toWorld);
    }

    void addPrimitive(const tinygltf::Primitive& primitive, const std::string& place, const glm::dmat4& toWorld) {
        if (primitive.mode > TINYGLTF_MODE_TRIANGLE_FAN)
            failAtMember(file_, place + "/mode", std::to_string(primitive.mode), "0 to 6");
        if (primitive.mode < TINYGLTF_MODE_TRIANGLES) {
            ++ignoredPrimitives_;
            return;
        }
        const auto attribute = primitive.attributes.find("POSITION");
        if (attribute == primitive.attributes.end())
            failAtMember(file_, place + "/attributes/POSITION", "nothing", "an accessor of positions");
        const GltfAccessor positions(file_, model_, attribute->second, GltfAccessor::Use::Positions,
                                     place + "/attributes/POSITION");
        deformed_ |= !primitive.targets.empty();

        if (remapped_ != attribute->second) {
            remapped_ = attribute->second;
            sceneVertex_.assign(positions.count(), kNone);
        }
        addTriangles(primitive, place, cornersOf(primitive, place, positions, toWorld), toWorld);
    }

    /// The primitive's corners in the order of its indices, as vertices of the scene.
    std::vector<std::uint32_t> cornersOf(const tinygltf::Primitive& primitive, const std::string& place,
                                         const GltfAccessor& positions, const glm::dmat4& toWorld) {
        std::optional<GltfAccessor> indices;
        if (primitive.indices >= 0)
            indices.emplace(file_, model_, primitive.indices, GltfAccessor::Use::Indices, place + "/indices");
        std::vector<std::uint32_t> corners(indices ? indices->count() : positions.count());
        for (std::size_t k = 0; k < corners.size(); ++k) {
            const std::size_t vertex = indices ? indices->index(k) : k;
            if (vertex >= positions.count())
                failAtMember(file_, fmt::format("/accessors/{}", primitive.indices),
                             fmt::format("index {} as element {}", vertex, k),
                             fmt::format("indices below {} (the number of vertices)", positions.count()));
            std::uint32_t& known = sceneVertex_[vertex];
            if (known == kNone)
                known = builder_.addPosition(glm::dvec3(toWorld * glm::dvec4(positions.position(vertex), 1.0)));
            corners[k] = known;
        }
        return corners;
    }

    void addTriangles(const tinygltf::Primitive& primitive, const std::string& place,
                      const std::vector<std::uint32_t>& corners, const glm::dmat4& toWorld) {
        const std::uint32_t material = materialOf(primitive, place);
        const bool mirrored = glm::determinant(glm::dmat3(toWorld)) < 0.0;
        const auto add = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
            builder_.addPolygon(mirrored ? std::array{a, c, b} : std::array{a, b, c}, material, node_);
        };
        if (primitive.mode == TINYGLTF_MODE_TRIANGLES) {
            if (corners.size() % 3 != 0)
                failAtMember(file_, place, fmt::format("triangles with {} corners", corners.size()), "a multiple of 3");
            for (std::size_t k = 0; k < corners.size(); k += 3) add(corners[k], corners[k + 1], corners[k + 2]);
        } else if (primitive.mode == TINYGLTF_MODE_TRIANGLE_STRIP) {
            for (std::size_t k = 0; k + 2 < corners.size(); ++k)
                add(corners[k], corners[k + 1 + k % 2], corners[k + 2 - k % 2]);
        } else {
            for (std::size_t k = 1; k + 1 < corners.size(); ++k) add(corners[0], corners[k], corners[k + 1]);
        }
    }

    std::uint32_t materialOf(const tinygltf::Primitive& primitive, const std::string& place) {
        if (primitive.material < 0) {
            if (!defaultMaterial_) defaultMaterial_ = builder_.addMaterial({.name = "default"});
            return *defaultMaterial_;
        }
        if (static_cast<std::size_t>(primitive.material) >= materials_.size())
            failAtMember(file_, place + "/material", std::to_string(primitive.material),
                         fmt::format("a material below {} (the number of materials)", materials_.size()));
        return materials_[static_cast<std::size_t>(primitive.material)];
    }

    void addCamera(const GltfNode& node, const tinygltf::Node& source) {
        if (static_cast<std::size_t>(source.camera) >= model_.cameras.size())
            failAtMember(file_, fmt::format("/nodes/{}/camera", node.index), std::to_string(source.camera),
                         fmt::format("a camera below {} (the number of cameras)", model_.cameras.size()));
        const tinygltf::Camera& definition = model_.cameras[static_cast<std::size_t>(source.camera)];
        Camera camera;
        camera.name = definition.name.empty() ? source.name : definition.name;
        if (camera.name.empty()) camera.name = fmt::format("camera_{}", source.camera);
        if (definition.type != "perspective") {
            builder_.warn(fmt::format("the orthographic camera {} was ignored", inQuotes(camera.name)));
            return;
        }
        const double fov = definition.perspective.yfov;
        if (!(fov > 0.0 && fov < glm::pi<double>()))
            failAtMember(file_, fmt::format("/cameras/{}/perspective/yfov", source.camera), fmt::format("{:g}", fov),
                         "radians above 0 and below pi");
        const glm::dvec3 eye(node.toWorld[3]);
        const glm::dvec3 direction = glm::normalize(-glm::dvec3(node.toWorld[2]));
        const glm::dvec3 up = glm::normalize(glm::dvec3(node.toWorld[1]));
        const double sine = glm::length(glm::cross(direction, up));
        if (!(sine > 1e-6) || !std::isfinite(glm::dot(eye, eye))) {
            builder_.warn(fmt::format("the camera {} was ignored: its transform is singular", inQuotes(camera.name)));
            return;
        }
        camera.eye = glm::vec3(eye);
        camera.direction = glm::vec3(direction);
        camera.up = glm::vec3(up);
        camera.verticalFov = static_cast<float>(fov);
        builder_.addCamera(std::move(camera));
    }

    const std::string& file_;
    const tinygltf::Model& model_;
    SceneBuilder builder_;
    std::vector<std::uint32_t> materials_; //!< the scene's index of each material of the model
    std::optional<std::uint32_t> defaultMaterial_;
    std::uint32_t node_ = 0;                 //!< of the mesh at work
    std::optional<int> remapped_;            //!< the accessor that sceneVertex_ belongs to
    std::vector<std::uint32_t> sceneVertex_; //!< of each vertex of that accessor, kNone if not used so far
    std::size_t ignoredPrimitives_ = 0;
    bool deformed_ = false;
};

} // namespace

ReadResult readGltf(const std::filesystem::path& path, const ReadOptions& options) {
    if (options.metresPerUnit != 1.0)
        throw UsageError(fmt::format("{}: --unit {} is not possible, glTF is always in metres", path.string(),
                                     options.metresPerUnit));
    const tinygltf::Model model = loadGltfModel(path);
    return GltfReader(path.string(), model, options).run();
}

} // namespace lambert
