#pragma once

#include "baking/black_backs.h"
#include "baking/energy_check.h"
#include "baking/mesh_scene.h"
#include "baking/per_light.h"
#include "baking/reconstruction.h"
#include "formfactors/matrix_source.h"
#include "solver/direct_light.h"
#include "solver/line_solvers.h"
#include "solver/solver.h"
#include "vpl/instant_radiosity.h"

#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace lambert {

/// Everything between a scene and the light at its vertices.
struct BakeOptions {
    MeshOptions mesh;
    MatrixSource formFactors; //!< its checkpoint is also that of the solvers
    DirectLightOptions directLight;
    SolverOptions solver;
    LineSolverOptions lineSolver; //!< where solver.method usesLines(): instead of form factors
    std::optional<InstantRadiosityOptions> instantRadiosity{}; //!< instead of form factors and solver
    std::filesystem::path warmStart{}; //!< a solution of the same patches that the solver begins from; empty: none
    ReconstructionOptions reconstruction;
    bool perLight = false; //!< each group of lights on its own as well, see bakePerLight
};

/// Seconds of wall time per stage.
struct BakeSeconds {
    double mesh = 0.0, formFactors = 0.0, directLight = 0.0, solve = 0.0, bake = 0.0;
};

/// How the computed rows keep their identities.
struct RowQuality {
    double largestClosureError = 0.0;           //!< max |Σ_j F_ij + F_i,back + F_i,out − 1|
    double meanError = 0.0, largestError = 0.0; //!< of the rows, Σ_j |ΔF_ij| as the method knows it; 0: unknown
    std::size_t entries = 0;                    //!< of the matrix; 0 without one
    std::size_t bytes = 0;
};

/// A scene with its light, and what a caller may want to know of how it came about.
struct BakedScene : MeshedScene {
    RadiositySolution solution{};
    /// What a solver by lines knows beyond the solution, which is moved out of it.
    std::optional<StochasticSolution> stochastic{};
    std::optional<InstantRadiosity> instantRadiosity{}; //!< the same, of light by virtual point lights
    BakedMesh baked{};
    std::vector<BakedLight> lights{}; //!< with BakeOptions::perLight; they add up to `baked` as far as the solver goes

    std::vector<RgbSum> lightsIrradiance{}; //!< #patches, E_0 of lights without area; empty: none
    /// #patches, of all that emits, found apart from the form factors; empty: not found apart.
    std::vector<RgbSum> emittersIrradiance{};
    std::optional<TransportPlan> plan{};                  //!< of the form factors; none: read from a file, or not used
    std::optional<RepairReport> repair{};                 //!< of the form factors; none: not repaired
    std::unique_ptr<MatrixCheckpoint> matrixCheckpoint{}; //!< see SceneMatrix
    std::vector<std::unique_ptr<SolverCheckpoint>> checkpoints{}; //!< to be removed once the result is on the disk
    std::uint64_t rayCount = 0; //!< of the form factors, or of what found the light without them
    RowQuality rows{};
    EnergyCheck energyCheck{};
    BlackBacks blackBacks{};
    std::size_t separatedFaces = 0;
    BakeSeconds seconds{};
    std::vector<std::string> warnings{}; //!< one line each
};

/// The file of a solver's state beside the one of finished rows; empty if that is. `solve` 0 is that of the whole scene, those
/// from 1 on are of its groups of lights.
std::filesystem::path solverCheckpointPath(const CheckpointOptions& rows, std::size_t solve = 0);

/// meshLitScene, then the light of lights without area, form factors (without a matrix: while the solver works), solution, and
/// reconstruction at the vertices. Throws InputError if the scene has no light, Cancelled, what the readers and writers of
/// files throw.
BakedScene bakeScene(const Scene& scene, const BakeOptions& options, Progress& progress);

/// To be called once the result is on the disk.
void removeCheckpoints(const BakedScene& baked);

} // namespace lambert
