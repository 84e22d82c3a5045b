#pragma once

#include "meshing/patch_mesh.h"

namespace lambert {

/// Gives every patch of a polygon with a surface (Polygon::surface, backSurface) what its textures, tints and holes make of
/// it: the area of what is not a hole, and reflectance and emitted radiosity as exact means over that area (see TexelAverage;
/// reflectance is clamped to 0.99). Other patches keep their material's constants. `mesh` is a division of `scene`, with
/// `area` that of the whole patches.
///
/// - Reflectance is the material's times the mean of the texture times the mean of the tint, a texture and a tint that
///   vary together within a patch being taken for independent.
/// - Holes are the front's (see hasHoles). A back that has holes where the front has none is black in them.
/// - Emission counts the holes exactly where its texture coordinates are those of the reflectance; else they are taken for
///   independent, as they are for an opacity texture that wraps differently from the one it belongs to.
///
/// `opacity` is filled if any polygon has holes. `area` stays above 1e-6 of the whole patch's: kernels divide by it, and of a
/// patch that is one hole nothing is then left but a term that no sum shows.
void averageSurfaces(const Scene& scene, PatchMesh& mesh);

} // namespace lambert
