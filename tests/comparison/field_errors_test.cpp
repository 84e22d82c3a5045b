#include "comparison/field_errors.h"

#include "core/error.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <vector>

namespace lambert {
namespace {

TEST(FieldErrors, OfKnownValues) {
    const FieldErrors e = fieldErrors(std::array{1.0, 2.0, 1.0}, std::array{2.0, 4.0, 6.0}, std::array{3.0, 4.0, 3.0});
    // By hand: differences 1, 0, -3; weights sum to 4.
    EXPECT_DOUBLE_EQ(e.mean, 4.0);
    EXPECT_DOUBLE_EQ(e.bias, -0.5);
    EXPECT_DOUBLE_EQ(e.meanAbsolute, 1.0);
    EXPECT_DOUBLE_EQ(e.rms, std::sqrt(2.5));
    EXPECT_DOUBLE_EQ(e.relativeRms, std::sqrt(2.5) / 4.0);
    EXPECT_DOUBLE_EQ(e.maximum, 3.0);
    EXPECT_DOUBLE_EQ(e.percentile99, 3.0);
    EXPECT_DOUBLE_EQ(e.energyRatio, 14.0 / 16.0);
}

TEST(FieldErrors, PercentileLeavesOutOneHundredthOfTheWeight) {
    const std::vector<double> reference(1000, 1.0);
    std::vector<double> weight(1000, 1.0), field = reference;
    for (std::size_t i = 0; i < 1000; ++i) field[i] = 1.0 + 1e-3 * static_cast<double>(i + 1);
    EXPECT_NEAR(fieldErrors(weight, reference, field).percentile99, 0.99, 1e-12);
    for (std::size_t i = 990; i < 1000; ++i) weight[i] = 0.0; // what has no weight counts only for the maximum
    const FieldErrors e = fieldErrors(weight, reference, field);
    EXPECT_NEAR(e.percentile99, 0.981, 1.001e-3);
    EXPECT_NEAR(e.maximum, 1.0, 1e-12);
}

TEST(FieldErrors, DoNotDependOnTheUnit) {
    const std::array weight{0.5, 0.25, 2.0}, reference{1.0, 5.0, 2.0}, field{1.5, 4.0, 2.25};
    std::array<double, 3> brightReference{}, brightField{};
    constexpr double kUnit = 1024.0; // a power of two: no rounding
    for (std::size_t i = 0; i < 3; ++i) {
        brightReference[i] = kUnit * reference[i];
        brightField[i] = kUnit * field[i];
    }
    const FieldErrors e = fieldErrors(weight, reference, field);
    const FieldErrors bright = fieldErrors(weight, brightReference, brightField);
    EXPECT_EQ(bright.relativeRms, e.relativeRms);
    EXPECT_EQ(bright.energyRatio, e.energyRatio);
    EXPECT_EQ(bright.rms, kUnit * e.rms);
    EXPECT_EQ(bright.maximum, kUnit * e.maximum);
}

TEST(FieldErrors, OfDarknessAreNone) {
    const FieldErrors e = fieldErrors(std::array{1.0}, std::array{0.0}, std::array{0.0});
    EXPECT_EQ(e.relativeRms, 0.0);
    EXPECT_EQ(e.energyRatio, 1.0);
}

TEST(FieldErrors, OfNothingAreRefused) {
    EXPECT_THROW(fieldErrors({}, {}, {}), UsageError);
    EXPECT_THROW(fieldErrors(std::array{0.0}, std::array{1.0}, std::array{1.0}), UsageError);
    EXPECT_THROW(fieldErrors(std::array{1.0}, std::array{1.0}, std::array{1.0, 2.0}), UsageError);
}

} // namespace
} // namespace lambert
