#pragma once

#include "core/progress.h"
#include "core/sample_points.h"
#include "scene/rays/ray_caster.h"
#include "solver/problem.h"
#include "solver/solver_checkpoint.h"
#include "solver/stochastic_solution.h"

#include <cstdint>

namespace lambert {

/// Which events of a walk count.
enum class WalkEstimator {
    Collision,  ///< every arrival on a patch
    Absorption, ///< its end on a patch
    Survival    ///< every arrival that it survives; on patches that reflect nothing its end
};

struct RandomWalkOptions {
    std::uint64_t walks = 1'000'000; //!< in all; with a target error at most so many; > 0
    double targetError = 0.0;        //!< see StochasticRelaxationOptions
    int subRuns = 8;                 //!< see StochasticRelaxationOptions
    WalkEstimator estimator = WalkEstimator::Collision;
    Sampler sampler = Sampler::Sobol; //!< of the first ray of each walk; or Random
    std::uint64_t seed = 1;
};

/// Solves B = B_e + ρ E, E = E_0 + F B by discrete random walks of power.
///
/// With S = B_e + ρ E_0, a walk is born on patch i with probability p_i ∝ A_i Σ_c S_i^c and carries A_i S_i^c / (N p_i) per channel. Where
/// it arrives it survives with probability q = max_c ρ^c, which makes its power ρ^c / q times as large, and goes on from another point
/// of the patch. An arrival on j with power w adds to E_j: w / A_j (collision), w / (q A_j) if it survives (survival), w / ((1 − q) A_j)
/// if it does not (absorption). Unbiased. `rays` of the result are those of all walks; a sub-run's walks are its weight.
///
/// P. Dutré, K. Bala, P. Bekaert, Advanced Global Illumination, section 6.4.
///
/// A checkpoint is offered the state every half a million walks, 64 bytes per patch. `rays`, and all else: as
/// solveStochasticRelaxation.
StochasticSolution solveRandomWalks(const SolverProblem& problem, const PatchMesh& mesh, const RayCaster& rays,
                                    const RandomWalkOptions& options, Progress& progress,
                                    const SolverContext& context = {});

} // namespace lambert
