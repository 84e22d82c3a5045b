#pragma once

#include "meshing/patch_mesh.h"

#include <cstdint>

namespace lambert {

/// Area in double, of the corners as they are.
double exactArea(const Scene& scene, const Polygon& polygon);
double exactArea(const PatchMesh& mesh, std::size_t patch);

/// The spacing of floats at the scene's largest coordinate: how far rounding moves a vertex at most.
double coordinateRounding(const Scene& scene);

/// How far a point lies outside of a patch in its plane, or off the plane, metres; 0 inside.
double distanceOutside(const PatchMesh& mesh, std::size_t patch, const glm::vec3& point);
double longestEdge(const PatchMesh& mesh, std::size_t patch);
double shortestEdge(const PatchMesh& mesh, std::size_t patch);

/// Everything that PatchMesh promises: sizes, order, backs, materials, normals, areas, centroids, corners
/// within the polygon; and that the patches of each polygon cover its area.
void expectSoundMesh(const Scene& scene, const PatchMesh& mesh);

/// That no vertex lies inside an edge of a patch: of its own polygon anywhere, of any other on a polygon's
/// border. Compares all with all: for small meshes.
void expectNoTVertex(const Scene& scene, const PatchMesh& mesh);

/// That every edge belongs to two front patches, which run along it in opposite directions.
void expectClosed(const PatchMesh& mesh);

} // namespace lambert
