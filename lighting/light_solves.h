#pragma once

#include "lighting/solve_scene.h"

namespace lambert {

/// Light of what emits where it is found apart, see EmitterLight.
struct LightOfMaterials {
    std::vector<std::uint32_t> materials{};        //!< that emit, ascending
    std::vector<std::vector<RgbSum>> irradiance{}; //!< #materials × #patches, E per m²; empty: not found apart

    /// #patches, or empty.
    std::vector<RgbSum> of(std::uint32_t material) const;
};

/// What is solved for, and what with: shared by all ways to find light.
struct LightTask {
    const SolveOptions& options;
    const SolverProblem& problem; ///< of the whole scene
    const LightOfMaterials& emitters;
    const LightSink& sink; ///< empty: groups of lights are not solved for
    SolvedScene& scene;    ///< the result
    Progress& progress;
};

// The whole and, if wanted, each group of lights: solution, account, rays, seconds and checkpoints of the scene.
void findLight(const FormFactorLight& method, const LightTask& task);
void findLight(const LineSolverOptions& method, const LightTask& task);
void findLight(const InstantRadiosityOptions& method, const LightTask& task);

/// Solves one problem on the task's mesh.
using ProblemSolver = std::function<RadiositySolution(const SolverProblem& problem)>;

/// Solves for every group of lights, if the task has a sink for them.
void solveLights(const LightTask& task, const ProblemSolver& solver);

/// The checkpoint of the next solve; null if there are to be none.
SolverCheckpoint* nextCheckpoint(const LightTask& task, std::string identity);

} // namespace lambert
