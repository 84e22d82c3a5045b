#include "solver/sub_run_statistics.h"

#include "core/random.h"
#include "solver/ordered_sum.h"

#include <boost/math/distributions/chi_squared.hpp>
#include <boost/math/distributions/fisher_f.hpp>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace lambert {

namespace {

constexpr double kInfinite = std::numeric_limits<double>::infinity();

constexpr std::uint64_t kRaysPerPatch = 8; ///< of the first sub-runs
constexpr std::uint64_t kFewestRays = 4096;

/// As a float, so that it does not depend on how a processor's mathematical functions round.
template <typename Distribution>
double roundedQuantile(const Distribution& distribution, double probability) {
    return static_cast<double>(static_cast<float>(boost::math::quantile(distribution, probability)));
}

template <typename Value>
void average(Value& mean, const Value& value, double share) {
    mean += share * (value - mean);
}

} // namespace

SubRunStatistics::SubRunStatistics(const SolverProblem& problem)
    : problem_(problem), mean_(problem.size(), Rgb(0.0F)), squares_(problem.size(), Rgb(0.0F)) {}

void SubRunStatistics::add(std::span<const Rgb> irradiance, const Losses& losses, std::uint64_t rays) {
    rays_ += rays;
    const auto weight =
        static_cast<double>(std::max<std::uint64_t>(rays, 1)); // no ray at all tells that little arrives
    weight_ += weight;
    const double share = weight / weight_;
    const glm::dvec2 sums = orderedSum(problem_.size(), glm::dvec2(0.0), [&](std::size_t i) {
        const RgbSum before = RgbSum(irradiance[i]) - RgbSum(mean_[i]);
        const RgbSum mean = RgbSum(mean_[i]) + share * before;
        const RgbSum square = weight * before * (RgbSum(irradiance[i]) - mean);
        mean_[i] = Rgb(mean);
        squares_[i] += Rgb(square);
        return problem_.area(i) * glm::dvec2(sumOf(square), glm::dot(mean, mean));
    });
    deviations_.push_back(deviations_.empty() ? 0.0 : sums.x);
    meanSquare_ = sums.y;

    const EnergyBalance energy = balance(irradiance, losses);
    const double before = energy.imbalance() - energy_.imbalance();
    if (runs() == 1) {
        energy_ = energy;
        return;
    }
    average(energy_.absorbed, energy.absorbed, share);
    average(energy_.backFaces, energy.backFaces, share);
    average(energy_.escaped, energy.escaped, share);
    imbalanceSquares_ += weight * before * (energy.imbalance() - energy_.imbalance());
}

EnergyBalance SubRunStatistics::balance(std::span<const Rgb> irradiance, const Losses& losses) const {
    EnergyBalance energy;
    const auto total = [&](auto&& term) {
        return orderedSum(problem_.size(), RgbSum(0.0), [&](std::size_t i) { return problem_.area(i) * term(i); });
    };
    energy.emitted = total([&](std::size_t i) { return problem_.emitted(i); });
    energy.received = total([&](std::size_t i) { return problem_.direct(i); });
    energy.absorbed =
        total([&](std::size_t i) { return (RgbSum(1.0) - problem_.reflectance(i)) * RgbSum(irradiance[i]); });
    energy.backFaces = losses.backFaces;
    energy.escaped = losses.escaped;
    return energy;
}

Rgb SubRunStatistics::standardError(std::size_t patch) const {
    if (runs() < 2) return Rgb(0.0F);
    const Rgb variance = squares_[patch] / static_cast<float>(weight_ * (runs() - 1));
    return {std::sqrt(variance.x), std::sqrt(variance.y), std::sqrt(variance.z)};
}

double SubRunStatistics::relativeError() const {
    if (runs() < 2) return kInfinite;
    if (!(meanSquare_ > 0.0)) return 0.0;
    const double squares = std::accumulate(deviations_.begin(), deviations_.end(), 0.0);
    return std::sqrt(squares / (weight_ * (runs() - 1)) / meanSquare_);
}

/// From successive differences, which a trend does not reach: larger runs may deviate less than their rays make one expect.
/// J. von Neumann et al., "The mean square successive difference", Annals of Mathematical Statistics 12(2), 1941.
double SubRunStatistics::deviationVariance() const {
    double squares = 0.0;
    for (std::size_t k = 2; k < deviations_.size(); ++k) {
        const double both = deviations_[k] + deviations_[k - 1];
        if (!(both > 0.0)) continue;
        const double difference = 2.0 * (deviations_[k] - deviations_[k - 1]) / both;
        squares += 0.5 * difference * difference;
    }
    return squares / static_cast<double>(runs() - 2);
}

/// Were the error made of n independent parts of equal size, its square would be χ² with n degrees of freedom, as would be each run's
/// deviation, whose relative variance 2/n therefore tells n; and the ratio of error and estimate would have the F distribution.
double SubRunStatistics::upperRelativeError() const {
    if (runs() < 3) return kInfinite;
    const int differences = runs() - 2;
    const double variance =
        deviationVariance() * differences / roundedQuantile(boost::math::chi_squared(differences), 0.05);
    const double degrees = std::clamp(2.0 / std::max(variance, 1e-9), 1.0, 3.0 * static_cast<double>(problem_.size()));
    return relativeError() * std::sqrt(roundedQuantile(boost::math::fisher_f(degrees, degrees * (runs() - 1)), 0.95));
}

void SubRunStatistics::finish(StochasticSolution& solution) {
    solution.iterations = solution.subRuns = runs();
    solution.rays = rays_;
    solution.residual = solution.relativeError = relativeError();
    solution.upperRelativeError = upperRelativeError();
    solution.energy = energy_;
    solution.imbalanceError = std::sqrt(imbalanceSquares_ / (weight_ * (runs() - 1)));
    solution.standardError.reserve(problem_.size());
    for (std::size_t i = 0; i < problem_.size(); ++i) solution.standardError.push_back(standardError(i));
    squares_ = {};
    solution.irradiance.reserve(problem_.size());
    for (const Rgb& mean : mean_) solution.irradiance.emplace_back(mean);
    mean_ = {};
    solution.radiosity.reserve(problem_.size());
    for (std::size_t i = 0; i < problem_.size(); ++i)
        solution.radiosity.push_back(problem_.radiosity(i, solution.irradiance[i]));
}

SubRunSchedule::SubRunSchedule(std::uint64_t rays, double targetError, int runs, std::size_t patches)
    : rays_(rays), first_(rays / static_cast<std::uint64_t>(runs)), targetError_(targetError), runs_(runs) {
    if (targetError > 0.0) first_ = std::min(first_, std::max(kFewestRays, kRaysPerPatch * patches));
    first_ = std::max<std::uint64_t>(first_, 1);
}

std::uint64_t SubRunSchedule::next(const SubRunStatistics& statistics) const {
    if (statistics.runs() < runs_) return first_;
    // What is left of the rays may be so few that a run of them draws none.
    const std::uint64_t left = rays_ - std::min(statistics.rays(), rays_);
    if (targetError_ == 0.0 || left < first_) return 0;
    const double excess = statistics.upperRelativeError() / targetError_;
    if (excess <= 1.0) return 0;
    const auto rays = static_cast<double>(statistics.rays());
    const double wanted = std::clamp((excess * excess - 1.0) * rays, static_cast<double>(first_), 0.25 * rays);
    return std::min(static_cast<std::uint64_t>(wanted), left);
}

std::uint64_t subRunSeed(std::uint64_t seed, int run) {
    return randomKey({static_cast<std::uint32_t>(run), 0, 0, 0x53554252}, seed);
}

} // namespace lambert
