#include "solver/relaxation_run.h"

#include "core/random.h"
#include "solver/ordered_sum.h"

#include <glm/common.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

namespace lambert {

namespace {

constexpr int kMostBounces = 10'000;
constexpr std::size_t kMedianSample = 4096;       ///< patches, about
constexpr double kLeastShare = 0.1;               ///< of either kind of lines, where both are used
constexpr double kLinesPerIteration = 2 * 1024.0; ///< global lines at least, or there are fewer iterations
/// Of local lines, over that of independent ones: low-discrepancy sequences lessen it more than that of global lines. Measured
/// on rooms; half or twice as much costs some percent.
constexpr double kLocalError = 0.7;
constexpr std::size_t kCaps = 32; ///< that are tried, each √2 above the next

/// Of sequences of lines. Every bounce of the shooting has its own, and so have regular iterations: a patch that one bounce found too
/// bright would with a sequence that goes on send fewer lines to where it had sent too many, and so lose some of its light, 1e-4 for
/// 100 rays per patch. Regular iterations go on with one sequence, which lessens their noise by a sixth and loses hardly any
/// light; global lines, where it lessens little, have another in each.
std::uint64_t sequenceSeed(std::uint64_t seed, std::uint32_t stage, std::int32_t number) {
    return randomKey({static_cast<std::uint32_t>(number), stage, 0, 0x53455155}, seed);
}

constexpr std::uint32_t kShooting = 0, kRegular = 1, kGlobal = 2; ///< stages

double sumOfMagnitudes(const Rgb& colour) { return sumOf(RgbSum(glm::abs(colour))); }

} // namespace

RelaxationRun::RelaxationRun(const SolverProblem& problem, const PatchMesh& mesh, const RayCaster& rays,
                             const StochasticRelaxationOptions& options)
    : problem_(problem),
      mesh_(mesh),
      options_(options),
      local_(mesh_, rays, options.sampler),
      received_(problem.size()),
      counts_(problem.size()),
      sender_(problem.size()),
      light_(problem.size(), Rgb(0.0F)) {
    if (options.lines == RelaxationLines::Global) {
        lineCaster_ = std::make_unique<LineCaster>(rays.scene());
        global_ = std::make_unique<GlobalExchange>(mesh_, *lineCaster_, options.lineSet, options.sampler);
    }
    area_ = orderedSum(problem.size(), 0.0, [&](std::size_t i) { return area(i); });
    rootArea_ = orderedSum(problem.size(), 0.0, [&](std::size_t i) { return std::sqrt(area(i)); });
    sourcePower_ = orderedSum(problem.size(), 0.0, [&](std::size_t i) { return area(i) * sumOf(RgbSum(source(i))); });
}

void RelaxationRun::begin() {
    input_.iteration = 0;
    losses_ = {};
    rays_ = 0;
    local_.restart();
    forPatches(mesh_.size(), [&](std::size_t i) {
        sender_[i].excess = source(i);
        light_[i] = direct(i);
    });
    stage_ = {};
    stage_.begun = true;
    stage_.power = sourcePower_;
}

void RelaxationRun::run(std::uint64_t rays, std::uint64_t seed, Progress& progress,
                        const std::function<void()>& afterIteration) {
    if (!stage_.begun) begin();
    input_.senders = sender_;
    shoot(options_.shootingShare * static_cast<double>(rays), seed, progress, afterIteration);
    const double rest = std::max(1.0, static_cast<double>(rays) - static_cast<double>(stage_.shotRays));
    int iterations = options_.shootingShare == 1.0 ? 0 : options_.regularIterations;
    if (global_ && iterations > 0) iterations = std::clamp(static_cast<int>(rest / kLinesPerIteration), 1, iterations);
    input_.seed = sequenceSeed(seed, kRegular, 0);
    while (stage_.iterations < iterations) {
        if (stage_.iterations == 0) local_.restart();
        if (global_) { // whose lines come in blocks, so that what one iteration took too many the next ones take less
            const double left = std::max(1.0, static_cast<double>(rays) - static_cast<double>(rays_));
            const double lines = left / (iterations - stage_.iterations);
            global_->restart(sequenceSeed(seed, kGlobal, stage_.iterations), lines);
            gatherGlobally(lines, progress);
        } else {
            gatherLocally(rest / iterations, progress);
        }
        ++stage_.iterations;
        afterIteration();
    }
    stage_.begun = false;
}

std::uint64_t RelaxationRun::exchangeLocally(Losses& losses, Progress& progress) {
    const std::uint64_t rays = local_.exchange(input_, received_, losses, counts_, progress);
    ++input_.iteration;
    return rays;
}

void RelaxationRun::shoot(double rays, std::uint64_t seed, Progress& progress,
                          const std::function<void()>& afterIteration) {
    input_.control = Rgb(0.0F);
    // As many rays for the first bounce as will make about `rays` in all.
    const double perPower = rays / sourcePower_ * (1.0 - meanReflectance());
    while (stage_.bounces < kMostBounces && stage_.power > options_.unshot * sourcePower_) {
        const double power = stage_.power;
        const double lines = perPower * power; // the mean of the whole number that is drawn
        forPatches(mesh_.size(), [&](std::size_t i) {
            sender_[i].density = static_cast<float>(lines * sumOf(RgbSum(sender_[i].excess)) / power);
        });
        local_.restart();
        input_.seed = sequenceSeed(seed, kShooting, stage_.bounces);
        rays_ += exchangeLocally(losses_, progress);
        stage_.power = orderedSum(mesh_.size(), 0.0, [&](std::size_t i) {
            const Rgb received(received_.take(i) / area(i));
            light_[i] += received;
            sender_[i].excess = rho(i) * received;
            return area(i) * sumOf(RgbSum(sender_[i].excess));
        });
        stage_.shotRays = rays_;
        ++stage_.bounces;
        afterIteration();
    }
    unshot_ = sourcePower_ > 0.0 ? stage_.power / sourcePower_ : 0.0;
}

/// Σ A ρ / Σ A, of the largest channel.
double RelaxationRun::meanReflectance() const {
    return orderedSum(mesh_.size(), 0.0, [&](std::size_t i) { return area(i) * largest(rho(i)); }) / area_;
}

/// Rays by power, a share of them evenly over the patches. The error Σ A_i var(E_i) of gathering Σ A_i n_i rays is least if n_i goes
/// with 1/√A_i.
template <typename Magnitude>
void RelaxationRun::setDensities(double rays, double spread, Magnitude&& magnitude) {
    const double power = orderedSum(mesh_.size(), 0.0, [&](std::size_t i) { return area(i) * magnitude(i); });
    if (!(power > 0.0)) spread = 1.0;
    const double perPower = power > 0.0 ? (1.0 - spread) * rays / power : 0.0;
    const double perRoot = spread * rays / rootArea_;
    forPatches(mesh_.size(), [&](std::size_t i) {
        sender_[i].density = static_cast<float>(perPower * magnitude(i) + perRoot / std::sqrt(area(i)));
    });
}

void RelaxationRun::includeInMean(double rays, const Losses& losses) {
    const double share = rays / static_cast<double>(rays_);
    losses_.backFaces += share * (losses.backFaces - losses_.backFaces);
    losses_.escaped += share * (losses.escaped - losses_.escaped);
}

/// E = E_0 + F B by local lines.
void RelaxationRun::gatherLocally(double rays, Progress& progress) {
    input_.control = options_.controlVariate ? median([&](std::size_t i) { return radiosity(i); }) : Rgb(0.0F);
    forPatches(mesh_.size(), [&](std::size_t i) { sender_[i].excess = radiosity(i) - input_.control; });
    setDensities(rays, options_.gatheringShare, [&](std::size_t i) { return sumOfMagnitudes(sender_[i].excess); });
    Losses losses;
    const std::uint64_t count = exchangeLocally(losses, progress);
    if (count == 0) return;
    rays_ += count;
    includeInMean(static_cast<double>(count), losses);
    const auto share = static_cast<float>(static_cast<double>(count) / static_cast<double>(rays_));
    forPatches(mesh_.size(), [&](std::size_t i) {
        const Rgb found = direct(i) + input_.control + Rgb(received_.take(i) / area(i));
        light_[i] += share * (found - light_[i]);
    });
}

/// Where to divide B between global lines, which send what is below the cap, and local ones. The lines of either kind err by a variance
/// over their number: 2πR² Σ A (b − β)² of global lines, b = min(B, cap), since each brings (b − β) 2πR² to where it ends; and
/// (Σ A (B − b))² of local ones, which go by power. Shared in proportion to the roots, the variance is their sum squared.
/// Sums of channels stand for B, its mean for β.
RelaxationRun::Division RelaxationRun::divide() const {
    struct Sums {
        std::array<double, kCaps> below{}, squares{}, above{}; ///< Σ A b, Σ A b², Σ A (B − b), by cap
        Sums& operator+=(const Sums& other) {
            for (std::size_t k = 0; k < kCaps; ++k) {
                below[k] += other.below[k];
                squares[k] += other.squares[k];
                above[k] += other.above[k];
            }
            return *this;
        }
    };
    const std::size_t count = mesh_.size();
    const double most =
        orderedSum(count, Maximum{}, [&](std::size_t i) { return Maximum{sumOf(RgbSum(radiosity(i)))}; }).value;
    std::array<double, kCaps> caps{};
    for (std::size_t k = 0; k < kCaps; ++k) caps[k] = most * std::pow(0.5, 0.5 * static_cast<double>(k));
    const Sums sums = orderedSum(count, Sums{}, [&](std::size_t i) {
        const double b = sumOf(RgbSum(radiosity(i)));
        Sums term;
        for (std::size_t k = 0; k < kCaps; ++k) {
            const double capped = std::min(b, caps[k]);
            term.below[k] = area(i) * capped;
            term.squares[k] = area(i) * capped * capped;
            term.above[k] = area(i) * (b - capped);
        }
        return term;
    });
    Division best;
    double least = std::numeric_limits<double>::max();
    for (std::size_t k = 0; k < kCaps; ++k) {
        const double mean = options_.controlVariate ? sums.below[k] / area_ : 0.0;
        const double global = std::sqrt(global_->measure() * std::max(sums.squares[k] - mean * sums.below[k], 0.0));
        const double local = kLocalError * sums.above[k];
        if (global + local >= least) continue;
        least = global + local;
        best.cap = caps[k];
        best.localShare = local > 0.0 ? std::clamp(local / least, kLeastShare, 1.0 - kLeastShare) : 0.0;
    }
    return best;
}

/// E = E_0 + F B: what is brightest, as lamps are, by local lines, as global ones hardly meet what is small; the rest by global lines.
void RelaxationRun::gatherGlobally(double lines, Progress& progress) {
    const Division division = divide();
    const auto below = [&](std::size_t i) { // what of B goes by global lines
        const Rgb b = radiosity(i);
        const double all = sumOf(RgbSum(b));
        return all > division.cap ? static_cast<float>(division.cap / all) * b : b;
    };
    const Rgb control = options_.controlVariate ? median(below) : Rgb(0.0F);
    Losses losses;
    std::uint64_t count = 0;
    if (division.localShare > 0.0) {
        input_.control = Rgb(0.0F);
        forPatches(mesh_.size(), [&](std::size_t i) { sender_[i].excess = radiosity(i) - below(i); });
        setDensities(division.localShare * lines, 0.0,
                     [&](std::size_t i) { return sumOfMagnitudes(sender_[i].excess); });
        count = exchangeLocally(losses, progress);
    }
    // What the mean is to hold of this iteration in the end, of which the local lines' part can be added now.
    const double blockLines = global_->linesFor((1.0 - division.localShare) * lines);
    rays_ += count + static_cast<std::uint64_t>(blockLines);
    const double rays = static_cast<double>(count) + blockLines;
    const auto share = static_cast<float>(rays / static_cast<double>(rays_));
    forPatches(mesh_.size(), [&](std::size_t i) {
        sender_[i].excess = below(i) - control; // before the mean changes, which it depends on
        const Rgb found = direct(i) + control + Rgb(received_.take(i) / area(i));
        light_[i] += share * (found - light_[i]);
    });
    input_.control = control;
    global_->exchange(input_, blockLines, received_, losses, counts_, progress);
    ++input_.iteration;
    includeInMean(rays, losses);
    forPatches(mesh_.size(), [&](std::size_t i) { light_[i] += share * Rgb(received_.take(i) / area(i)); });
}

/// About the area-weighted median of a value per channel, what is not a front being taken for a patch of 0. From some patches: any
/// constant will do.
template <typename Value>
Rgb RelaxationRun::median(Value&& value) const {
    const std::size_t count = mesh_.size();
    const std::size_t step = (count + kMedianSample - 1) / kMedianSample;
    const double all = orderedSum(count, 0.0, [&](std::size_t i) { return area(i) * sumOf(RgbSum(radiosity(i))); });
    const double lost = std::clamp((sumOf(losses_.backFaces) + sumOf(losses_.escaped)) / all, 0.0, 0.999);
    Rgb result(0.0F);
    std::vector<std::pair<float, double>> values;
    for (int c = 0; c < 3; ++c) {
        values.clear();
        double total = 0.0;
        for (std::size_t i = step / 2; i < count; i += step) {
            values.emplace_back(value(i)[c], area(i));
            total += area(i);
        }
        std::sort(values.begin(), values.end());
        double below = lost / (1.0 - lost) * total;
        const double half = 0.5 * (total + below);
        for (const auto& [at, weight] : values) {
            if (below >= half) break;
            result[c] = std::max(at, 0.0F);
            below += weight;
        }
    }
    return result;
}

} // namespace lambert
