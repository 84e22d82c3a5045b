#pragma once

#include "meshing/patch_lookup.h"
#include "scene/scene.h"

#include <array>
#include <cstdint>
#include <utility>
#include <vector>

namespace lambert {

/// A piece of an occluder's border, divided as what it touches is.
struct OccluderEdge {
    std::pair<std::uint32_t, std::uint32_t> vertices; //!< into PatchMesh::positions, the smaller first
    glm::vec3 centroid;                               //!< of the occluder, metres
};

/// A scene divided into patches, as flat arrays for the kernels: the geometry alone, see PatchOptics for the rest. Patches are
/// triangles or convex planar quads.
///
/// Patches [0, frontCount) are the fronts of the source polygons, contiguous per polygon and in the polygons'
/// order. The second sides of two-sided polygons follow, in the same order, with reversed corners.
struct PatchMesh {
    std::vector<glm::vec3> positions; //!< #vertices, metres; shared wherever patches touch
    std::vector<std::array<std::uint32_t, 4>>
        corners; //!< #patches, into positions, counter-clockwise; a triangle ends in kNone

    std::vector<glm::vec3> centroid;     //!< #patches, metres
    std::vector<glm::vec3> normal;       //!< #patches, unit length, to the patch's side
    std::vector<float> area;             //!< #patches, m², of what is not a hole; see measureHoles
    std::vector<float> opacity;          //!< #patches, share of the patch that is not a hole; empty: no holes at all
    std::vector<std::uint32_t> polygon;  //!< #patches, into Scene::polygons
    std::vector<std::uint32_t> material; //!< #patches, into Scene::materials
    std::vector<bool> hidden; //!< #patches, see findHiddenPatches: F_back is 1, no light arrives; empty: none
    std::size_t frontCount = 0;

    std::vector<OccluderEdge> occluderEdges; //!< where light may change abruptly although no patch stands there

    PatchLookup lookup; //!< from a ray's hit to the patch; not for occluders, which have none

    std::size_t size() const { return corners.size(); }
    bool isQuad(std::size_t patch) const { return corners[patch][3] != kNone; }
    bool isHidden(std::size_t patch) const { return !hidden.empty() && hidden[patch]; }
    bool isBack(std::size_t patch) const { return patch >= frontCount; }
    int cornerCount(std::size_t patch) const { return isQuad(patch) ? 4 : 3; }
    const glm::vec3& position(std::size_t patch, int k) const {
        return positions[corners[patch][static_cast<std::size_t>(k)]];
    }
};

} // namespace lambert
