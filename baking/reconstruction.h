#pragma once

#include "baking/baked_mesh.h"
#include "meshing/patch_optics.h"
#include "solver/solution.h"

#include <cstddef>

namespace lambert {

struct ReconstructionOptions {
    float creaseAngle = 0.52359878F; //!< radians; across a sharper edge nothing is averaged; 0 to π, default 30°
    bool keepHidden = false;   //!< hidden patches (see PatchMesh) are faces like others, not holes
};

/// Light at the vertices as the mean of the patches around a vertex on its smoothing side, weighted by area and by the
/// angle at the vertex; holes have no area. A patch inside another object counts as little as it sees of anything but back
/// faces. Radiosity is B_e + ρ E with all three averaged in this way, so that textures appear as sharp as the patches.
///
/// Face i of the result is patch i of the mesh. `separatedFaces`, if given, becomes the number of patches that could not
/// be connected to their neighbours.
BakedMesh reconstructAverage(const PatchMesh& mesh, const PatchOptics& optics, const Scene& scene,
                             const RadiositySolution& solution, const ReconstructionOptions& options,
                             std::size_t* separatedFaces = nullptr);

} // namespace lambert
