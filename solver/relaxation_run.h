#pragma once

#include "core/progress.h"
#include "solver/fixed_point_sum.h"
#include "solver/global_exchange.h"
#include "solver/local_exchange.h"
#include "solver/stochastic_relaxation.h"

#include <memory>
#include <span>
#include <vector>

namespace lambert {

/// Sub-runs of the stochastic relaxation, one after the other in the same memory.
class RelaxationRun {
public:
    /// All must outlive it.
    RelaxationRun(const SolverProblem& problem, const RayCaster& rays, const StochasticRelaxationOptions& options);

    /// Spends about `rays` rays. Throws Cancelled.
    void run(std::uint64_t rays, std::uint64_t seed, Progress& progress);

    std::span<const Rgb> irradiance() const { return light_; } //!< E of the last run
    const Losses& losses() const { return losses_; }           //!< of the last run
    std::uint64_t rays() const { return rays_; }               //!< of the last run
    double unshot() const { return unshot_; }            //!< of the last run, as a share of the power of B_e + ρ E_0
    const LineCounts& counts() const { return counts_; } //!< of all runs

private:
    double area(std::size_t i) const { return problem_.area(i); }
    Rgb direct(std::size_t i) const { return Rgb(problem_.direct(i)); }
    Rgb source(std::size_t i) const { return Rgb(problem_.source(i)); }
    Rgb reflected(std::size_t i) const { return mesh_.reflectance[i] * light_[i]; }
    Rgb radiosity(std::size_t i) const { return mesh_.emittedRadiosity[i] + reflected(i); }
    double meanReflectance() const;

    void shoot(double rays, Progress& progress);
    void gatherLocally(double rays, Progress& progress);
    void gatherGlobally(double lines, Progress& progress);
    std::uint64_t exchangeLocally(Losses& losses, Progress& progress);
    template <typename Magnitude>
    void setDensities(double rays, double spread, Magnitude&& magnitude);
    void includeInMean(double rays, const Losses& losses);
    template <typename Value>
    Rgb median(Value&& value) const;

    const SolverProblem& problem_;
    const PatchMesh& mesh_;
    const StochasticRelaxationOptions& options_;
    LocalExchange local_;
    std::unique_ptr<LineCaster> lineCaster_; ///< for global lines
    std::unique_ptr<GlobalExchange> global_; ///< null: local lines only
    FixedPointSums received_;
    LineCounts counts_;
    std::vector<Sender> sender_;
    std::vector<Rgb> light_; ///< E; while shooting what of it has arrived, then the mean of all iterations
    ExchangeInput input_;
    Losses losses_;
    std::uint64_t rays_ = 0;
    double area_ = 0.0, rootArea_ = 0.0; ///< Σ A, Σ √A
    double sourcePower_ = 0.0;           ///< Σ A (B_e + ρ E_0), all channels
    double unshot_ = 0.0;
};

} // namespace lambert
