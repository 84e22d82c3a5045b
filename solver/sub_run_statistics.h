#pragma once

#include "solver/exchange.h"
#include "solver/problem.h"
#include "solver/stochastic_solution.h"

#include <cstdint>
#include <span>
#include <vector>

namespace lambert {

/// Mean and standard error of the results of independent runs, each with a weight in proportion to its rays: the variance of a run is taken
/// to be σ²/rays. Runs of equal weight need no such assumption. 24 bytes per patch.
///
/// D. H. D. West, "Updating mean and variance estimates: an improved method", Communications of the ACM 22(9), 1979.
class SubRunStatistics {
public:
    /// `problem` must outlive it.
    explicit SubRunStatistics(const SolverProblem& problem);

    /// Irradiances (#patches) that `rays` rays found, and what was lost.
    void add(std::span<const Rgb> irradiance, const Losses& losses, std::uint64_t rays);

    int runs() const { return static_cast<int>(deviations_.size()); }
    std::uint64_t rays() const { return rays_; } //!< of all runs
    /// Of the mean at a patch; 0 for fewer than two runs.
    Rgb standardError(std::size_t patch) const;
    /// sqrt(Σ A |standard error|²) / sqrt(Σ A |E|²) over patches and channels: infinite for fewer than two runs, 0 where no light
    /// arrives.
    double relativeError() const;
    /// What the actual relative error, the same with the difference to the truth, exceeds once in twenty times at most. Infinite for
    /// fewer than three runs.
    double upperRelativeError() const;

    /// Passes all that is known of the runs to an archive, see SolverCheckpoint.
    template <typename Archive>
    void keep(Archive& archive) {
        archive(mean_);
        archive(squares_);
        archive(deviations_);
        archive(meanSquare_);
        archive(rays_);
        archive(weight_);
        archive(energy_);
        archive(imbalanceSquares_);
    }

    /// Sets all of the solution that follows from the runs; leaves nothing here.
    void finish(StochasticSolution& solution);

private:
    EnergyBalance balance(std::span<const Rgb> irradiance, const Losses& losses) const;
    /// Of the runs from the second on, relative to their mean.
    double deviationVariance() const;

    const SolverProblem& problem_;
    std::vector<Rgb> mean_;
    std::vector<Rgb> squares_; ///< Σ rays (E − mean)²
    std::vector<double>
        deviations_;          ///< what a run added to Σ A |squares|: the first nothing, the others expect the same
    double meanSquare_ = 0.0; ///< Σ A |mean|²
    std::uint64_t rays_ = 0;
    double weight_ = 0.0; ///< of all runs
    EnergyBalance energy_;
    double imbalanceSquares_ = 0.0; ///< Σ rays (imbalance − mean)²
};

/// Sizes of the sub-runs. Without a target error `runs` of them share the rays. With one, the first `runs` are small; the next ones
/// grow with what there is, up to a quarter of it, as far as the error found so far asks for.
class SubRunSchedule {
public:
    SubRunSchedule(std::uint64_t rays, double targetError, int runs, std::size_t patches);
    /// Rays of the next run; 0: it is enough.
    std::uint64_t next(const SubRunStatistics& statistics) const;

private:
    std::uint64_t rays_, first_;
    double targetError_;
    int runs_;
};

/// Of the random numbers of a sub-run.
std::uint64_t subRunSeed(std::uint64_t seed, int run);

} // namespace lambert
