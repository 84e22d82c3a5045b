#include "core/statistics.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

namespace lambert {
namespace {

TEST(Statistics, MeanAndDeviationOfKnownValues) {
    const MeanDeviation result = meanDeviation(std::array{2.0, 4.0, 4.0, 4.0, 5.0, 5.0, 7.0, 9.0});
    EXPECT_DOUBLE_EQ(result.mean, 5.0);
    EXPECT_NEAR(result.deviation, std::sqrt(32.0 / 7.0), 1e-15);
    EXPECT_EQ(meanDeviation(std::array{3.0}).deviation, 0.0);
}

TEST(Statistics, ExactPowerLawIsFoundWithoutError) {
    for (const double exponent : {-0.5, -1.0, 2.0, 0.0}) {
        std::array<double, 5> x{1e2, 3e3, 1e4, 5e6, 1e9}, y{};
        for (std::size_t i = 0; i < x.size(); ++i) y[i] = 7.0 * std::pow(x[i], exponent);
        const auto law = fitPowerLaw(x, y);
        ASSERT_TRUE(law);
        EXPECT_NEAR(law->exponent, exponent, 1e-14);
        EXPECT_NEAR(law->coefficient, 7.0, 1e-11); // the exponential of a sum of logarithms up to 20
        EXPECT_NEAR(law->exponentError, 0.0, 1e-14);
        EXPECT_NEAR(law->at(1e5), 7.0 * std::pow(1e5, exponent), 1e-11 * law->at(1e5));
    }
}

TEST(Statistics, ErrorOfTheSlopeIsThatOfTheTextbook) {
    // ln x = 0, 1, 2; ln y = 0, 1, 0: slope 0, residuals −1/3, 2/3, −1/3, squares 2/3, one degree of freedom, Σ (u − ū)² = 2.
    const std::array x{1.0, std::exp(1.0), std::exp(2.0)};
    const std::array y{1.0, std::exp(1.0), 1.0};
    const auto law = fitPowerLaw(x, y);
    ASSERT_TRUE(law);
    EXPECT_NEAR(law->exponent, 0.0, 1e-15);
    EXPECT_NEAR(law->exponentError, std::sqrt((2.0 / 3.0) / 2.0), 1e-14);
}

TEST(Statistics, PointsWithoutALogarithmAreLeftOut) {
    const std::array x{1.0, 2.0, 4.0, -1.0, 8.0, 16.0};
    const std::array y{1.0, 0.5, 0.25, 3.0, 0.0, std::nan("")};
    const auto law = fitPowerLaw(x, y);
    ASSERT_TRUE(law);
    EXPECT_NEAR(law->exponent, -1.0, 1e-14);
    EXPECT_FALSE(fitPowerLaw(std::array{1.0, 2.0}, std::array{1.0, 0.0}));
    EXPECT_FALSE(fitPowerLaw(std::array{2.0, 2.0, 2.0}, std::array{1.0, 3.0, 2.0}));
}

TEST(Statistics, CostIsReadOffBetweenThePointsAlongAPowerLaw) {
    const std::array cost{1.0, 4.0, 16.0};
    const std::array error{0.4, 0.2, 0.1}; // cost^(−1/2)
    EXPECT_NEAR(costToReach(0.3, cost, error).value(), 16.0 / 9.0, 1e-13);
    EXPECT_NEAR(costToReach(0.2, cost, error).value(), 4.0, 0.0);
    EXPECT_FALSE(costToReach(0.05, cost, error));
    EXPECT_FALSE(costToReach(0.5, cost, error)); // the first point has it already
}

} // namespace
} // namespace lambert
