#include "formfactors/quadrature.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

namespace lambert {
namespace {

double integral(const std::vector<glm::dvec3>& polygon, int order, int powerX, int powerY) {
    std::vector<WeightedPoint> points;
    appendGaussPoints(polygon, order, points);
    double sum = 0.0;
    for (const auto& [p, weight] : points) sum += weight * std::pow(p.x, powerX) * std::pow(p.y, powerY);
    return sum;
}

double factorial(int n) { return std::tgamma(n + 1.0); }

// ∫ x^a y^b over the triangle (0,0) (1,0) (0,1) is a! b! / (a + b + 2)!, over the unit square 1 / ((a + 1)(b + 1)).
TEST(Quadrature, IntegratesPolynomialsOfTheDegreeItPromises) {
    const std::vector<glm::dvec3> triangle{{0, 0, 2}, {1, 0, 2}, {0, 1, 2}};
    const std::vector<glm::dvec3> square{{0, 0, 2}, {1, 0, 2}, {1, 1, 2}, {0, 1, 2}};
    for (int order = 1; order <= 8; ++order) {
        for (int a = 0; a < 2 * order; ++a) {
            for (int b = 0; a + b < 2 * order; ++b) {
                const double exact = factorial(a) * factorial(b) / factorial(a + b + 2);
                EXPECT_NEAR(integral(triangle, order, a, b) / exact, 1.0, 1e-12) << order << " " << a << " " << b;
                EXPECT_NEAR(integral(square, order, a, b) * (a + 1.0) * (b + 1.0), 1.0, 1e-12);
            }
        }
        // One degree more is too much: the rule is not better than it says, so the test can fail.
        EXPECT_GT(std::abs(integral(square, order, 2 * order, 0) * (2 * order + 1.0) - 1.0), 1e-12);
    }
}

TEST(Quadrature, WeightsAddUpToTheAreaOfAQuad) {
    // A trapezium of parallel sides 3 and 1 at distance 2: area 4, centroid at height 5/6.
    const std::vector<glm::dvec3> trapezium{{0, 0, 0}, {3, 0, 0}, {1.5, 0, 2}, {0.5, 0, 2}};
    for (int order = 2; order <= 8; ++order) {
        std::vector<WeightedPoint> points;
        appendGaussPoints(trapezium, order, points);
        double area = 0.0, height = 0.0;
        for (const auto& [p, weight] : points) {
            area += weight;
            height += weight * p.z;
        }
        EXPECT_NEAR(area, 4.0, 1e-13);
        EXPECT_NEAR(height / area, 5.0 / 6.0, 1e-13);
    }
}

} // namespace
} // namespace lambert
