#pragma once

#include "baking/reconstruction.h"
#include "lighting/solve_scene.h"

#include <optional>
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

/// Reconstructs the light of a group of `scene`; gathers it if told how. Throws Cancelled.
BakedLight bakeLight(const SolvedScene& scene, SolvedLight light, const ReconstructionOptions& options,
                     const std::optional<FinalGatherOptions>& gather, Progress& progress);

/// The mesh as this group alone lights it. `mesh` is the one that the whole was baked to; its `shown` quantity still decides where
/// quads are split, so that files of all groups have the same vertices and triangles.
BakedMesh withLight(BakedMesh mesh, const BakedLight& light, Quantity shown);

} // namespace lambert
