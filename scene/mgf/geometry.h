#pragma once

#include "scene/mgf/contexts.h"
#include "scene/mgf/shapes.h"
#include "scene/scene_builder.h"

#include <glm/mat4x4.hpp>

#include <array>
#include <map>
#include <string>
#include <string_view>
#include <tuple>
#include <unordered_map>
#include <vector>

namespace lambert {

/// The surfaces of an MGF scene: f, fh, sph, cyl, cone, ring, torus and prism become polygons of a scene.
class MgfGeometry {
public:
    /// Both are used as long as this exists. `curveSegments`: see ReadOptions.
    MgfGeometry(SceneBuilder& builder, MgfContexts& contexts, int curveSegments);

    /// Where what follows is put.
    void setTransform(const glm::dmat4& toWorld);
    void setNode(std::uint32_t node) { node_ = node; }

    static bool isSurface(std::string_view keyword);
    /// Carries out an entity that is a surface. Throws InputError.
    void execute(const MgfEntity& entity);

    /// Adds to the report what had to be left out of the materials.
    void warnAboutMaterials();

private:
    void addFace(const MgfEntity& entity);
    void addFaceWithHoles(const MgfEntity& entity);
    void addPrism(const MgfEntity& entity);
    Facets sphere(const MgfEntity& entity) const;
    Facets cone(const MgfEntity& entity) const;
    Facets cylinder(const MgfEntity& entity) const;
    Facets ring(const MgfEntity& entity) const;
    Facets torus(const MgfEntity& entity) const;
    void addFacets(const Facets& facets);
    void addLoop(const MgfEntity& entity, std::vector<glm::dvec3> corners);

    const MgfVertex& vertex(const MgfEntity& entity, std::size_t k) const { return contexts_->vertex(entity, k); }
    const MgfVertex& orientedVertex(const MgfEntity& entity, std::size_t k) const;
    std::uint32_t addPoint(const glm::dvec3& point);
    std::uint32_t material();
    std::string materialName();

    SceneBuilder* builder_;
    MgfContexts* contexts_;
    int curveSegments_;
    glm::dmat4 toWorld_{1.0};
    bool mirrored_ = false; //!< by toWorld_: the order of corners is reversed
    std::uint32_t node_ = 0;

    using MaterialKey = std::tuple<std::string, std::array<float, 6>, bool>;
    std::map<MaterialKey, std::uint32_t> materials_;
    std::unordered_map<std::string, std::size_t> variants_; //!< different materials of one name
    std::vector<std::string> clampedMaterials_, notDiffuseMaterials_;
};

} // namespace lambert
