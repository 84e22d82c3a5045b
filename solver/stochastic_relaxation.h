#pragma once

#include "core/progress.h"
#include "core/sample_points.h"
#include "formfactors/isotropic_lines.h"
#include "scene/rays/ray_caster.h"
#include "solver/problem.h"
#include "solver/solver_checkpoint.h"
#include "solver/stochastic_solution.h"

#include <cstdint>

namespace lambert {

/// By which lines light goes from patch to patch in regular iterations; shooting goes by local ones.
enum class RelaxationLines {
    Local, ///< from patches, by their power
    Global ///< through the whole scene, see GlobalExchange; what is brightest, as lamps are, still goes by local lines
};

struct StochasticRelaxationOptions {
    std::uint64_t rays = 10'000'000; //!< about so many in all; with a target error at most so many; > 0
    /// Stop once the relative error is below it in 19 of 20 cases, see StochasticSolution; 0: `rays` decides.
    double targetError = 0.0;
    int subRuns = 8; //!< independent runs, which tell the standard error; at least so many; >= 3, 8 or more to trust it
    RelaxationLines lines = RelaxationLines::Local;
    LineSet lineSet = LineSet::Chords; //!< of global lines
    Sampler sampler = Sampler::Sobol;  //!< or Random
    double shootingShare = 0.1;        //!< of a sub-run's rays, for its incremental shooting; 1: nothing else; above 0
    int regularIterations = 6;         //!< of a sub-run, with the rest of its rays; >= 1
    double gatheringShare =
        0.2;                    //!< of the rays of regular iterations, spread over patches whatever their light; 0 to 1
    bool controlVariate = true; //!< in regular iterations
    double unshot = 1e-4; //!< share of the emitted power at which shooting stops; 0: when no ray is drawn, without bias
    std::uint64_t seed = 1;
};

/// Solves B = B_e + ρ E, E = E_0 + F B without form factors: light goes from patch to patch along random lines.
///
/// A sub-run begins with incremental shooting: the power ΔP_i = A_i (B_e,i + ρ_i E_0,i), and then what of it was received and
/// reflected, is sent on until hardly any is left; p_i ∝ Σ_c ΔP_i^c, with the same power per ray throughout. Regular
/// iterations follow, each E = E_0 + F (B_e + ρ E') from the mean E' of all before it, weighted by rays, in which the shooting
/// counts as one. Lines are used both ways (see LocalExchange), about a constant control variate β near the area-weighted
/// median of B. The sequences of the patches' lines go on from one regular iteration to the next.
///
/// Every sub-run is unbiased but for `unshot` (and O(1/rays)), independent of the others, and the result is their mean.
///
/// L. Neumann et al., "The stochastic ray method for radiosity", Rendering Techniques 1995; Ph. Bekaert, "Hierarchical and
/// stochastic algorithms for radiosity", PhD thesis, K. U. Leuven 1999; P. Dutré, K. Bala, P. Bekaert, Advanced Global
/// Illumination, section 6.3.
///
/// `rays` is of the scene of the problem's mesh. A checkpoint is offered the state after every iteration, 76 bytes per patch; what
/// the context has to start from is of no use here.
/// The same bits for the same mesh, options and seed, whatever the number of threads and wherever it was stopped and resumed.
/// Throws UsageError for options out of range, Cancelled, what a checkpoint throws.
StochasticSolution solveStochasticRelaxation(const SolverProblem& problem, const PatchMesh& mesh, const RayCaster& rays,
                                             const StochasticRelaxationOptions& options, Progress& progress,
                                             const SolverContext& context = {});

} // namespace lambert
