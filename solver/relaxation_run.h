#pragma once

#include "core/progress.h"
#include "solver/fixed_point_sum.h"
#include "solver/global_exchange.h"
#include "solver/local_exchange.h"
#include "solver/stochastic_relaxation.h"

#include <functional>
#include <memory>
#include <span>
#include <vector>

namespace lambert {

/// Sub-runs of the stochastic relaxation, one after the other in the same memory.
class RelaxationRun {
public:
    /// All must outlive it.
    RelaxationRun(const SolverProblem& problem, const PatchMesh& mesh, const RayCaster& rays,
                  const StochasticRelaxationOptions& options);

    /// Spends about `rays` rays, or what is left of them if an unfinished run was restored. After every iteration there is a
    /// state to keep(). Throws Cancelled, and what `afterIteration` throws.
    void run(std::uint64_t rays, std::uint64_t seed, Progress& progress, const std::function<void()>& afterIteration);

    /// Passes all that the rest of the run, of the same rays and seed, depends on to an archive, see SolverCheckpoint.
    template <typename Archive>
    void keep(Archive& archive) {
        archive(stage_);
        archive(input_.iteration);
        archive(rays_);
        archive(losses_);
        archive(sender_);
        archive(light_);
        local_.keep(archive);
        counts_.keep(archive);
    }

    std::span<const Rgb> irradiance() const { return light_; } //!< E of the last run
    const Losses& losses() const { return losses_; }           //!< of the last run
    std::uint64_t rays() const { return rays_; }               //!< of the last run
    double unshot() const { return unshot_; }            //!< of the last run, as a share of the power of B_e + ρ E_0
    const LineCounts& counts() const { return counts_; } //!< of all runs

private:
    /// How far a run is.
    struct Stage {
        bool begun = false;
        std::int32_t bounces = 0;    ///< that were shot
        std::int32_t iterations = 0; ///< regular ones that are done
        double power = 0.0;          ///< unshot
        std::uint64_t shotRays = 0;  ///< of the shooting
    };

    /// Of B, between global lines and local ones.
    struct Division {
        double cap = 0.0;        ///< of the sum of B's channels; what is above goes by local lines
        double localShare = 0.0; ///< of the lines
    };

    double area(std::size_t i) const { return problem_.area(i); }
    Rgb direct(std::size_t i) const { return Rgb(problem_.direct(i)); }
    Rgb source(std::size_t i) const { return Rgb(problem_.source(i)); }
    const Rgb& rho(std::size_t i) const { return problem_.patches().reflectance[i]; }
    Rgb reflected(std::size_t i) const { return rho(i) * light_[i]; }
    Rgb radiosity(std::size_t i) const { return problem_.patches().emittedRadiosity[i] + reflected(i); }
    double meanReflectance() const;

    void begin();
    void shoot(double rays, std::uint64_t seed, Progress& progress, const std::function<void()>& afterIteration);
    void gatherLocally(double rays, Progress& progress);
    void gatherGlobally(double lines, Progress& progress);
    std::uint64_t exchangeLocally(Losses& losses, Progress& progress);
    template <typename Magnitude>
    void setDensities(double rays, double spread, Magnitude&& magnitude);
    void includeInMean(double rays, const Losses& losses);
    Division divide() const;
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
    Stage stage_;
    Losses losses_;
    std::uint64_t rays_ = 0;
    double area_ = 0.0, rootArea_ = 0.0; ///< Σ A, Σ √A
    double sourcePower_ = 0.0;           ///< Σ A (B_e + ρ E_0), all channels
    double unshot_ = 0.0;
};

} // namespace lambert
