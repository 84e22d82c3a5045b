#include "core/parallel.h"
#include "core/random.h"
#include "solver/fixed_point_sum.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace lambert {
namespace {

double random(std::uint32_t k) { return static_cast<double>(uniformFloat(philox({k, 0, 0, 0}, 5)[0])) - 0.5; }

TEST(FixedPointScale, UnitIsAsSmallAsItSays) {
    for (const double bound : {1e-30, 0.3, 1.0, 1.9999, 2.0, 5e20}) {
        const FixedPointScale scale(bound);
        const double unit = scale.value(1);
        EXPECT_GT(unit, std::ldexp(bound, -62)) << bound;
        EXPECT_LE(unit, std::ldexp(bound, -61)) << bound;
        EXPECT_LE(scale.units(bound), std::int64_t{1} << 62) << bound;
        EXPECT_GE(scale.units(-bound), -(std::int64_t{1} << 62)) << bound;
    }
}

TEST(FixedPointSums, AreWrongByHalfAUnitPerTermAtMost) {
    constexpr std::uint32_t kTerms = 100'000;
    FixedPointSums sums(2);
    const FixedPointScale scale(0.5 * kTerms);
    sums.setScale(scale);
    long double exact = 0.0L;
    for (std::uint32_t k = 0; k < kTerms; ++k) {
        const auto term = static_cast<float>(random(k));
        exact += static_cast<long double>(term);
        sums.add(1, Rgb(term, 2.0F * term, 0.0F));
    }
    EXPECT_NEAR(sums[1].x, static_cast<double>(exact), 0.5 * kTerms * scale.value(1) + 1e-12);
    EXPECT_NEAR(sums[1].y, static_cast<double>(2.0L * exact), 0.5 * kTerms * scale.value(1) + 1e-12);
    EXPECT_EQ(sums[1].z, 0.0);
    EXPECT_EQ(sums[0], RgbSum(0.0));
    const RgbSum before = sums[1];
    EXPECT_EQ(sums.take(1), before);
    EXPECT_EQ(sums[1], RgbSum(0.0));
}

TEST(FixedPointSums, TakeTheirBoundWithoutOverflow) {
    FixedPointSums sums(1);
    constexpr int kTerms = 1 << 16;
    const float term = std::nextafter(1.0F, 2.0F); // rounded in every channel
    sums.setScale(FixedPointScale(static_cast<double>(term) * kTerms));
    for (int k = 0; k < kTerms; ++k) sums.add(0, Rgb(term, -term, term));
    EXPECT_NEAR(sums[0].x, static_cast<double>(term) * kTerms, 1e-9);
    EXPECT_NEAR(sums[0].y, -static_cast<double>(term) * kTerms, 1e-9);
}

TEST(FixedPointSums, SameBitsInAnyOrderAndOnAnyNumberOfThreads) {
    constexpr std::size_t kTerms = 50'000;
    std::vector<RgbSum> results;
    for (const int threads : {1, 2, 8}) {
        setThreadCount(threads);
        FixedPointSums sums(7);
        sums.setScale(FixedPointScale(kTerms));
        parallelFor(kTerms, 16, [&](std::size_t begin, std::size_t end, int) {
            for (std::size_t k = begin; k < end; ++k)
                sums.add(k % 7, Rgb(static_cast<float>(random(static_cast<std::uint32_t>(k))), 0.1F, -0.3F));
        });
        for (std::size_t i = 0; i < 7; ++i) results.push_back(sums[i]);
    }
    setThreadCount(0);
    for (std::size_t k = 7; k < results.size(); ++k) EXPECT_EQ(results[k], results[k % 7]);
}

TEST(FixedPointScale, NothingToAddIsNoError) {
    FixedPointSums sums(1);
    sums.setScale(FixedPointScale(0.0));
    sums.add(0, Rgb(0.0F));
    EXPECT_EQ(sums[0], RgbSum(0.0));
}

} // namespace
} // namespace lambert
