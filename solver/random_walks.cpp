#include "solver/random_walks.h"

#include "core/error.h"
#include "core/random.h"
#include "solver/exchange.h"
#include "solver/ordered_sum.h"
#include "solver/patch_rays.h"
#include "solver/ray_allotment.h"
#include "solver/sub_run_statistics.h"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <utility>
#include <vector>

namespace lambert {

namespace {

constexpr std::uint64_t kWalksPerBatch = 8192;
constexpr std::uint64_t kBatchesPerState = 64; ///< or more: threads wait for each other before the state can be kept
constexpr std::uint32_t kBirthStream = 0x42495254;
constexpr std::uint32_t kSurvivalStream = 0x53555256;
/// Of a walk. At the highest reflectance, 0.99, one in 10^71 goes on for longer.
constexpr std::uint32_t kMostSteps = 1U << 14;

/// A walk that goes on.
struct Walk {
    std::uint32_t patch;
    std::uint32_t number; ///< in its sub-run
    Rgb power;
};

float survival(const Rgb& reflectance) { return std::max({reflectance.x, reflectance.y, reflectance.z}); }

/// Sub-runs, one after the other in the same memory.
class WalkRun {
public:
    WalkRun(const SolverProblem& problem, const PatchMesh& mesh, const RayCaster& rays,
            const RandomWalkOptions& options)
        : problem_(problem),
          mesh_(mesh),
          options_(options),
          births_(mesh_, rays, options.sampler),
          steps_(mesh_, rays, Sampler::Random),
          received_(problem.size()),
          counts_(problem.size()),
          sender_(problem.size()),
          light_(problem.size(), Rgb(0.0F)) {
        sourcePower_ =
            orderedSum(problem.size(), 0.0, [&](std::size_t i) { return problem.area(i) * sumOf(problem.source(i)); });
    }

    std::span<const Rgb> irradiance() const { return light_; }
    const Losses& losses() const { return losses_; }
    const LineCounts& counts() const { return counts_; }
    std::uint64_t rays() const { return rays_; } ///< of all runs

    /// As RelaxationRun::run.
    void run(std::uint64_t walks, std::uint64_t seed, Progress& progress, const std::function<void()>& afterBatches);

    /// As RelaxationRun::keep.
    template <typename Archive>
    void keep(Archive& archive) {
        archive(batches_);
        archive(rays_);
        archive(lost_);
        received_.keep(archive);
        counts_.keep(archive);
    }

private:
    struct Scratch {
        PatchRays::Batch batch;
        std::vector<Walk> walks, next;
        LossUnits losses;
        std::uint64_t rays = 0;
    };

    void setScales(double walks);
    void walk(const RayAllotment& allotment, std::uint64_t first, std::uint64_t last, std::uint64_t seed,
              Scratch& scratch);
    void step(const PatchRays& rays, std::uint64_t seed, Scratch& scratch);
    void arrive(Walk walk, std::uint32_t target, std::uint64_t seed, Scratch& scratch);

    const SolverProblem& problem_;
    const PatchMesh& mesh_;
    const RandomWalkOptions& options_;
    PatchRays births_, steps_;
    FixedPointSums received_;
    FixedPointScale lossScale_;
    LineCounts counts_;
    std::vector<Sender> sender_; ///< what a walk from the patch carries, and how many are born per m²
    std::vector<Rgb> light_;
    LossUnits lost_; ///< of an unfinished run
    Losses losses_;
    double sourcePower_ = 0.0;
    std::uint64_t batches_ = 0; ///< that are done of an unfinished run
    std::uint64_t rays_ = 0;
};

void WalkRun::run(std::uint64_t walks, std::uint64_t seed, Progress& progress,
                  const std::function<void()>& afterBatches) {
    const auto count = static_cast<double>(walks);
    forPatches(mesh_.size(), [&](std::size_t i) {
        const Rgb s(problem_.source(i));
        const auto density = static_cast<float>(count * sumOf(RgbSum(s)) / sourcePower_);
        sender_[i] = {density > 0.0F ? s / density : Rgb(0.0F), density};
    });
    setScales(count);
    const RayAllotment allotment(mesh_, sender_,
                                 static_cast<double>(uniformFloat(philox({0, 0, 0, kBirthStream}, seed)[0])));
    std::vector<Scratch> scratch(static_cast<std::size_t>(threadCount()));
    const std::uint64_t all = (allotment.rays() + kWalksPerBatch - 1) / kWalksPerBatch;
    const std::uint64_t atOnce = std::max(kBatchesPerState, 16 * static_cast<std::uint64_t>(threadCount()));
    while (batches_ < all) {
        const std::uint64_t now = std::min(atOnce, all - batches_);
        parallelFor(now, 1, [&](std::size_t begin, std::size_t end, int worker) {
            for (std::size_t b = batches_ + begin; b < batches_ + end; ++b) {
                const std::uint64_t first = b * kWalksPerBatch;
                const std::uint64_t last = std::min(first + kWalksPerBatch, allotment.rays());
                walk(allotment, first, last, seed, scratch[static_cast<std::size_t>(worker)]);
                progress.advance(last - first);
            }
        });
        batches_ += now;
        for (Scratch& s : scratch) {
            lost_ += std::exchange(s.losses, {});
            rays_ += std::exchange(s.rays, 0);
        }
        afterBatches();
    }
    batches_ = 0;
    losses_ = std::exchange(lost_, {}).value(lossScale_);
    forPatches(mesh_.size(),
               [&](std::size_t i) { light_[i] = Rgb(problem_.direct(i) + received_.take(i) / problem_.area(i)); });
}

/// No walk ever carries more than at its birth, and it adds at most 1/q or 1/(1−q) times that, kMostSteps times.
void WalkRun::setScales(double walks) {
    const double power =
        orderedSum(mesh_.size(), Maximum{}, [&](std::size_t i) { return Maximum{largest(sender_[i].excess)}; }).value;
    const double factor = orderedSum(mesh_.size(), Maximum{1.0}, [&](std::size_t i) {
                              const auto q = static_cast<double>(survival(problem_.patches().reflectance[i]));
                              if (options_.estimator == WalkEstimator::Collision) return Maximum{1.0};
                              if (options_.estimator == WalkEstimator::Absorption) return Maximum{1.0 / (1.0 - q)};
                              return Maximum{q > 0.0 ? 1.0 / q : 1.0};
                          }).value;
    const double margin = 1.01 * (walks + 1.0);
    received_.setScale(FixedPointScale(margin * kMostSteps * factor * power));
    lossScale_ = FixedPointScale(margin * power);
}

/// The walks [first, last) from their birth to their end, step by step all together.
void WalkRun::walk(const RayAllotment& allotment, std::uint64_t first, std::uint64_t last, std::uint64_t seed,
                   Scratch& scratch) {
    scratch.walks.clear();
    allotment.visit(first, last, [&](std::size_t patch, std::uint64_t ray, std::uint64_t count) {
        for (std::uint64_t number = std::max(ray, first); number < std::min(ray + count, last); ++number)
            scratch.walks.push_back(
                {static_cast<std::uint32_t>(patch), static_cast<std::uint32_t>(number), sender_[patch].excess});
    });
    step(births_, seed, scratch);
    for (std::uint32_t k = 1; k < kMostSteps && !scratch.walks.empty(); ++k) {
        // Neighbours together: the rays of a packet then begin near each other.
        std::sort(scratch.walks.begin(), scratch.walks.end(), [](const Walk& a, const Walk& b) {
            return a.patch != b.patch ? a.patch < b.patch : a.number < b.number;
        });
        step(steps_, randomKey({k, 0, 0, kBirthStream}, seed), scratch);
    }
}

/// Takes every walk one ray further; those that survive stay. A walk's number tells its ray in the sequence of its patch.
void WalkRun::step(const PatchRays& rays, std::uint64_t seed, Scratch& scratch) {
    scratch.batch.runs.clear();
    for (const Walk& walk : scratch.walks) scratch.batch.runs.push_back({walk.patch, walk.number, 1});
    rays.trace(seed, scratch.batch);
    scratch.rays += scratch.walks.size();
    scratch.next.clear();
    for (std::size_t k = 0; k < scratch.walks.size(); ++k)
        arrive(scratch.walks[scratch.batch.run[k]], scratch.batch.target[k], seed, scratch);
    std::swap(scratch.walks, scratch.next);
}

void WalkRun::arrive(Walk walk, std::uint32_t target, std::uint64_t seed, Scratch& scratch) {
    counts_.addLines(walk.patch, 1);
    if (target >= births_.back()) {
        const bool back = target == births_.back();
        if (back) counts_.addBack(walk.patch);
        scratch.losses.add(back, walk.power, lossScale_);
        return;
    }
    const Rgb& reflectance = problem_.patches().reflectance[target];
    const float q = survival(reflectance);
    const bool survives = uniformFloat(philox({walk.number, 0, 0, kSurvivalStream}, seed)[0]) < q;
    switch (options_.estimator) {
    case WalkEstimator::Collision:
        received_.add(target, walk.power);
        break;
    case WalkEstimator::Absorption:
        if (!survives) received_.add(target, walk.power / (1.0F - q));
        break;
    case WalkEstimator::Survival:
        if (survives || !(q > 0.0F)) received_.add(target, q > 0.0F ? walk.power / q : walk.power);
        break;
    }
    if (survives) scratch.next.push_back({target, walk.number, walk.power * reflectance / q});
}

void check(const RandomWalkOptions& o) {
    if (o.walks < 1 || o.walks > std::uint64_t{1} << 32)
        throw UsageError(fmt::format("walks: found {}, allowed are 1 to 2^32", o.walks));
    if (!(o.targetError >= 0.0))
        throw UsageError(fmt::format("target error: found {}, allowed are 0 and more", o.targetError));
    if (o.subRuns < 3) throw UsageError(fmt::format("sub-runs: found {}, allowed are 3 and more", o.subRuns));
}

} // namespace

StochasticSolution solveRandomWalks(const SolverProblem& problem, const PatchMesh& mesh, const RayCaster& rays,
                                    const RandomWalkOptions& options, Progress& progress,
                                    const SolverContext& context) {
    check(options);
    const std::size_t count = problem.size();
    const SubRunSchedule schedule(options.walks, options.targetError, options.subRuns, count);
    SubRunStatistics statistics(problem);
    StochasticSolution solution;
    {
        WalkRun run(problem, mesh, rays, options);
        const auto state = [&](auto& archive) {
            statistics.keep(archive);
            archive(solution.history);
            run.keep(archive);
        };
        context.restore(state);
        const SolverClock clock(solution.history);
        progress.begin("random walks", options.walks - std::min(options.walks, statistics.rays()));
        while (const std::uint64_t walks = schedule.next(statistics)) {
            run.run(walks, subRunSeed(options.seed, statistics.runs()), progress, [&] { context.offer(state); });
            statistics.add(run.irradiance(), run.losses(), walks);
            if (statistics.runs() > 1)
                solution.history.push_back({statistics.runs(), statistics.relativeError(), clock.seconds()});
        }
        progress.end();
        solution.covered.reserve(count);
        for (std::size_t i = 0; i < count; ++i) solution.covered.push_back(run.counts().backShare(i));
        statistics.finish(solution);
        solution.rays = run.rays();
    }
    solution.targetReached = options.targetError == 0.0 || solution.upperRelativeError <= options.targetError;
    return solution;
}

} // namespace lambert
