#include "stochastic_case.h"

#include "core/error.h"
#include "solver/local_exchange.h"
#include "solver/patch_rays.h"
#include "solver/ray_allotment.h"

#include <algorithm>
#include <map>

namespace lambert {
namespace {

using Ends = std::map<std::uint32_t, std::uint32_t>; ///< how many rays ended on each target

Ends endsOf(const PatchRays& rays, std::vector<RayRun> runs, std::uint32_t run) {
    PatchRays::Batch batch;
    batch.runs = std::move(runs);
    rays.trace(7, batch);
    Ends ends;
    for (std::size_t k = 0; k < batch.run.size(); ++k)
        if (batch.run[k] == run) ++ends[batch.target[k]];
    return ends;
}

TEST(PatchRays, ARunIsAPartOfThePatchsSequence) {
    const StochasticCase c(openCorner(), 60);
    for (const Sampler sampler : {Sampler::Random, Sampler::Sobol}) {
        const PatchRays rays(c.mesh, c.rays, sampler);
        const Ends whole = endsOf(rays, {{5, 0, 1000}}, 0);
        // In two parts and between others, traced in other packets.
        Ends parts = endsOf(rays, {{3, 17, 40}, {5, 0, 300}, {6, 0, 9}}, 1);
        for (const auto& [target, count] : endsOf(rays, {{5, 300, 700}}, 0)) parts[target] += count;
        EXPECT_EQ(parts, whole);
    }
}

std::vector<Ray> raysFrom(const PatchRays& rays, std::uint64_t first, std::uint32_t count) {
    PatchRays::Batch batch;
    batch.runs = {{5, first, count}};
    std::vector<Ray> result(rays.make(7, batch));
    for (std::size_t k = 0; k < result.size(); ++k) result[k] = batch.ray(k);
    return result;
}

// Where the Sobol sequence ends, which has 32-bit points, another one follows.
TEST(PatchRays, DoNotRepeatThemselvesAfter32Bits) {
    const StochasticCase c(openCorner(), 60);
    constexpr std::uint64_t kEnd = std::uint64_t{1} << 32;
    const auto same = [](const Ray& a, const Ray& b) { return a.origin == b.origin && a.direction == b.direction; };
    for (const Sampler sampler : {Sampler::Random, Sampler::Sobol}) {
        const PatchRays rays(c.mesh, c.rays, sampler);
        const std::vector<Ray> first = raysFrom(rays, 0, 20);
        const std::vector<Ray> across = raysFrom(rays, kEnd - 20, 40);
        const std::vector<Ray> before = raysFrom(rays, kEnd - 20, 20);
        const std::vector<Ray> after = raysFrom(rays, kEnd, 20);
        const std::vector<Ray> third = raysFrom(rays, 2 * kEnd, 20);
        EXPECT_TRUE(std::equal(before.begin(), before.end(), across.begin(), same));
        EXPECT_TRUE(std::equal(after.begin(), after.end(), across.begin() + 20, same));
        for (std::size_t k = 0; k < 20; ++k) {
            EXPECT_FALSE(same(after[k], first[k]));
            EXPECT_FALSE(same(third[k], first[k]));
            EXPECT_FALSE(same(third[k], after[k]));
        }
    }
}

TEST(RayAllotment, GivesAPatchMoreThan32BitsCount) {
    const StochasticCase c(openCorner(), 0);
    std::vector<Sender> senders(c.mesh.size());
    senders[1].density = 1e10F / c.mesh.area[1];
    const RayAllotment allotment(c.mesh, senders, 0.5);
    EXPECT_NEAR(static_cast<double>(allotment.rays()), 1e10, 1e4); // densities are floats
    std::uint64_t sum = 0;
    allotment.visitAll([&](std::size_t patch, std::uint64_t first, std::uint64_t count) {
        EXPECT_EQ(patch, 1U);
        EXPECT_EQ(first, 0U);
        sum += count;
    });
    EXPECT_EQ(sum, allotment.rays());
}

TEST(LineCounts, CountMoreThan32Bits) {
    LineCounts counts(2);
    for (int k = 0; k < 3; ++k) counts.addLines(1, std::uint64_t{3'000'000'000});
    counts.addBack(1);
    EXPECT_FLOAT_EQ(counts.backShare(1), 1.0F / 9e9F);
    EXPECT_EQ(counts.backShare(0), 0.0F);
}

/// Sets how far the sequences of an exchange are.
struct SequencesAt {
    std::uint64_t place;
    void operator()(std::vector<std::uint64_t>& next) const { std::fill(next.begin(), next.end(), place); }
};

// So that a patch goes on with rays that it has not sent: it receives other light than from the beginning of its sequence.
TEST(LocalExchange, GoesOnAfter32Bits) {
    const StochasticCase c(openCorner(), 60);
    std::vector<Sender> senders(c.mesh.size());
    for (std::size_t i = 0; i < senders.size(); ++i) senders[i] = {Rgb(c.exact.radiosity[i]), 300.0F};
    const auto received = [&](std::uint64_t place) {
        LocalExchange exchange(c.mesh, c.rays, Sampler::Sobol);
        SequencesAt at{place};
        exchange.keep(at);
        FixedPointSums sums(c.mesh.size());
        LineCounts counts(c.mesh.size());
        Losses losses;
        Progress progress;
        exchange.exchange({.senders = senders, .seed = 1}, sums, losses, counts, progress);
        std::vector<RgbSum> result;
        for (std::size_t i = 0; i < sums.size(); ++i) result.push_back(sums[i]);
        return result;
    };
    EXPECT_NE(received(std::uint64_t{1} << 32), received(0));
    EXPECT_NE(received((std::uint64_t{1} << 32) - 1), received(0));
}

TEST(PatchRays, EndWithTheFrequencyOfFormFactors) {
    const StochasticCase c(colouredBox({4.0F, 3.0F, 2.5F}), 24);
    FormFactorRow row;
    RowAccumulator accumulator(c.mesh.size());
    const ClosedForm method(c.mesh, c.rays, {});
    for (const Sampler sampler : {Sampler::Random, Sampler::Sobol}) {
        const PatchRays rays(c.mesh, c.rays, sampler);
        for (std::uint32_t i = 0; i < c.mesh.size(); ++i) {
            method.row(i, accumulator);
            accumulator.take(row);
            constexpr std::uint32_t kRays = 20'000;
            Ends ends = endsOf(rays, {{i, 0, kRays}}, 0);
            for (const FormFactor& entry : row.entries) {
                // 5.5 standard deviations of a binomial: odds of 1 in 26 million, for some 1000 tests.
                const double deviation = std::sqrt(entry.value * (1.0 - entry.value) / kRays);
                EXPECT_NEAR(ends[entry.patch] / static_cast<double>(kRays), entry.value, 5.5 * deviation + 1e-5);
            }
        }
    }
}

TEST(PatchRays, RefuseSamplersThatHaveNoContinuation) {
    const StochasticCase c(openCorner(), 0);
    EXPECT_THROW(PatchRays(c.mesh, c.rays, Sampler::Stratified), UsageError);
}

/// Tries some densities of lines, none of which may shift the mean.
TEST(LocalExchange, IsUnbiasedWhateverTheDensities) {
    const StochasticCase c(openCorner(), 60);
    const std::size_t count = c.mesh.size();
    const Rgb control(0.7F, 0.1F, 0.0F);
    // A_i Σ_j F_ij (B_j − β), with whatever is no front at −β: B of the exact solution, E known from it.
    std::vector<RgbSum> exact(count);
    for (std::size_t i = 0; i < count; ++i)
        exact[i] = static_cast<double>(c.mesh.area[i]) * (c.exact.irradiance[i] - RgbSum(control));
    for (const int kind : {0, 1, 2}) {
        std::vector<Sender> senders(count);
        for (std::size_t i = 0; i < count; ++i) {
            const float factor = kind == 0 ? 1.0F : kind == 1 ? 1.0F + static_cast<float>(i % 7) : 0.05F;
            senders[i] = {Rgb(c.exact.radiosity[i]) - control, 300.0F * factor};
        }
        constexpr int kSeeds = 400;
        std::vector<RgbSum> sum(count, RgbSum(0.0)), squares(count, RgbSum(0.0));
        RgbSum escaped(0.0);
        LocalExchange exchange(c.mesh, c.rays, Sampler::Sobol);
        FixedPointSums received(count);
        LineCounts counts(count);
        for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
            exchange.restart();
            Progress progress;
            Losses losses;
            exchange.exchange({.senders = senders, .control = control, .seed = seed}, received, losses, counts,
                              progress);
            for (std::size_t i = 0; i < count; ++i) {
                const RgbSum value = received.take(i);
                sum[i] += value;
                squares[i] += value * value;
            }
            escaped += losses.escaped / static_cast<double>(kSeeds);
        }
        for (std::size_t i = 0; i < count; ++i)
            for (int k = 0; k < 3; ++k) {
                const double mean = sum[i][k] / kSeeds;
                const double variance = (squares[i][k] / kSeeds - mean * mean) / (kSeeds - 1);
                // Some 600 tests: 5.3 standard errors, odds of 1 in 14,000 for any to fail.
                EXPECT_NEAR(mean, exact[i][k], 5.3 * std::sqrt(variance) + 1e-6) << "kind " << kind << " patch " << i;
            }
        for (int k = 0; k < 3; ++k) EXPECT_NEAR(escaped[k] / c.exact.energy.escaped[k], 1.0, 0.02) << kind;
    }
}

} // namespace
} // namespace lambert
