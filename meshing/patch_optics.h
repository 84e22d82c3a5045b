#pragma once

#include "core/rgb.h"
#include "meshing/patch_mesh.h"

#include <vector>

namespace lambert {

/// What the patches of a mesh reflect and emit. It is no part of the mesh: other light is solved for on the same one.
struct PatchOptics {
    std::vector<Rgb> reflectance;      //!< #patches, mean over what is not a hole, 0 to 0.99
    std::vector<Rgb> emittedRadiosity; //!< #patches, mean over what is not a hole, B_e = π L_e per m²
};

/// The optics of a division of `scene`: the materials' constants, and for patches of a polygon with a surface (Polygon::surface,
/// backSurface) what its textures and tints make of it, as exact means (see TexelAverage; reflectance is clamped to 0.99).
///
/// - Reflectance is the material's times the mean of the texture times the mean of the tint, a texture and a tint that
///   vary together within a patch being taken for independent.
/// - A back that has holes where the front has none is black in them.
/// - Emission counts the holes exactly where its texture coordinates are those of the reflectance; else they are taken for
///   independent, as they are for an opacity texture that wraps differently from the one it belongs to.
PatchOptics patchOptics(const Scene& scene, const PatchMesh& mesh);

/// Takes the holes out of the mesh: `opacity` is filled if any polygon has holes (the front's, see hasHoles), and `area`, that
/// of the whole patches, becomes that of what is not a hole. It stays above 1e-6 of the whole patch's: kernels divide by it, and
/// of a patch that is one hole nothing is then left but a term that no sum shows.
void measureHoles(const Scene& scene, PatchMesh& mesh);

} // namespace lambert
