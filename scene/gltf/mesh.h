#pragma once

#include "core/progress.h"
#include "scene/gltf/accessor.h"
#include "scene/gltf/material.h"

#include <glm/mat4x4.hpp>

#include <optional>
#include <vector>

namespace lambert {

/// Makes polygons of the model's meshes.
class GltfMeshes {
public:
    /// `materials` as addGltfMaterials returned them. Triangles are counted in `progress`.
    GltfMeshes(const std::string& file, const gltf::Model& model, std::vector<GltfMaterial> materials,
               SceneBuilder& builder, Progress& progress)
        : file_(file), model_(model), materials_(std::move(materials)), builder_(builder), progress_(progress) {}

    /// The triangles of a mesh. `mesh` is an index of the model. Throws InputError with the JSON path if what counts them
    /// reaches past its memory.
    std::size_t triangleCount(int mesh) const;

    /// Adds a copy of a mesh to a node of the scene. Throws InputError with the JSON path if an accessor, an index or a
    /// mode is wrong.
    void add(int mesh, const glm::dmat4& toWorld, std::uint32_t node);

    /// Warns of what was left out, once for all meshes.
    void report();

private:
    /// What a primitive is made of.
    struct Source {
        GltfAccessor positions;
        std::optional<GltfAccessor> indices{}, uv{}, emissionUv{}, colours{};
        GltfMaterial material{};
        std::size_t cornerCount() const { return indices ? indices->count() : positions.count(); }
    };
    Source sourceOf(const gltf::Primitive& primitive, const std::string& place);
    std::optional<GltfAccessor> attribute(const gltf::Primitive& primitive, const std::string& place,
                                          const std::string& name, GltfAccessor::Use use, std::size_t count) const;
    std::optional<GltfAccessor> coordinates(const gltf::Primitive& primitive, const std::string& place,
                                            const std::optional<GltfTextureCoordinates>& use, std::size_t count);
    GltfMaterial materialOf(const gltf::Primitive& primitive, const std::string& place);

    void addPrimitive(const gltf::Primitive& primitive, const std::string& place, const glm::dmat4& toWorld,
                      std::uint32_t node);
    std::size_t vertexIndex(const Source& source, const gltf::Primitive& primitive, std::size_t corner) const;
    std::uint32_t sceneVertex(const GltfAccessor& positions, std::size_t vertex, const glm::dmat4& toWorld);

    std::string file_;
    const gltf::Model& model_;
    std::vector<GltfMaterial> materials_;
    SceneBuilder& builder_;
    Progress& progress_;
    std::optional<GltfMaterial> defaultMaterial_;

    /// The scene's vertex of a vertex of the positions at work.
    struct Known {
        std::uint64_t run = 0; //!< valid in this run only
        std::uint32_t vertex = 0;
    };
    std::vector<Known> known_;
    std::uint64_t run_ = 0;           //!< of one accessor in one copy of a mesh
    std::optional<int> runPositions_; //!< that accessor

    std::vector<bool> added_; //!< by mesh; what is counted below is counted in the first copy
    bool isFirstCopy_ = false;
    std::size_t ignoredPrimitives_ = 0, bareTextures_ = 0;
    std::size_t invisibleTriangles_ = 0; //!< in all copies
    bool morphed_ = false;
};

} // namespace lambert
