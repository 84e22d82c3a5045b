/// What the bound of the geometric term takes away.
#include "core/random.h"
#include "scene/reading/scene_reader.h"
#include "statistics.h"
#include "vpl_case.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <cstdio>
#include <fstream>
#include <numbers>

namespace lambert {
namespace {

Scene cube6(float scale) {
    Scene scene = readScene(LAMBERT_DATA "/cube6.obj").scene;
    for (glm::vec3& position : scene.positions) position *= scale;
    return scene;
}

nlohmann::json analytic() {
    nlohmann::json reference;
    std::ifstream(LAMBERT_DATA "/reference/analytic.json") >> reference;
    return reference;
}

/// The mean irradiance of the continuous solution: E = (B − B_e) / ρ on every wall.
double exactMeanIrradiance() {
    const nlohmann::json cube = analytic()["cube6"];
    double sum = 0.0;
    for (std::size_t wall = 0; wall < 6; ++wall)
        sum += (cube["B_face_mean_limit_approx"][wall].get<double>() - cube["E"][wall].get<double>()) /
               cube["rho"][wall].get<double>();
    return sum / 6.0;
}

/// On every wall a random point in each of 5 × 5 equal parts.
std::vector<Receiver> randomReceivers(const VplCase& c, std::uint64_t seed) {
    std::vector<Receiver> receivers;
    for (std::uint32_t i = 0; i < 150; ++i) {
        const auto bits = philox({i, 0, 0, 0}, seed);
        const auto column = static_cast<float>(i % 5), row = static_cast<float>(i / 5 % 5);
        receivers.push_back(
            c.receiver(i / 25, (column + uniformFloat(bits[0])) / 5.0F, (row + uniformFloat(bits[1])) / 5.0F));
    }
    return receivers;
}

/// Mean irradiance over the walls, as a share of the exact one, over 24 independent sets of lights and receivers.
MeanOfRuns meanIrradiance(float scale, const GatherOptions& options) {
    const VplCase c(cube6(scale));
    const double exact = exactMeanIrradiance();
    std::vector<double> means;
    for (std::uint64_t seed = 1; seed <= 24; ++seed) {
        const VirtualPointLights lights = c.trace({.particles = 5000, .seed = seed});
        GatherOptions seeded = options;
        seeded.seed = seed;
        double sum = 0.0;
        for (const glm::dvec3& e : c.gather(lights.lights, randomReceivers(c, seed), seeded).irradiance) sum += e.x;
        means.push_back(sum / 150.0 / exact);
    }
    return MeanOfRuns(means);
}

// At three bounds of METHODS' independent table: four standard errors of 24 runs, 0.2 % of the irradiance.
TEST(Bound, TakesFromCube6WhatTheIndependentTableSays) {
    const nlohmann::json table =
        analytic()["vpl_clamp: loss of mean irradiance in cube6 for G<=b, infinitely many VPLs"];
    for (const std::string& bound : {std::string("1"), std::string("10"), std::string("100")}) {
        const MeanOfRuns found = meanIrradiance(1.0F, {.bound = std::stod(bound)});
        const double expected = table[bound];
        std::printf("G <= %s: loss %.4f +- %.4f, expected %.4f\n", bound.c_str(), 1.0 - found.mean, found.standardError,
                    expected);
        EXPECT_LT(found.standardError, 0.004);
        EXPECT_NEAR(1.0 - found.mean, expected, 4.0 * found.standardError) << bound;
    }
}

// Rays may decide differently at edges: of 150 × 24 receivers with some thousand lights each, a few.
TEST(Bound, ScalesWithTheScene) {
    const double loss = 1.0 - meanIrradiance(1.0F, {}).mean;
    for (const float scale : {1e-3F, 1e3F}) EXPECT_NEAR(1.0 - meanIrradiance(scale, {}).mean, loss, 1e-4) << scale;
}

TEST(Bound, IsCompensatedByRecovery) {
    for (const double bound : {1.0, 10.0}) {
        const MeanOfRuns found = meanIrradiance(1.0F, {.bound = bound, .recoveryRays = 16});
        std::printf("recovered at %g: %.4f +- %.4f\n", bound, found.mean, found.standardError);
        EXPECT_LT(found.standardError, 0.004);
        EXPECT_NEAR(found.mean, 1.0, 4.0 * found.standardError) << bound;
    }
}

} // namespace
} // namespace lambert
