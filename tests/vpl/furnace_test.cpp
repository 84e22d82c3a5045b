/// Closed boxes whose light is known exactly.
#include "core/parallel.h"
#include "scene/reading/scene_reader.h"
#include "statistics.h"
#include "vpl_case.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <cstdio>
#include <fstream>
#include <numbers>
#include <numeric>

namespace lambert {
namespace {

/// All walls alike.
Scene furnace(const Rgb& reflectance, const Rgb& emitted) {
    Material wall = greyMaterial("wall", 0.0F);
    wall.reflectance = reflectance;
    wall.emittedRadiance = emitted / std::numbers::pi_v<float>;
    return boxScene({4.0F, 3.0F, 2.5F}, {wall, wall, wall, wall, wall, wall});
}

glm::dvec3 fluxOf(std::span<const VirtualPointLight> lights) {
    return std::accumulate(lights.begin(), lights.end(), glm::dvec3(0.0),
                           [](const glm::dvec3& sum, const VirtualPointLight& l) { return sum + glm::dvec3(l.flux); });
}

constexpr double kArea = 2.0 * (12.0 + 10.0 + 7.5);

// Every particle meets a wall, and all walls are alike: each level has its exact flux, but for the rounding of 10^4 floats.
TEST(QuasiRandomWalk, HasTheFluxOfEveryTermOfTheSeries) {
    const Rgb reflectance(0.6F, 0.5F, 0.4F);
    const VplCase c(furnace(reflectance, Rgb(1.0F, 2.0F, 3.0F)));
    const VirtualPointLights lights = c.trace({.particles = 10000});
    EXPECT_NEAR(meanReflectance(c.scene), 0.5, 1e-7);
    double meanPower = 1.0;
    for (std::uint32_t k = 0; k < lights.particles.size(); ++k, meanPower *= 0.5) {
        EXPECT_EQ(lights.particles[k], static_cast<std::uint32_t>(10000 * meanPower)) << k;
        EXPECT_EQ(lights.ofBounces(k, k).size(), lights.particles[k]);
        for (int channel = 0; channel < 3; ++channel) {
            const double expected = kArea * (channel + 1) * std::pow(static_cast<double>(reflectance[channel]), k);
            EXPECT_NEAR(fluxOf(lights.ofBounces(k, k))[channel], expected, 1e-5 * expected) << k;
        }
    }
    EXPECT_EQ(lights.particles.size(), 14U); // 2^-13 · 10^4 > 1 > 2^-14 · 10^4
    EXPECT_EQ(lights.flux.escaped, glm::dvec3(0.0));
    EXPECT_EQ(lights.flux.backFaces, glm::dvec3(0.0));
    const ParticleFlux& flux = lights.flux;
    for (int channel = 0; channel < 3; ++channel) {
        EXPECT_NEAR(flux.emitted[channel], flux.absorbed[channel] + flux.lost[channel], 1e-5 * flux.emitted[channel]);
        // About 1/N: the mean channel's 2^-13.
        EXPECT_NEAR(flux.lost[channel] / flux.emitted[channel],
                    std::pow(static_cast<double>(reflectance[channel]), 13.0), 1e-6);
    }
}

TEST(FixedWalk, HasTheFluxOfTheFirstTermsOfTheSeries) {
    const VplCase c(furnace(Rgb(0.5F), Rgb(1.0F)));
    const VirtualPointLights lights = c.trace({.particles = 1000, .walk = Walk::Fixed, .bounces = 3});
    EXPECT_EQ(lights.lights.size(), 4000U);
    EXPECT_NEAR(fluxOf(lights.lights).x, kArea * 1.875, 1e-5 * kArea);
    EXPECT_NEAR(lights.flux.lost.x, kArea * 0.125, 1e-5 * kArea);
}

// A path has n lights with probability q^n, so that their number's standard deviation is √q / (1 − q) = 1.41 for q = 1/2, and of
// 10^4 paths' mean 1.4 % of 1; four of them.
TEST(RouletteWalk, HasTheFluxOfTheSeriesOnAverage) {
    const VplCase c(furnace(Rgb(0.5F, 0.5F, 0.25F), Rgb(1.0F)));
    const VirtualPointLights lights = c.trace({.particles = 10000, .walk = Walk::Roulette, .seed = 1});
    EXPECT_NEAR(fluxOf(lights.lights).x / kArea, 2.0, 4 * 0.0141);
    EXPECT_NEAR(fluxOf(lights.lights).z / kArea, 4.0 / 3.0, 4 * 0.0141);
    EXPECT_EQ(lights.flux.lost, glm::dvec3(0.0));
}

/// The largest and the RMS relative error of B = B_e + ρE over all channels, in a furnace in which B is B_e / (1 − ρ).
struct FurnaceError {
    double mean, rms, worst;
};
FurnaceError furnaceError(const GatherOptions& options, Walk walk = Walk::Quasi) {
    const Rgb reflectance(0.6F, 0.5F, 0.4F);
    const VplCase c(furnace(reflectance, Rgb(1.0F)));
    const VirtualPointLights lights = c.trace({.particles = 10000, .walk = walk});
    const Gathered gathered = c.gather(lights.lights, c.receivers(6), options);
    double sum = 0.0, squares = 0.0, worst = 0.0;
    for (const glm::dvec3& e : gathered.irradiance) {
        for (int channel = 0; channel < 3; ++channel) {
            const auto rho = static_cast<double>(reflectance[channel]);
            const double error = (1.0 + rho * e[channel]) * (1.0 - rho) - 1.0;
            sum += error;
            squares += error * error;
            worst = std::max(worst, std::abs(error));
        }
    }
    const double count = 3.0 * static_cast<double>(gathered.irradiance.size());
    const FurnaceError error{sum / count, std::sqrt(squares / count), worst};
    std::printf("furnace: mean error %.2e, RMS %.2e, worst %.2e; cut %.4f, recovered %.4f\n", error.mean, error.rms,
                error.worst, gathered.cut.x, gathered.recovered.x);
    return error;
}

TEST(Furnace, HasItsRadiosityWithinOnePercentUnbounded) { EXPECT_LT(furnaceError({.bound = kUnbounded}).rms, 0.01); }

TEST(Furnace, HasItsRadiosityWithinOnePercentCompensated) { EXPECT_LT(furnaceError({.recoveryRays = 64}).rms, 0.01); }

TEST(Furnace, IsDarkerWithABoundAlone) {
    const FurnaceError error = furnaceError({});
    EXPECT_LT(error.mean, -0.02);
}

TEST(Gathering, GivesTheSameBitsWithAnyNumberOfThreads) {
    const VplCase c(readScene(LAMBERT_DATA "/cornell_box.obj").scene);
    const auto run = [&](int threads) {
        setThreadCount(threads);
        const VirtualPointLights lights = c.trace({.particles = 3000});
        const Gathered gathered = c.gather(lights.lights, c.receivers(12), {.recoveryRays = 4});
        setThreadCount(0);
        return gathered;
    };
    const Gathered one = run(1), five = run(5);
    EXPECT_EQ(one.irradiance, five.irradiance);
    EXPECT_EQ(one.cut, five.cut);
    EXPECT_EQ(one.shadowRays, five.shadowRays);
    EXPECT_GT(one.recovered.x, 0.0);
}

// The continuous solution of cube6: fluxes of the lights on each wall are A B of it. Over 16 scrambles of the sequence; the
// reference is good to 1e-5. Six walls at 4.5 standard errors of a Student distribution with 15 degrees of freedom: odds of
// some 1 in 400.
TEST(QuasiRandomWalk, LeavesTheRadiosityOfCube6OnItsWalls) {
    nlohmann::json reference;
    std::ifstream(LAMBERT_DATA "/reference/analytic.json") >> reference;
    const VplCase c(readScene(LAMBERT_DATA "/cube6.obj").scene);
    for (const Walk walk : {Walk::Quasi, Walk::Roulette}) {
        std::vector<std::vector<double>> flux(6);
        for (std::uint64_t seed = 1; seed <= 16; ++seed) {
            const VirtualPointLights lights = c.trace({.particles = 16384, .walk = walk, .seed = seed});
            std::vector<double> onWall(6, 0.0);
            for (const VirtualPointLight& light : lights.lights)
                for (int axis = 0; axis < 3; ++axis)
                    if (std::abs(light.normal[axis]) > 0.5F)
                        onWall[static_cast<std::size_t>(2 * axis + (light.normal[axis] < 0.0F ? 1 : 0))] +=
                            static_cast<double>(light.flux.x);
            for (std::size_t wall = 0; wall < 6; ++wall) flux[wall].push_back(onWall[wall]);
        }
        for (std::size_t wall = 0; wall < 6; ++wall) {
            const MeanOfRuns mean(flux[wall]);
            const double expected = reference["cube6"]["B_face_mean_limit_approx"][wall];
            EXPECT_LT(mean.standardError, 0.01 * expected);
            EXPECT_NEAR(mean.mean, expected, 4.5 * mean.standardError + 2e-4 * expected) << "wall " << wall;
        }
    }
}

// Two lamps in a grey room: what the red one sends stays red, and each has the share of its own power.
TEST(QuasiRandomWalk, KeepsTheColoursOfTwoLamps) {
    std::array<Material, 6> walls;
    walls.fill(greyMaterial("wall", 0.5F));
    walls[4].emittedRadiance = Rgb(1.0F, 0.0F, 0.0F);
    walls[5].emittedRadiance = Rgb(0.0F, 3.0F, 0.0F);
    const VplCase c(boxScene(glm::vec3(1.0F), walls));
    const VirtualPointLights lights = c.trace({.particles = 10000});
    for (const VirtualPointLight& light : lights.lights) {
        EXPECT_EQ(light.flux.x * light.flux.y, 0.0F);
        EXPECT_EQ(light.flux.z, 0.0F);
    }
    const glm::dvec3 flux = fluxOf(lights.lights);
    // Which lamp a particle belongs to is decided by base 2: the shares of 10^4 and fewer particles are off by some 1/N.
    EXPECT_NEAR(flux.x / std::numbers::pi, 2.0, 0.02);
    EXPECT_NEAR(flux.y / std::numbers::pi, 6.0, 0.06);
    // The room is its own mirror image: what the red lamp gives to its own wall is a third of what the green one gives to its.
    // Means over 16 points; each lamp has 5000 particles, good for 1 %.
    const Gathered gathered = c.gather(lights.lights, c.receivers(4), {.bound = kUnbounded});
    const auto mean = [&](std::size_t wall, int channel) {
        double sum = 0.0;
        for (std::size_t i = 0; i < 16; ++i) sum += gathered.irradiance[16 * wall + i][channel] / 16.0;
        return sum;
    };
    EXPECT_NEAR(mean(4, 0) / mean(5, 1), 1.0 / 3.0, 0.02 / 3.0);
    EXPECT_NEAR(mean(5, 0) / mean(4, 1), 1.0 / 3.0, 0.02 / 3.0);
}

} // namespace
} // namespace lambert
