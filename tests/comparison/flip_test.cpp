#include "comparison/flip.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace lambert {
namespace {

Image uniform(const Rgb& colour, int width = 40, int height = 30) {
    Image image;
    image.width = width;
    image.height = height;
    image.pixels.assign(static_cast<std::size_t>(width * height), colour);
    image.content = PixelContent::Display;
    return image;
}

Image waves(float phase) {
    Image image = uniform(Rgb(0.0F), 64, 48);
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x)
            image.at(x, y) = {0.5F + 0.45F * std::sin(0.31F * static_cast<float>(x) + phase),
                              0.5F + 0.45F * std::sin(0.17F * static_cast<float>(y) - phase),
                              (x / 8 + y / 8) % 2 == 0 ? 0.8F : 0.1F};
    return image;
}

TEST(Flip, EqualPicturesAreAlike) {
    for (const float value : flipMap(waves(0.0F), waves(0.0F))) EXPECT_EQ(value, 0.0F);
}

TEST(Flip, IsTheSameBothWays) {
    const std::vector<float> a = flipMap(waves(0.0F), waves(0.5F));
    const std::vector<float> b = flipMap(waves(0.5F), waves(0.0F));
    for (std::size_t i = 0; i < a.size(); ++i) EXPECT_NEAR(a[i], b[i], 1e-5F);
}

// The paper scales the error so that the largest, between pure green and pure blue, is 1. Filtering rounds.
TEST(Flip, GreenAgainstBlueIsOne) {
    for (const float value : flipMap(uniform({0.0F, 1.0F, 0.0F}), uniform({0.0F, 0.0F, 1.0F})))
        EXPECT_NEAR(value, 1.0F, 1e-4F);
}

// Of uniform pictures nothing is left but the colour: black against white is |ΔL*| = 100, to the power 0.7, on the scale that ends at
// the distance of green and blue. By hand: L*a*b* of green 87.735, −86.183, 83.180, of blue 32.297, 79.188, −107.860; with Hunt's factor
// 0.01 L* the distance is 55.44 + √(101.19² + 107.81²) = 203.30, to the power 0.7: 41.28; 100^0.7 = 25.12 is above 0.4 of it.
TEST(Flip, BlackAgainstWhiteIsAsComputedByHand) {
    const double expected = 0.95 + 0.05 * (25.119 - 0.4 * 41.28) / (0.6 * 41.28);
    for (const float value : flipMap(uniform(Rgb(0.0F)), uniform(Rgb(1.0F)))) EXPECT_NEAR(value, expected, 1e-3);
}

TEST(Flip, MoreDifferenceIsMore) {
    double before = 0.0;
    for (const float phase : {0.05F, 0.1F, 0.2F, 0.4F}) {
        const double flip = meanOf(flipMap(waves(0.0F), waves(phase)));
        EXPECT_GT(flip, before);
        EXPECT_LT(flip, 1.0);
        before = flip;
    }
}

TEST(PeakSignalToNoise, IsThatOfTheEncodedColours) {
    // Encoded 0 and 0.1: 10 log10(1 / 0.01).
    const Image dark = uniform(Rgb(0.0F));
    const Image light = uniform(Rgb(std::pow((0.1F + 0.055F) / 1.055F, 2.4F)));
    EXPECT_NEAR(peakSignalToNoise(dark, light), 20.0, 1e-3);
    EXPECT_TRUE(std::isinf(peakSignalToNoise(light, light)));
}

} // namespace
} // namespace lambert
