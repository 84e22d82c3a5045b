/// Light from beyond the scene: directly by rays, and particles for the rest.
#include "scene/environment.h"
#include "scene/sky.h"
#include "statistics.h"
#include "vpl_case.h"

#include <gtest/gtest.h>

#include <memory>
#include <numbers>
#include <numeric>

namespace lambert {
namespace {

constexpr double kPi = std::numbers::pi;

Scene under(Environment sky, Scene scene) {
    scene.environment = std::make_shared<const Environment>(std::move(sky));
    return scene;
}

/// A level square of 1 m², its front up.
Scene ground() {
    const std::vector quads{std::array<glm::vec3, 4>{{{0, 0, 1}, {1, 0, 1}, {1, 0, 0}, {0, 0, 0}}}};
    return quadScene(quads, std::array{greyMaterial("ground", 0.5F)});
}

double redFlux(std::span<const VirtualPointLight> lights) {
    return std::accumulate(lights.begin(), lights.end(), 0.0, [](double sum, const VirtualPointLight& light) {
        return sum + static_cast<double>(light.flux.x);
    });
}

// Open ground reflects half of what it gets. Means over 16 scrambles at 4.5 standard errors of a Student distribution with 15
// degrees of freedom: odds of some 1 in 1000 for the two skies.
TEST(Sky, LightsOpenGround) {
    struct Case {
        Environment sky;
        double illuminance;
    };
    for (const Case& test : {Case{Environment::constant(Rgb(2.0F)), 2.0 * kPi}, Case{overcastSky(1000.0), 1000.0}}) {
        const VplCase c(under(test.sky, ground()));
        const Gathered direct = c.gather({}, std::array{c.receiver(0, 0.3F, 0.6F)}, {.skyRays = 4096});
        EXPECT_NEAR(direct.irradiance[0].x, test.illuminance, 1e-3 * test.illuminance);
        std::vector<double> first;
        for (std::uint64_t seed = 1; seed <= 16; ++seed) {
            const VirtualPointLights lights = c.trace({.particles = 20000, .seed = seed});
            EXPECT_TRUE(lights.ofBounces(0, 0).empty());
            first.push_back(redFlux(lights.ofBounces(1, 1)));
            EXPECT_EQ(lights.flux.emitted.x, 0.0);
            // What misses the ground, or meets its back, is not part of the scene's light.
            EXPECT_NEAR(lights.flux.received.x, 2.0 * first.back(), 1e-4 * first.back());
            EXPECT_EQ(lights.flux.backFaces.x, 0.0);
        }
        const MeanOfRuns mean(first);
        EXPECT_LT(mean.standardError, 0.01 * test.illuminance);
        EXPECT_NEAR(mean.mean, 0.5 * test.illuminance, 4.5 * mean.standardError);
    }
}

TEST(Sky, DoesNotReachIntoAClosedBox) {
    std::array<Material, 6> walls;
    walls.fill(greyMaterial("wall", 0.5F));
    const VplCase c(under(Environment::constant(Rgb(1.0F)), boxScene(glm::vec3(1.0F), walls)));
    const VirtualPointLights lights = c.trace({.particles = 5000});
    EXPECT_TRUE(lights.lights.empty());
    EXPECT_EQ(lights.flux.received.x, 0.0);
    EXPECT_EQ(c.gather({}, std::array{c.receiver(4, 0.5F, 0.5F)}, {}).irradiance[0].x, 0.0);
}

// In the corner of floor and wall under an even sky, where a bound takes away most of what the wall reflects: recovery gives it back,
// with the sky's light on the wall. Both have 2^17 particles; single lights near the point are what is left of noise.
TEST(Sky, IsPartOfWhatRecoveryFinds) {
    const std::array quads{std::array<glm::vec3, 4>{{{0, 0, 1}, {1, 0, 1}, {1, 0, 0}, {0, 0, 0}}},
                           std::array<glm::vec3, 4>{{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}}};
    const VplCase c(under(Environment::constant(Rgb(1.0F)),
                          quadScene(quads, std::array{greyMaterial("floor", 0.0F), greyMaterial("wall", 0.8F)})));
    const std::array receiver{c.receiver(0, 0.5F, 0.95F), c.receiver(0, 0.4F, 0.9F)};
    const VirtualPointLights lights = c.trace({.particles = 1U << 17});
    const Gathered free = c.gather(lights.lights, receiver, {.bound = kUnbounded});
    const Gathered bounded = c.gather(lights.lights, receiver, {.bound = 0.2});
    const Gathered recovered = c.gather(lights.lights, receiver, {.bound = 0.2, .recoveryRays = 4096});
    for (std::size_t i = 0; i < receiver.size(); ++i) {
        EXPECT_LT(bounded.irradiance[i].x, 0.9 * free.irradiance[i].x);
        EXPECT_NEAR(recovered.irradiance[i].x, free.irradiance[i].x, 0.02 * free.irradiance[i].x);
    }
}

} // namespace
} // namespace lambert
