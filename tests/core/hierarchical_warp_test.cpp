#include "core/hierarchical_warp.h"
#include "core/low_discrepancy.h"
#include "core/random.h"
#include "core/russian_roulette.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>
#include <stdexcept>
#include <vector>

namespace lambert {
namespace {

constexpr std::uint64_t kSeed = 7;

glm::dvec2 randomPoint(std::uint32_t index) {
    const auto bits = philox({index, 0, 0, 0}, kSeed);
    return 0x1p-32 * glm::dvec2(bits[0], bits[1]);
}

/// 11 × 5 texels between 0 and 1, every seventh without importance: neither a power of two nor square.
constexpr int kWidth = 11, kHeight = 5;
std::vector<float> importance() {
    std::vector<float> result;
    for (std::uint32_t i = 0; i < kWidth * kHeight; ++i)
        result.push_back(i % 7 == 3 ? 0.0F : uniformFloat(philox({i, 1, 0, 0}, kSeed)[0]));
    return result;
}

// 99.99 % of χ²(46), 55 texels less 8 without importance and one for the sum, lie below 91.
TEST(HierarchicalWarp, GivesEveryTexelItsShareOfRandomPoints) {
    const std::vector<float> image = importance();
    const HierarchicalWarp warp(kWidth, kHeight, image);
    constexpr int kPoints = 100000;
    std::vector<int> counts(image.size(), 0);
    for (std::uint32_t i = 0; i < kPoints; ++i) {
        const glm::dvec2 p = warp.warp(randomPoint(i));
        ASSERT_TRUE(p.x >= 0.0 && p.x < kWidth && p.y >= 0.0 && p.y < kHeight);
        ++counts[static_cast<std::size_t>(p.y) * kWidth + static_cast<std::size_t>(p.x)];
    }
    const double sum = std::accumulate(image.begin(), image.end(), 0.0);
    double chiSquared = 0.0;
    for (std::size_t i = 0; i < image.size(); ++i) {
        const double probability = static_cast<double>(image[i]) / sum;
        EXPECT_NEAR(warp.probability(static_cast<int>(i % kWidth), static_cast<int>(i / kWidth)), probability, 1e-12);
        if (probability == 0.0)
            EXPECT_EQ(counts[i], 0) << i;
        else
            chiSquared += std::pow(counts[i] - kPoints * probability, 2.0) / (kPoints * probability);
    }
    EXPECT_LT(chiSquared, 91.0) << "seed " << kSeed;
}

// Within a texel the density is constant: the mean of u² is 1/3, that of uv 1/4. Their standard deviations over 10^5 points:
// 9.4e-4 and 7e-4; four of them.
TEST(HierarchicalWarp, SpreadsPointsEvenlyOverATexel) {
    const HierarchicalWarp warp(kWidth, kHeight, importance());
    constexpr int kPoints = 100000;
    double xx = 0.0, yy = 0.0, xy = 0.0;
    for (std::uint32_t i = 0; i < kPoints; ++i) {
        const glm::dvec2 p = warp.warp(randomPoint(i));
        const double x = p.x - std::floor(p.x), y = p.y - std::floor(p.y);
        xx += x * x;
        yy += y * y;
        xy += x * y;
    }
    EXPECT_NEAR(xx / kPoints, 1.0 / 3.0, 4 * 9.4e-4) << "seed " << kSeed;
    EXPECT_NEAR(yy / kPoints, 1.0 / 3.0, 4 * 9.4e-4) << "seed " << kSeed;
    EXPECT_NEAR(xy / kPoints, 1.0 / 4.0, 4 * 7e-4) << "seed " << kSeed;
}

// What makes it worth while: the counts of well-spread points miss their expectation by about 1, those of random points
// by the root of it.
TEST(HierarchicalWarp, KeepsPointsWellSpread) {
    const std::vector<float> image = importance();
    const HierarchicalWarp warp(kWidth, kHeight, image);
    constexpr int kPoints = 1 << 14;
    std::vector<int> counts(image.size(), 0);
    for (std::uint32_t i = 0; i < kPoints; ++i) {
        const glm::dvec2 p = warp.warp({static_cast<double>(i) / kPoints, halton(i, 0)});
        ++counts[static_cast<std::size_t>(p.y) * kWidth + static_cast<std::size_t>(p.x)];
    }
    double squares = 0.0, variance = 0.0;
    for (int i = 0; i < kWidth * kHeight; ++i) {
        const double p = warp.probability(i % kWidth, i / kWidth);
        squares += std::pow(counts[static_cast<std::size_t>(i)] - kPoints * p, 2.0);
        variance += kPoints * p * (1.0 - p);
    }
    EXPECT_LT(squares, 0.02 * variance);
}

TEST(HierarchicalWarp, OfEqualImportanceChangesNothing) {
    const HierarchicalWarp warp(8, 8, std::vector<float>(64, 0.25F));
    EXPECT_EQ(warp.total(), 16.0);
    for (std::uint32_t i = 0; i < 100; ++i) {
        const glm::dvec2 u = randomPoint(i), p = warp.warp(u);
        EXPECT_NEAR(p.x, 8.0 * u.x, 1e-12);
        EXPECT_NEAR(p.y, 8.0 * u.y, 1e-12);
    }
}

TEST(HierarchicalWarp, RefusesImagesWithoutImportance) {
    EXPECT_THROW(HierarchicalWarp(2, 2, std::vector<float>(4, 0.0F)), std::invalid_argument);
    EXPECT_THROW(HierarchicalWarp(2, 2, std::vector<float>(3, 1.0F)), std::invalid_argument);
    EXPECT_THROW(HierarchicalWarp(1, 2, std::vector<float>{1.0F, -1.0F}), std::invalid_argument);
    EXPECT_THROW(HierarchicalWarp(0, 0, {}), std::invalid_argument);
}

// The mean of what survives is the factor: its standard deviation over 10^5 trials is at most f √((1 − p)/p / 10^5) for p = 0.8,
// 0.0016 f; four of them.
TEST(RussianRoulette, KeepsTheExpectationOfEveryChannel) {
    const glm::vec3 factor(0.8F, 0.3F, 0.0F);
    const RussianRoulette roulette(factor);
    EXPECT_EQ(roulette.probability(), 0.8F);
    glm::dvec3 sum(0.0);
    for (std::uint32_t i = 0; i < 100000; ++i)
        if (roulette.survives(uniformFloat(philox({i, 2, 0, 0}, kSeed)[0]))) sum += glm::dvec3(roulette.weight());
    for (int c = 0; c < 3; ++c) {
        const auto expected = static_cast<double>(factor[c]);
        EXPECT_NEAR(sum[c] / 100000.0, expected, 4 * 0.0016 * expected) << "channel " << c << ", seed " << kSeed;
    }
}

TEST(RussianRoulette, NeverLetsNothingSurvive) { EXPECT_FALSE(RussianRoulette(glm::vec3(0.0F)).survives(0.0F)); }

} // namespace
} // namespace lambert
