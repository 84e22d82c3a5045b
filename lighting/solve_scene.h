#pragma once

#include "lighting/black_backs.h"
#include "lighting/energy_check.h"
#include "lighting/light_groups.h"
#include "lighting/light_method.h"
#include "meshing/mesh_scene.h"
#include "solver/direct_light.h"

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace lambert {

/// Everything between a scene and the light on its patches.
struct SolveOptions {
    MeshOptions mesh;
    DirectLightOptions directLight;
    LightMethod method;
    CheckpointOptions checkpoint{}; //!< of form factors and, beside it, of solvers; instant radiosity keeps none
};

/// Seconds of wall time per stage.
struct SolveSeconds {
    double mesh = 0.0, formFactors = 0.0, directLight = 0.0, solve = 0.0;
};

/// Form factors that were used, and how they came about.
struct FormFactorsUsed {
    std::optional<TransportPlan> plan;          //!< none: read from a file
    std::optional<RepairReport> repair;         //!< none: not repaired
    double largestClosureError = 0.0;           //!< max |Σ_j F_ij + F_i,back + F_i,out − 1|
    double meanError = 0.0, largestError = 0.0; //!< of the rows, Σ_j |ΔF_ij| as the method knows it; 0: unknown
    std::size_t entries = 0, bytes = 0;         //!< of the matrix; 0 without one
};

/// What is known, beyond the solution, of how the light was found: one for each LightMethod; none in the dark, where no light
/// had to be followed.
using LightAccount = std::variant<std::monostate, FormFactorsUsed, StochasticSolution, InstantRadiosity>;

/// A scene with the light on its patches.
struct SolvedScene : MeshedScene {
    RadiositySolution solution{};
    LightAccount account{};                 //!< a solution that it holds was moved out of it
    std::vector<RgbSum> lightsIrradiance{}; //!< #patches, E_0 of lights without area; empty: none
    std::vector<RgbSum>
        emittersIrradiance{};     //!< #patches, of all that emits; empty: not found apart from the form factors
    double largestResidual = 0.0; //!< of the solution and, with a sink, of those of groups of lights
    std::uint64_t rayCount = 0;   //!< of the form factors, or of what found the light without them
    EnergyCheck energyCheck{};
    BlackBacks blackBacks{};
    SolveSeconds seconds{};
    std::vector<std::string> warnings{}; //!< one line each
    /// To be removed once what is made of the result is on the disk, see removeCheckpoints.
    std::unique_ptr<MatrixCheckpoint> matrixCheckpoint{};
    std::vector<std::unique_ptr<SolverCheckpoint>> solverCheckpoints{};

    const FormFactorsUsed* formFactors() const { return std::get_if<FormFactorsUsed>(&account); }
    const StochasticSolution* stochastic() const { return std::get_if<StochasticSolution>(&account); }
    const InstantRadiosity* instantRadiosity() const { return std::get_if<InstantRadiosity>(&account); }
};

/// One group of lights of a scene alone. By linearity all groups add up to the whole, as far as the solver goes.
struct SolvedLight {
    LightGroup group;
    PatchOptics optics; //!< which emit only what the group does
    RadiositySolution solution;
};

/// Takes the light of each group as soon as it is solved for. `scene` is complete but for its warnings and checks.
using LightSink = std::function<void(SolvedLight light, const SolvedScene& scene)>;

/// meshLitScene, then the light of lights without area, form factors if the method has any, and the solution; with a sink also
/// that of every group of lights alone. Throws InputError if the scene has no light, Cancelled, what the readers and writers
/// of files throw.
SolvedScene solveScene(const Scene& scene, const SolveOptions& options, Progress& progress, const LightSink& sink = {});

/// The file of a solver's state beside the one of finished rows; empty if that is. `solve` 0 is that of the whole scene, those
/// from 1 on are of its groups of lights.
std::filesystem::path solverCheckpointPath(const std::filesystem::path& rows, std::size_t solve = 0);

/// To be called once the result is on the disk.
void removeCheckpoints(const SolvedScene& solved);

} // namespace lambert
