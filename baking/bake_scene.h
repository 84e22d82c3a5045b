#pragma once

#include "baking/per_light.h"
#include "baking/reconstruction.h"
#include "lighting/solve_scene.h"

#include <optional>
#include <vector>

namespace lambert {

/// Everything between a scene and the light at its vertices.
struct BakeOptions {
    SolveOptions solve;
    ReconstructionOptions reconstruction{};
    std::optional<FinalGatherOptions> gather{}; //!< light is gathered at the vertices; else averaged
    bool perLight = false;                      //!< each group of lights on its own as well
};

/// A scene with its light at vertices.
struct BakedScene : SolvedScene {
    BakedMesh baked{};
    std::vector<BakedLight> lights{}; //!< with BakeOptions::perLight; they add up to `baked` as far as the solver goes
    std::optional<GatherReport> gather{}; //!< with BakeOptions::gather
    std::size_t separatedFaces = 0;       //!< see reconstructAverage
    double bakeSeconds = 0.0;
};

/// solveScene, then reconstruction at the vertices. Throws what solveScene throws.
BakedScene bakeScene(const Scene& scene, const BakeOptions& options, Progress& progress);

} // namespace lambert
