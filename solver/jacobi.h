#pragma once

#include "core/progress.h"
#include "formfactors/form_factor_matrix.h"
#include "meshing/patch_mesh.h"
#include "solver/solution.h"

namespace lambert {

struct JacobiOptions {
    double tolerance = 1e-4; //!< stop once the relative residual is at most this; 0: only `bounces` decides
    int bounces = 0;         //!< stop after so many iterations, each of which adds one bounce; 0: no limit
    int maxIterations = 10'000;
};

/// Solves B = B_e + ρ F B by Jacobi iteration from B = B_e: one iteration gathers one bounce.
///
/// `matrix` has one row per patch of `mesh`. A limit reached before the tolerance is not an error; see `residual`.
/// Throws InputError if nothing emits light, Cancelled.
RadiositySolution solveJacobi(const PatchMesh& mesh, const FormFactorMatrix& matrix, const JacobiOptions& options,
                              Progress& progress);

/// All terms of the energy balance of a solution, each from its own definition.
EnergyBalance energyBalance(const PatchMesh& mesh, const FormFactorMatrix& matrix, const RadiositySolution& solution);

} // namespace lambert
