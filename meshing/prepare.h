#pragma once

#include "meshing/coplanar_cover.h"
#include "scene/scene.h"

#include <cstddef>

namespace lambert {

struct PrepareOptions {
    /// Else coplanar triangle pairs that make a good quad become one polygon; polygons with the same vertices become one, with
    /// what each shows on its side; where others overlap in one plane, what is covered is taken away, see coverCoplanar; and
    /// points where edges cross become vertices, see edgeCrossings.
    bool keepPolygons = false;
};

struct PrepareReport {
    std::size_t weldedVertices = 0; //!< vertices that coincided with another
    std::size_t collapsedPolygons =
        0; //!< dropped: once their vertices are welded nothing is left, or a needle without height
    std::size_t duplicatePolygons = 0; //!< dropped: the same vertices and the same side as another
    std::size_t mergedSheets = 0;      //!< back to back with another: became the back of that one
    std::size_t edgeCrossings = 0;     //!< vertices added where edges cross
    std::size_t joinedPairs = 0;       //!< triangle pairs that became quads
    CoverReport cover;                 //!< what was covered in its plane
};

/// Lengths below this (metres) are taken for zero when vertices are compared: 1e-6 of the scene's diagonal.
float weldTolerance(const Scene& scene);

/// The scene as meshing and ray casting use it: equal vertices welded, unused ones removed, polygons that vanish dropped,
/// polygons on the same vertices merged (a ray must not choose between them; others win over occluders), triangle pairs
/// joined. Every polygon knows the material and the surface of its back, at the front's corners, and has no surface if it
/// shows none. A sheet of two polygons has holes only if both have, and then those of its front. Polygons stay in the file's
/// order. After the vertices of the polygons, `positions` holds the
/// points where edges cross, which meshing inserts into these edges.
Scene prepareScene(const Scene& scene, const PrepareOptions& options = {}, PrepareReport* report = nullptr);

} // namespace lambert
