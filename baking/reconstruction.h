#pragma once

#include "baking/baked_mesh.h"
#include "baking/final_gather.h"
#include "meshing/patch_optics.h"
#include "solver/solution.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace lambert {

struct ReconstructionOptions {
    float creaseAngle = 0.52359878F; //!< radians; across a sharper edge nothing is averaged; 0 to π, default 30°
    bool keepHidden = false;         //!< hidden patches (see PatchMesh) are faces like others, not holes
};

/// Light at the vertices as the mean of the patches around a vertex on its smoothing side, weighted by area and by the
/// angle at the vertex; holes have no area. A patch inside another object counts as little as it sees of anything but back
/// faces. Radiosity is B_e + ρ E with all three averaged in this way, so that textures appear as sharp as the patches.
///
/// Face i of the result is patch i of the mesh. `separatedFaces`, if given, becomes the number of patches that could not
/// be connected to their neighbours.
BakedMesh reconstructAverage(const LitPatches& lit, const ReconstructionOptions& options,
                             std::size_t* separatedFaces = nullptr);

/// How far ρ E of a part of a patch may be from that of the whole, squared, #patches: by what `average` (reconstructAverage of `lit`) has
/// at its corners, of which light that varies evenly over a square has a third, and by the solution's own error.
std::vector<Rgb> varianceWithin(const LitPatches& lit, const BakedMesh& average);

/// What gathering at the vertices took, and how far it came.
struct GatherReport {
    std::uint64_t rays = 0;
    std::size_t vertices = 0;  //!< that light was gathered at
    double error = 0.0;        //!< sqrt(mean |standard error|²) / mean E over these and the channels
    double largestError = 0.0; //!< of a vertex, as FinalGatherOptions::error has it
};

/// The same mesh with light gathered at its vertices (see FinalGather, VertexPlaces); reflectance and emission are averaged as above.
/// Where a vertex sees nothing but backs from everywhere, the mean stays. `rays` are of `lit.scene`. The same bits whatever the number
/// of threads. Throws Cancelled.
BakedMesh reconstructGather(const LitPatches& lit, const RayCaster& rays, const LightSources& sources,
                            const ReconstructionOptions& options, const FinalGatherOptions& gather, Progress& progress,
                            GatherReport* report = nullptr, std::size_t* separatedFaces = nullptr);

} // namespace lambert
