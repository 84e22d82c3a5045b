/// Lights without area: exact direct light, and particles for the rest.
#include "scene/punctual_light.h"
#include "vpl_case.h"

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include <numbers>
#include <numeric>

namespace lambert {
namespace {

/// A closed grey box of 2 m with one light and nothing that emits.
Scene litBox(const PunctualLight& light) {
    std::array<Material, 6> walls;
    walls.fill(greyMaterial("wall", 0.5F));
    Scene scene = boxScene(glm::vec3(2.0F), walls);
    scene.lights = {light};
    return scene;
}

PunctualLight pointLight(const glm::vec3& position) {
    PunctualLight light;
    light.position = position;
    light.intensity = Rgb(4.0F, 2.0F, 1.0F);
    return light;
}

double redFlux(std::span<const VirtualPointLight> lights) {
    return std::accumulate(lights.begin(), lights.end(), 0.0, [](double sum, const VirtualPointLight& light) {
        return sum + static_cast<double>(light.flux.x);
    });
}

TEST(PointLight, GivesItsDirectLightExactlyAndTheRestByParticles) {
    const VplCase c(litBox(pointLight({0.5F, 1.0F, 1.5F})));
    const VirtualPointLights lights = c.trace({.particles = 20000});
    EXPECT_TRUE(lights.ofBounces(0, 0).empty());
    // Every particle meets a wall of reflectance 1/2.
    EXPECT_NEAR(redFlux(lights.ofBounces(1, 1)), 0.5 * 16.0 * std::numbers::pi, 1e-3);
    EXPECT_EQ(lights.ofBounces(1, 1).size(), 10000U);

    const Receiver receiver = c.receiver(4, 0.3F, 0.6F); // on the floor
    const Gathered direct = c.gather({}, std::array{receiver}, {});
    const glm::dvec3 way = glm::dvec3(0.5, 1.0, 1.5) - glm::dvec3(receiver.position);
    const double expected = 4.0 * way.z / std::pow(glm::length(way), 3.0);
    EXPECT_NEAR(direct.irradiance[0].x, expected, 1e-6 * expected);
    EXPECT_NEAR(direct.irradiance[0].z, expected / 4.0, 1e-6 * expected);
    // A furnace's indirect light but for its unevenness: the mean of E over the walls is Φ / (A (1 − ρ)).
    const auto everywhere = c.receivers(12);
    double mean = 0.0;
    for (const glm::dvec3& e : c.gather(lights.lights, everywhere, {.bound = kUnbounded}).irradiance)
        mean += e.x / static_cast<double>(everywhere.size());
    const double balance = 16.0 * std::numbers::pi / (24.0 * 0.5);
    EXPECT_NEAR(mean, balance, 0.01 * balance); // 144 points per wall for an uneven direct light
}

TEST(PointLight, InACeilingsPlaneIsNotBehindIt) {
    const VplCase c(litBox(pointLight({1.0F, 1.0F, 2.0F})));
    const Gathered direct = c.gather({}, std::array{c.receiver(4, 0.5F, 0.5F)}, {});
    EXPECT_NEAR(direct.irradiance[0].x, 4.0 / 4.0, 1e-6);
}

TEST(Spot, GivesNothingOutsideItsCone) {
    PunctualLight light = pointLight({1.0F, 1.0F, 1.9F});
    light.kind = PunctualLight::Kind::Spot;
    light.direction = {0.0F, 0.0F, -1.0F};
    light.outerConeAngle = 0.3F;
    const VplCase c(litBox(light));
    const Gathered direct = c.gather({}, std::array{c.receiver(4, 0.5F, 0.5F), c.receiver(4, 0.95F, 0.5F)}, {});
    EXPECT_NEAR(direct.irradiance[0].x, 4.0 / (1.9 * 1.9), 1e-5);
    EXPECT_EQ(direct.irradiance[1].x, 0.0);
    const VirtualPointLights lights = c.trace({.particles = 1000});
    EXPECT_NEAR(redFlux(lights.ofBounces(1, 1)), 0.5 * totalFlux(light).x, 1e-4);
    for (const VirtualPointLight& first : lights.ofBounces(1, 1)) EXPECT_EQ(first.position.z, 0.0F);
}

// A floor in the sun, with a sheet above half of it.
TEST(DirectionalLight, LightsWhatItsRaysReach) {
    const std::array quads{std::array<glm::vec3, 4>{{{0, 0, 0}, {2, 0, 0}, {2, 1, 0}, {0, 1, 0}}},
                           std::array<glm::vec3, 4>{{{1, 0, 0.5F}, {2, 0, 0.5F}, {2, 1, 0.5F}, {1, 1, 0.5F}}}};
    Scene scene = quadScene(quads, std::array{greyMaterial("floor", 0.5F), greyMaterial("sheet", 0.25F)});
    PunctualLight sun;
    sun.kind = PunctualLight::Kind::Directional;
    sun.direction = glm::normalize(glm::vec3(0.0F, 0.6F, -0.8F));
    sun.intensity = Rgb(10.0F);
    scene.lights = {sun};
    const VplCase c(scene);
    const Gathered direct = c.gather({}, std::array{c.receiver(0, 0.25F, 0.5F), c.receiver(0, 0.75F, 0.8F)}, {});
    EXPECT_NEAR(direct.irradiance[0].x, 8.0, 1e-5);
    EXPECT_EQ(direct.irradiance[1].x, 0.0);
    // Lit: the sheet, and of the floor what is not in its shadow, which is moved by 3/8 along y.
    const VirtualPointLights lights = c.trace({.particles = 200000});
    const double expected = 8.0 * (0.25 * 1.0 + 0.5 * (2.0 - 0.625));
    EXPECT_NEAR(redFlux(lights.ofBounces(1, 1)), expected, 0.01 * expected);
    EXPECT_GT(lights.flux.escaped.x, 0.0);
}

} // namespace
} // namespace lambert
