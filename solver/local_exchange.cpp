#include "solver/local_exchange.h"

#include "core/random.h"
#include "solver/ordered_sum.h"

#include <algorithm>

namespace lambert {

namespace {

constexpr std::uint32_t kXiStream = 0x58495849;
constexpr std::uint64_t kRaysPerBatch = 8192; ///< whatever the number of threads

} // namespace

struct LocalExchange::Scratch {
    PatchRays::Batch batch;
    std::vector<std::int64_t> units; ///< received by the runs' patches, channel by channel
    LossUnits losses;
    FixedPointScale scale, lossScale;
};

LocalExchange::LocalExchange(const PatchMesh& mesh, const RayCaster& rays, Sampler sampler)
    : mesh_(mesh), rays_(mesh, rays, sampler), next_(mesh.size(), 0) {}

void LocalExchange::restart() { std::fill(next_.begin(), next_.end(), std::uint64_t{0}); }

/// The runs that make up the rays [first, last).
void LocalExchange::findRuns(const RayAllotment& allotment, std::uint64_t first, std::uint64_t last,
                             std::vector<RayRun>& runs) const {
    runs.clear();
    allotment.visit(first, last, [&](std::size_t patch, std::uint64_t ray, std::uint64_t count) {
        const std::uint64_t from = std::max(ray, first);
        const std::uint64_t to = std::min(ray + count, last);
        runs.push_back(
            {static_cast<std::uint32_t>(patch), next_[patch] + (from - ray), static_cast<std::uint32_t>(to - from)});
    });
}

/// Brings what the traced rays carry to both of their ends.
void LocalExchange::deposit(const ExchangeInput& input, Scratch& scratch, FixedPointSums& received,
                            LineCounts& counts) const {
    const PatchRays::Batch& batch = scratch.batch;
    scratch.units.assign(3 * batch.runs.size(), 0);
    constexpr std::size_t kAhead = 16;
    for (std::size_t k = 0; k < batch.run.size(); ++k) {
        if (k + kAhead < batch.run.size()) {
            const std::uint32_t target = batch.target[k + kAhead];
            if (target < rays_.back()) {
                __builtin_prefetch(&input.senders[target]);
                received.prefetch(target);
            }
        }
        const std::uint32_t run = batch.run[k];
        const std::uint32_t patch = batch.runs[run].patch;
        const std::uint32_t target = batch.target[k];
        const Sender& from = input.senders[patch];
        Rgb arriving = -input.control;
        float weight = 1.0F / from.density;
        if (target < rays_.back()) {
            const Sender& to = input.senders[target];
            weight = 1.0F / (from.density + to.density);
            arriving = to.excess;
            received.add(target, weight * from.excess);
        } else {
            const bool back = target == rays_.back();
            scratch.losses.add(back, weight * (from.excess + input.control), scratch.lossScale);
            if (back) counts.addBack(patch);
        }
        for (int c = 0; c < 3; ++c)
            scratch.units[3 * run + static_cast<std::size_t>(c)] +=
                scratch.scale.units(static_cast<double>(weight * arriving[c]));
    }
    for (std::size_t r = 0; r < batch.runs.size(); ++r) received.addUnits(batch.runs[r].patch, &scratch.units[3 * r]);
}

std::uint64_t LocalExchange::exchange(const ExchangeInput& input, FixedPointSums& received, Losses& losses,
                                      LineCounts& counts, Progress& progress) {
    const RayAllotment allotment(
        mesh_, input.senders,
        static_cast<double>(uniformFloat(philox({input.iteration, 0, 0, kXiStream}, input.seed)[0])));
    const std::uint64_t rays = allotment.rays();
    if (rays == 0) return 0;

    // A ray adds once to either end and at most `share` per channel, so that all magnitudes of a sum come to share times the rays.
    const auto largestShare = [&](auto&& carried) {
        return orderedSum(mesh_.size(), Maximum{},
                          [&](std::size_t i) {
                              const Sender& s = input.senders[i];
                              return Maximum{s.density > 0.0F ? carried(s) / static_cast<double>(s.density) : 0.0};
                          })
            .value;
    };
    const double margin = 1.001 * static_cast<double>(rays); // weights are rounded to floats
    const double share =
        largestShare([&](const Sender& s) { return std::max(largest(s.excess), largest(input.control)); });
    const double lossShare = largestShare([&](const Sender& s) { return largest(s.excess + input.control); });
    received.setScale(FixedPointScale(margin * share));

    std::vector<Scratch> scratch(static_cast<std::size_t>(threadCount()));
    for (Scratch& s : scratch) {
        s.scale = FixedPointScale(margin * share);
        s.lossScale = FixedPointScale(margin * lossShare);
    }
    parallelFor((rays + kRaysPerBatch - 1) / kRaysPerBatch, 1, [&](std::size_t begin, std::size_t end, int worker) {
        Scratch& s = scratch[static_cast<std::size_t>(worker)];
        for (std::size_t b = begin; b < end; ++b) {
            const std::uint64_t first = b * kRaysPerBatch;
            const std::uint64_t last = std::min(first + kRaysPerBatch, rays);
            findRuns(allotment, first, last, s.batch.runs);
            rays_.trace(input.seed, s.batch);
            deposit(input, s, received, counts);
            progress.advance(last - first);
        }
    });
    allotment.visitAll([&](std::size_t patch, std::uint64_t, std::uint64_t count) {
        next_[patch] += count;
        counts.addLines(patch, count);
    });
    LossUnits lost;
    for (const Scratch& s : scratch) lost += s.losses;
    losses += lost.value(scratch[0].lossScale);
    return rays;
}

} // namespace lambert
