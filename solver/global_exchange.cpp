#include "solver/global_exchange.h"

#include "core/parallel.h"
#include "solver/ordered_sum.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <numbers>

namespace lambert {

namespace {

constexpr double kBlocks = 16; ///< at least, in which threads share an exchange by chords

} // namespace

struct GlobalExchange::Scratch {
    IsotropicLines::Block block;
    LineSpans::Scratch spans;
    LossUnits losses;
    FixedPointScale lossScale;
};

GlobalExchange::GlobalExchange(const PatchMesh& mesh, const LineCaster& caster, LineSet set, Sampler sampler)
    : mesh_(mesh), bounds_(caster.bounds()), spans_(mesh, caster) {
    options_.lines = std::numeric_limits<std::uint32_t>::max();
    options_.set = set;
    options_.sampler = sampler;
}

void GlobalExchange::restart(std::uint64_t seed, double lines) {
    options_.seed = seed;
    options_.chordsPerBlock = std::bit_floor(static_cast<std::uint32_t>(std::clamp(lines / kBlocks, 1024.0, 65536.0)));
    lines_.emplace(bounds_, options_);
    nextBlock_ = 0;
}

/// Brings what a stretch of a line carries to both of its ends.
void GlobalExchange::deposit(const ExchangeInput& input, std::uint32_t a, std::uint32_t b, float weight,
                             FixedPointSums& received, Scratch& scratch, LineCounts& counts) const {
    if (a >= spans_.back()) std::swap(a, b);
    if (a >= spans_.back()) return;
    const Rgb& ofA = input.senders[a].excess;
    counts.addLines(a, 1);
    if (b < spans_.back()) {
        counts.addLines(b, 1);
        received.add(a, weight * input.senders[b].excess);
        received.add(b, weight * ofA);
        return;
    }
    const bool back = b == spans_.back();
    if (back) counts.addBack(a);
    received.add(a, -weight * input.control);
    scratch.losses.add(back, weight * (ofA + input.control), scratch.lossScale);
}

std::uint64_t GlobalExchange::blocksFor(double wanted) const {
    const double blocks = std::max(1.0, std::round(wanted / static_cast<double>(lines_->linesPerBlock())));
    return std::min(static_cast<std::uint64_t>(blocks), lines_->blockCount() - 1 - nextBlock_);
}

double GlobalExchange::linesFor(double wanted) const {
    return static_cast<double>(blocksFor(wanted) * lines_->linesPerBlock());
}

double GlobalExchange::measure() const {
    const double radius = static_cast<double>(lines_->radius());
    return 2.0 * std::numbers::pi * radius * radius;
}

void GlobalExchange::exchange(const ExchangeInput& input, double lines, FixedPointSums& received, Losses& losses,
                              LineCounts& counts, Progress& progress) {
    const std::uint64_t blocks = blocksFor(lines);
    if (blocks == 0) return;
    const std::uint64_t count = blocks * lines_->linesPerBlock();
    const double measure = this->measure();
    const double weight = measure / static_cast<double>(count);

    // A line meets a patch's front at most once, so that the magnitudes of a sum come to at most 2πR² times the largest excess.
    const double most = orderedSum(mesh_.size(), Maximum{largest(input.control)}, [&](std::size_t i) {
                            return Maximum{largest(input.senders[i].excess)};
                        }).value;
    const double mostLost = orderedSum(mesh_.size(), Maximum{}, [&](std::size_t i) {
                                return Maximum{largest(input.senders[i].excess + input.control)};
                            }).value;
    received.setScale(FixedPointScale(1.001 * measure * most));
    // A line meets the front of each patch at most once.
    const FixedPointScale lossScale(1.001 * measure * mostLost * static_cast<double>(mesh_.size()));
    std::vector<Scratch> scratch(static_cast<std::size_t>(threadCount()));
    for (Scratch& s : scratch) s.lossScale = lossScale;
    parallelFor(blocks, 1, [&](std::size_t begin, std::size_t end, int worker) {
        Scratch& s = scratch[static_cast<std::size_t>(worker)];
        for (std::size_t block = begin; block < end; ++block) {
            lines_->fill(nextBlock_ + block, s.block);
            for (const LinePacket& packet : s.block.packets)
                spans_.visit(packet, s.spans, [&](std::uint32_t a, std::uint32_t b) {
                    deposit(input, a, b, static_cast<float>(weight), received, s, counts);
                });
        }
        progress.advance((end - begin) * lines_->linesPerBlock());
    });
    nextBlock_ += blocks;
    LossUnits lost;
    for (const Scratch& s : scratch) lost += s.losses;
    losses += lost.value(lossScale);
}

} // namespace lambert
