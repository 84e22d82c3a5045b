#include "core/random.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

namespace lambert {
namespace {

using Block = std::array<std::uint32_t, 4>;

// The known-answer vectors that Random123 publishes for philox4x32-10 (kat_vectors).
TEST(Philox, GivesThePublishedAnswers) {
    EXPECT_EQ(philox({0, 0, 0, 0}, 0), (Block{0x6627e8d5, 0xe169c58d, 0xbc57ac4c, 0x9b00dbd8}));
    constexpr std::uint32_t kOnes = 0xffffffff;
    EXPECT_EQ(philox({kOnes, kOnes, kOnes, kOnes}, ~std::uint64_t{0}),
              (Block{0x408f276d, 0x41c83b0e, 0xa20bc7c6, 0x6d5451fd}));
    // Digits of π; the key's first word is the lower half.
    EXPECT_EQ(philox({0x243f6a88, 0x85a308d3, 0x13198a2e, 0x03707344}, 0x299f31d0a4093822),
              (Block{0xd16cfe09, 0x94fdcceb, 0x5001e420, 0x24126ea1}));
}

TEST(Philox, EveryWordOfCounterAndKeyMatters) {
    std::set<Block> blocks{philox({1, 2, 3, 4}, 5)};
    for (std::size_t word = 0; word < 4; ++word) {
        Block counter{1, 2, 3, 4};
        counter[word] ^= 0x80000000;
        blocks.insert(philox(counter, 5));
    }
    blocks.insert(philox({1, 2, 3, 4}, 5 + (std::uint64_t{1} << 63)));
    blocks.insert(philox({1, 2, 3, 4}, 4));
    EXPECT_EQ(blocks.size(), 7U);
}

TEST(UniformFloat, LiesBetweenZeroAndOneWithoutOne) {
    EXPECT_EQ(uniformFloat(0), 0.0F);
    EXPECT_LT(uniformFloat(0xffffffff), 1.0F);
    EXPECT_EQ(uniformFloat(0x80000000), 0.5F);
}

TEST(UniformFloat, OfPhiloxHasTheMomentsOfTheUniformDistribution) {
    constexpr int kBlocks = 100000;
    double sum = 0.0, squares = 0.0, cubes = 0.0, neighbours = 0.0;
    for (std::uint32_t i = 0; i < kBlocks; ++i) {
        std::array<double, 4> x{};
        const Block block = philox({i, 0, 0, 0}, 42);
        for (std::size_t k = 0; k < 4; ++k) {
            x[k] = static_cast<double>(uniformFloat(block[k]));
            ASSERT_GE(x[k], 0.0);
            ASSERT_LT(x[k], 1.0);
            sum += x[k];
            squares += x[k] * x[k];
            cubes += x[k] * x[k] * x[k];
        }
        neighbours += x[0] * x[1];
    }
    // Five standard errors: the variance of x^n is 1 / (2n + 1) − 1 / (n + 1)², that of a product 1/9 − 1/16.
    constexpr double kCount = 4.0 * kBlocks;
    const auto tolerance = [](double variance, double count) { return 5.0 * std::sqrt(variance / count); };
    EXPECT_NEAR(sum / kCount, 1.0 / 2.0, tolerance(1.0 / 12.0, kCount));
    EXPECT_NEAR(squares / kCount, 1.0 / 3.0, tolerance(4.0 / 45.0, kCount));
    EXPECT_NEAR(cubes / kCount, 1.0 / 4.0, tolerance(9.0 / 112.0, kCount));
    EXPECT_NEAR(neighbours / kBlocks, 1.0 / 4.0, tolerance(7.0 / 144.0, kBlocks));
}

} // namespace
} // namespace lambert
