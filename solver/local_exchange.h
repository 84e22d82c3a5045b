#pragma once

#include "core/progress.h"
#include "solver/exchange.h"
#include "solver/patch_rays.h"
#include "solver/ray_allotment.h"

#include <span>
#include <vector>

namespace lambert {

/// Exchange by local lines, each used both ways. A line from i to j stands for 1 / (n_i + n_j) of the exchange area
/// X_ij = A_i F_ij = A_j F_ji, where n are the densities of lines on either patch: it brings b_i / (n_i + n_j) to j and b_j / (n_i + n_j)
/// to i (shooting and gathering, combined by the balance heuristic of E. Veach, L. Guibas, "Optimally combining sampling
/// techniques for Monte Carlo rendering", SIGGRAPH 1995; lines used both ways: Ph. Bekaert, "Hierarchical and stochastic
/// algorithms for radiosity", PhD thesis, K. U. Leuven 1999). What only i can reach has n_j = 0.
class LocalExchange {
public:
    /// `mesh` and `rays` (of the same scene) must outlive it. Throws UsageError for samplers other than Random and Sobol.
    LocalExchange(const PatchMesh& mesh, const RayCaster& rays, Sampler sampler);

    /// Restarts the patches' sequences.
    void restart();
    /// Passes how far these are to an archive, see SolverCheckpoint.
    template <typename Archive>
    void keep(Archive& archive) {
        archive(next_);
    }
    /// Sets the scale of `received` (#patches, all 0) and adds to it, to `losses` and to `counts`. Returns the number of rays. Throws
    /// Cancelled.
    std::uint64_t exchange(const ExchangeInput& input, FixedPointSums& received, Losses& losses, LineCounts& counts,
                           Progress& progress);

private:
    struct Scratch;

    void findRuns(const RayAllotment& allotment, std::uint64_t first, std::uint64_t last,
                  std::vector<RayRun>& runs) const;
    void deposit(const ExchangeInput& input, Scratch& scratch, FixedPointSums& received, LineCounts& counts) const;

    const PatchMesh& mesh_;
    PatchRays rays_;
    std::vector<std::uint64_t> next_; ///< of each patch's sequence
};

} // namespace lambert
