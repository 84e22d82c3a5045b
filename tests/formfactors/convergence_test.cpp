/// The rates at which one hemicube and one hemisphere converge to the exact factors of their centre, so that only aliasing is
/// left. Those of lines are in unbiased_test.cpp and global_lines_test.cpp.
#include "core/random.h"
#include "exact_case.h"
#include "formfactors/hemicube.h"
#include "formfactors/hemisphere.h"

#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdio>

namespace lambert {
namespace {

constexpr glm::vec3 kOrigin(0.0F), kUp(0.0F, 0.0F, 1.0F);
constexpr std::size_t kSquares = 12;

/// Squares of some 13° around the origin in all directions of the upper hemisphere, none before another: in two rings of six,
/// where they are, how they are tilted and turned at random. Their fronts look at the origin.
Scene squaresAround(std::uint32_t seed) {
    std::vector<std::array<glm::vec3, 4>> quads;
    for (std::uint32_t k = 0; k < kSquares; ++k) {
        const auto bits = philox({k, 0, 0, 0}, seed);
        const auto more = philox({k, 1, 0, 0}, seed);
        const float polar = glm::radians((k % 2 == 0 ? 28.0F : 62.0F) + 5.0F * uniformFloat(more[2]));
        const float azimuth = glm::radians(60.0F * static_cast<float>(k / 2) + 8.0F * uniformFloat(bits[0]));
        const glm::vec3 toSquare(std::sin(polar) * std::cos(azimuth), std::sin(polar) * std::sin(azimuth),
                                 std::cos(polar));
        const glm::vec3 tilt(uniformFloat(bits[1]) - 0.5F, uniformFloat(bits[2]) - 0.5F, uniformFloat(bits[3]) - 0.5F);
        const glm::vec3 normal = glm::normalize(-toSquare + 0.8F * tilt);
        const glm::vec3 across = glm::normalize(glm::cross(normal, glm::vec3(tilt.y, tilt.z, tilt.x + 1.0F)));
        const float turn = 6.2831853F * uniformFloat(more[0]);
        const glm::vec3 u = std::cos(turn) * across + std::sin(turn) * glm::cross(normal, across);
        const glm::vec3 v = glm::cross(normal, u);
        const glm::vec3 centre = (1.0F + 2.0F * uniformFloat(more[1])) * toSquare;
        const float half = 0.15F * glm::length(centre);
        quads.push_back(
            {centre - half * (u + v), centre + half * (u - v), centre + half * (u + v), centre + half * (v - u)});
    }
    return quadScene(quads, std::vector<Material>(kSquares, greyMaterial("square", 0.5F)));
}

struct Slope {
    double value, standardError;
};

/// Exponent of the RMS error in the number of rays: the mean over 32 scenes of 12 squares, each seen in two turns.
template <typename Method, typename Options>
Slope aliasingSlope() {
    constexpr std::uint32_t kScenes = 32, kTurns = 2;
    double sum = 0.0, squares = 0.0;
    for (std::uint32_t seed = 1; seed <= kScenes; ++seed) {
        const ExactCase c(squaresAround(seed));
        EXPECT_EQ(c.mesh.size(), kSquares);
        std::vector<double> rays, error;
        for (const int resolution : {32, 64, 128, 256}) {
            Options options;
            options.resolution = resolution;
            options.seed = seed;
            const Method method(c.mesh, c.rays, options);
            RowAccumulator accumulator(c.mesh.size());
            double sumOfSquares = 0.0;
            for (std::uint32_t turn = 0; turn < kTurns; ++turn) {
                method.pointRow(kOrigin, kUp, turn, accumulator);
                FormFactorRow row;
                accumulator.take(row);
                for (std::uint32_t k = 0; k < kSquares; ++k) {
                    std::array<glm::dvec3, 4> corners;
                    for (int i = 0; i < 4; ++i)
                        corners[static_cast<std::size_t>(i)] = glm::dvec3(c.mesh.position(k, i));
                    const double exact = pointToPolygon(glm::dvec3(kOrigin), glm::dvec3(kUp), corners);
                    sumOfSquares += std::pow(entry(row, k) - exact, 2.0);
                }
            }
            rays.push_back(static_cast<double>(method.raysPerRow()));
            error.push_back(std::sqrt(sumOfSquares));
        }
        const double slope = logarithmicSlope(rays, error);
        sum += slope;
        squares += slope * slope;
    }
    const double mean = sum / kScenes;
    const Slope result{mean, std::sqrt((squares / kScenes - mean * mean) / (kScenes - 1))};
    std::printf("slope %.3f ± %.3f, seeds 1 to %u\n", result.value, result.standardError, kScenes);
    return result;
}

// An edge crosses about √N of N cells, and each errs by about 1/N, independently if the grid lies at random: N^(−3/4). The
// slope's standard error is that over the 32 scenes, some 0.017: 4 of them are exceeded by chance (Student's t, 31 degrees of
// freedom) once in 2700 choices of seeds, and −1/2 or −1 are 14 away.
TEST(Hemicube, AliasingFallsWithThreeQuartersOfThePower) {
    const Slope slope = aliasingSlope<Hemicube, ViewOptions>();
    EXPECT_NEAR(slope.value, -0.75, 4.0 * slope.standardError);
}

TEST(Hemisphere, AliasingFallsWithThreeQuartersOfThePower) {
    const Slope slope = aliasingSlope<Hemisphere, ViewOptions>();
    EXPECT_NEAR(slope.value, -0.75, 4.0 * slope.standardError);
}

} // namespace
} // namespace lambert
