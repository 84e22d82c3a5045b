#pragma once

#include "baking/light_groups.h"
#include "baking/mesh_scene.h"
#include "baking/reconstruction.h"
#include "solver/problem.h"
#include "solver/solution.h"

#include <functional>
#include <string>
#include <vector>

namespace lambert {

/// What one group of lights alone brings, at the vertices of the baked mesh. By linearity, all groups add up to the whole, and
/// any of them may be dimmed (or coloured, per channel) by a factor on its radiosity and irradiance.
struct BakedLight {
    LightGroup group;
    EnergyBalance energy;
    std::int64_t iterations = 0;
    double residual = 0.0;
    std::vector<Rgb> radiosity, irradiance; //!< #vertices, per m²
    std::vector<bool> emitters;             //!< #faces, as BakedMesh::emitters
};

/// The mesh as this group alone lights it. `mesh` is the one that the whole was baked to; its `shown` quantity still decides where
/// quads are split, so that files of all groups have the same vertices and triangles.
BakedMesh withLight(BakedMesh mesh, const BakedLight& light, Quantity shown);

/// Light of what emits where it is found apart, see EmitterLight.
struct LightOfMaterials {
    std::vector<std::uint32_t> materials{};        //!< that emit, ascending
    std::vector<std::vector<RgbSum>> irradiance{}; //!< #materials × #patches, E per m²; empty: not found apart

    /// #patches, or empty.
    std::vector<RgbSum> of(std::uint32_t material) const;
};

struct PerLightOptions {
    DirectLightOptions directLight;
    ReconstructionOptions reconstruction;
    const LightOfMaterials& emitters;
};

/// Solves one problem on the mesh of a scene.
using LightSolver = std::function<RadiositySolution(const SolverProblem& problem)>;

/// Solves for every group of lights of the scene. While this runs the mesh emits only what a group does;
/// afterwards it is as before. Throws Cancelled.
std::vector<BakedLight> bakePerLight(MeshedScene& scene, const LightSolver& solver, const PerLightOptions& options,
                                     Progress& progress);

} // namespace lambert
