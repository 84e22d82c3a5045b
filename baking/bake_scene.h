#pragma once

#include "baking/reconstruction.h"
#include "core/progress.h"
#include "formfactors/hemicube.h"
#include "meshing/build_patch_mesh.h"
#include "meshing/prepare.h"
#include "scene/ray_caster.h"
#include "solver/jacobi.h"

#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace lambert {

/// Everything between a scene and the light at its vertices.
struct BakeOptions {
    MeshOptions mesh;
    std::optional<int> resolution; //!< of the hemicubes; none: the largest that keeps to the three bounds
    int largestResolution = 128;   //!< when the resolution is chosen; 16 to 4096
    double mostRays = 1.3e9;       //!< the same, in all: a few minutes on two cores
    std::uint64_t memoryLimit = std::uint64_t{8} << 30; //!< the same, bytes for the form factors
    bool randomRotation = true;                         //!< of the hemicubes
    std::uint64_t seed = 1;
    JacobiOptions jacobi;
    ReconstructionOptions reconstruction;
};

/// Seconds of wall time per stage.
struct BakeSeconds {
    double mesh = 0.0, formFactors = 0.0, solve = 0.0, bake = 0.0;
};

/// How the computed rows keep their identities.
struct RowQuality {
    double largestClosureError = 0.0; //!< max |Σ_j F_ij + F_i,back + F_i,out − 1|
    double backFaceFraction =
        0.0; //!< of the rays from patches that can receive light, area-weighted; occluders are none
    std::string backFaceMaterial; //!< whose back they meet most often; empty if they meet none
    std::size_t entries = 0;      //!< of the matrix
    std::size_t bytes = 0;
};

/// A scene as form factors are computed on it: all but the light.
struct MeshedScene {
    std::shared_ptr<const Scene> scene; //!< as prepared: welded, joined; polygons as the rays see them
    std::unique_ptr<RayCaster> rays;    //!< of `scene`
    PatchMesh mesh;
    int resolution = 0; //!< of the hemicubes, given or chosen
    PrepareReport prepareReport;
    MeshReport meshReport;
};

/// Prepares and meshes a scene, lit or not; `resolution` stays 0. Throws InputError if no polygon has any size, Cancelled.
MeshedScene meshUnlitScene(const Scene& scene, const MeshOptions& options, Progress& progress);

/// Prepares and meshes a scene and chooses the resolution. Throws InputError if the scene has no light, Cancelled.
MeshedScene meshScene(const Scene& scene, const BakeOptions& options, Progress& progress);

/// A scene with its light, and what a caller may want to know of how it came about.
struct BakedScene : MeshedScene {
    RadiositySolution solution{};
    BakedMesh baked{};

    std::uint64_t rayCount = 0;
    RowQuality rows{};
    std::size_t separatedFaces = 0;
    BakeSeconds seconds{};
    std::vector<std::string> warnings{}; //!< one line each
};

/// meshScene, then form factors by hemicube, solution, and reconstruction at the vertices. Throws InputError if the scene
/// has no light, Cancelled.
BakedScene bakeScene(const Scene& scene, const BakeOptions& options, Progress& progress);

} // namespace lambert
