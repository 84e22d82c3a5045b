/// Where particles leave lights and where they do not.
#include "core/error.h"
#include "scene/surface.h"
#include "statistics.h"
#include "vpl_case.h"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <numbers>
#include <numeric>
#include <vector>

namespace lambert {
namespace {

std::array<glm::vec3, 4> squareUp(float z) { return {{{0, 0, z}, {1, 0, z}, {1, 1, z}, {0, 1, z}}}; }
std::array<glm::vec3, 4> squareDown(float z) { return {{{0, 0, z}, {0, 1, z}, {1, 1, z}, {1, 0, z}}}; }

/// Two opposed unit squares at distance 1 (Howell's C-11).
constexpr double kOpposed = 0.199824895698387;

double redFlux(std::span<const VirtualPointLight> lights) {
    return std::accumulate(lights.begin(), lights.end(), 0.0, [](double sum, const VirtualPointLight& light) {
        return sum + static_cast<double>(light.flux.x);
    });
}

// A fifth of the particles meet the other square. Means over 32 scrambles, at 4.5 standard errors of a Student distribution with
// 31 degrees of freedom: odds of some 1 in 5000 for the two of them.
TEST(QuasiRandomWalk, KeepsItsCountWhereParticlesEscape) {
    const std::array quads{squareUp(0), squareDown(1)};
    const VplCase c(quadScene(quads, std::array{greyMaterial("lamp", 0.5F, 1.0F), greyMaterial("screen", 0.5F)}));
    std::vector<double> first, second, balance;
    for (std::uint64_t seed = 1; seed <= 32; ++seed) {
        const VirtualPointLights lights = c.trace({.particles = 30000, .seed = seed});
        EXPECT_EQ(lights.particles[1], 15000U);
        EXPECT_EQ(lights.particles[2], 7500U);
        for (const VirtualPointLight& light : lights.ofBounces(1, 1)) EXPECT_EQ(light.normal, glm::vec3(0, 0, -1));
        first.push_back(redFlux(lights.ofBounces(1, 1)));
        second.push_back(redFlux(lights.ofBounces(2, 2)));
        const ParticleFlux& flux = lights.flux;
        EXPECT_EQ(flux.backFaces.x, 0.0);
        balance.push_back(flux.absorbed.x + flux.escaped.x + flux.lost.x - flux.emitted.x);
    }
    EXPECT_NEAR(MeanOfRuns(first).mean, 0.5 * kOpposed, 4.5 * MeanOfRuns(first).standardError);
    EXPECT_NEAR(MeanOfRuns(second).mean, 0.25 * kOpposed * kOpposed, 4.5 * MeanOfRuns(second).standardError);
    EXPECT_NEAR(MeanOfRuns(balance).mean, 0.0, 4.5 * MeanOfRuns(balance).standardError);
    EXPECT_LT(MeanOfRuns(second).standardError, 0.01 * 0.25 * kOpposed * kOpposed);
}

TEST(QuasiRandomWalk, LeavesNoLightOnABlackBack) {
    const std::array quads{squareUp(0), squareUp(1)};
    const VplCase c(quadScene(quads, std::array{greyMaterial("lamp", 0.5F, 1.0F), greyMaterial("screen", 0.5F)}));
    const VirtualPointLights lights = c.trace({.particles = 10000});
    EXPECT_EQ(lights.lights.size(), 10000U);
    EXPECT_NEAR(lights.flux.backFaces.x, kOpposed, 0.01 * kOpposed);
}

// Emits on both sides, and reflects on both.
TEST(QuasiRandomWalk, TakesTwoSidedFacesOnBothSides) {
    Material lamp = greyMaterial("lamp", 0.5F, 1.0F);
    lamp.twoSided = true;
    const std::array quads{squareDown(0), squareUp(1), squareDown(2)};
    Material sheet = greyMaterial("sheet", 0.5F);
    sheet.twoSided = true;
    const VplCase c(quadScene(quads, std::array{sheet, lamp, sheet}));
    const VirtualPointLights lights = c.trace({.particles = 10000});
    int up = 0;
    for (const VirtualPointLight& light : lights.ofBounces(0, 0)) up += light.normal.z > 0.0F ? 1 : 0;
    EXPECT_EQ(up, 5000);
    EXPECT_NEAR(redFlux(lights.ofBounces(0, 0)), 2.0, 1e-4);
    EXPECT_NEAR(redFlux(lights.ofBounces(1, 1)), 2.0 * 0.5 * kOpposed, 0.01);
    for (const VirtualPointLight& light : lights.ofBounces(1, 1))
        EXPECT_EQ(light.normal.z, light.position.z < 1.0F ? 1.0F : -1.0F); // the faces' fronts look away
}

/// Texels along x: `left`, then `right`; the alpha of both.
std::shared_ptr<const Texture> halves(glm::vec4 left, glm::vec4 right) {
    return std::make_shared<Texture>("halves", 2, 1, std::vector<glm::vec4>{left, right});
}
SurfaceCorners unitCorners() {
    SurfaceCorners corners;
    corners.uv = corners.emissionUv = {{{0, 0}, {1, 0}, {1, 1}, {0, 1}}};
    return corners;
}

TEST(QuasiRandomWalk, TakesTheReflectanceOfTheTexelItHits) {
    Material floor = greyMaterial("floor", 0.8F);
    floor.reflectanceTexture.texture = 0;
    const std::array quads{squareUp(0), squareDown(1)};
    Scene scene = quadScene(quads, std::array{floor, greyMaterial("lamp", 0.0F, 1.0F)});
    scene.textures = {halves({0.5F, 0.25F, 0, 1}, {0, 1, 0, 1})};
    scene.surfaces = {unitCorners()};
    scene.polygons[0].surface = 0;
    const VplCase c(scene);
    // The floor's halves have 0.8 · .25 and 0.8 · 1/3 as mean, half of all area is the black lamp. Of the floor's 16 samples one
    // may lie in the wrong half.
    EXPECT_NEAR(meanReflectance(c.scene), 0.5 * 0.8 * (0.25 + 1.0 / 3.0) / 2.0, 0.5 * 0.8 * (1.0 / 3.0 - 0.25) / 15.0);
    const VirtualPointLights lights = c.trace({.particles = 10000});
    const double share = 10000.0 / lights.particles[1];
    for (const VirtualPointLight& light : lights.ofBounces(1, 1)) {
        const bool left = light.position.x < 0.5F;
        const glm::dvec3 expected = share * 1e-4 * (left ? glm::dvec3(0.4, 0.2, 0.0) : glm::dvec3(0.0, 0.8, 0.0));
        for (int channel = 0; channel < 3; ++channel)
            EXPECT_NEAR(static_cast<double>(light.flux[channel]), expected[channel], 1e-9);
    }
}

TEST(QuasiRandomWalk, EmitsAsTheTextureOfTheLampSays) {
    Material lamp = greyMaterial("lamp", 0.0F, 1.0F);
    lamp.emissionTexture.texture = 0;
    const std::vector quads{squareUp(0)};
    Scene scene = quadScene(quads, std::array{lamp});
    scene.textures = {halves({0, 0, 0, 1}, {1, 0.5F, 0, 1})};
    scene.surfaces = {unitCorners()};
    scene.polygons[0].surface = 0;
    const VirtualPointLights lights = VplCase(scene).trace({.particles = 1000});
    EXPECT_NEAR(redFlux(lights.lights), 0.5, 2e-3);
    for (const VirtualPointLight& light : lights.lights) EXPECT_GE(light.position.x, 0.5F);
}

// A leaf with a hole between lamp and floor: what passes through it arrives, and the rays of the lights do too.
TEST(QuasiRandomWalk, PassesThroughHoles) {
    Material leaf = greyMaterial("leaf", 0.5F);
    leaf.reflectanceTexture.texture = leaf.opacityTexture.texture = 0;
    leaf.opacityCutoff = 0.5F;
    const std::array quads{squareUp(0), squareDown(1), squareUp(0.001F)};
    Scene scene = quadScene(quads, std::array{greyMaterial("floor", 0.5F), greyMaterial("lamp", 0.0F, 1.0F), leaf});
    scene.textures = {halves({1, 1, 1, 0}, {1, 1, 1, 1})};
    scene.surfaces = {unitCorners()};
    scene.polygons[2].surface = 0;
    const VplCase c(scene);
    const VirtualPointLights lights = c.trace({.particles = 10000});
    for (const VirtualPointLight& light : lights.ofBounces(1, 1))
        EXPECT_EQ(light.position.z > 0.0005F, light.position.x > 0.5F) << light.position.x;
    const Gathered gathered =
        c.gather(lights.ofBounces(0, 0), std::array{c.receiver(0, 0.25F, 0.5F), c.receiver(0, 0.75F, 0.5F)}, {});
    EXPECT_GT(gathered.irradiance[0].x, 0.1);
    EXPECT_LT(gathered.irradiance[1].x, 0.001);
}

TEST(Recovery, SeesEmissionAndReflectionOfTheTexelItHits) {
    // A lit quarter right above the floor: the bound takes nearly all of it away, recovery gives it back.
    Material lamp = greyMaterial("lamp", 0.0F, 1.0F);
    const std::array quads{squareUp(0), squareDown(0.02F)};
    const VplCase c(quadScene(quads, std::array{greyMaterial("floor", 0.0F), lamp}));
    const std::array receiver{c.receiver(0, 0.5F, 0.5F)};
    const VirtualPointLights lights = c.trace({.particles = 1000});
    const Gathered bounded = c.gather(lights.lights, receiver, {.bound = 1.0});
    EXPECT_LT(bounded.irradiance[0].x, 0.8);
    // The factor is .9996; cosine-distributed rays all hit, only the sampled excess is random: 1024 stratified rays.
    const Gathered recovered = c.gather(lights.lights, receiver, {.bound = 1.0, .recoveryRays = 1024});
    EXPECT_NEAR(recovered.irradiance[0].x, 0.9984, 0.01);
}

TEST(TraceLights, RefusesOptionsOutOfRange) {
    const VplCase c(quadScene(std::vector{squareUp(0)}, std::array{greyMaterial("lamp", 0.5F, 1.0F)}));
    EXPECT_THROW(c.trace({.particles = 0}), UsageError);
    EXPECT_THROW(c.trace({.walk = Walk::Fixed, .bounces = 127}), UsageError);
    EXPECT_THROW(c.trace({.sampler = Sampler::Sobol}), UsageError);
    EXPECT_THROW(c.gather({}, {}, {.bound = 0.0}), UsageError);
}

TEST(TraceLights, LeavesNothingWhereNothingEmits) {
    const VplCase c(quadScene(std::vector{squareUp(0)}, std::array{greyMaterial("grey", 0.5F)}));
    EXPECT_TRUE(c.trace({}).lights.empty());
}

TEST(TraceLights, StopsWhenAsked) {
    const VplCase c(quadScene(std::vector{squareUp(0)}, std::array{greyMaterial("lamp", 0.5F, 1.0F)}));
    Progress progress;
    progress.cancel();
    EXPECT_THROW(traceLights(c.rays, {}, progress), Cancelled);
    const VirtualPointLights lights = c.trace({});
    EXPECT_THROW(gatherIrradiance(c.rays, lights.lights, std::array{c.receiver(0, 0.5F, 0.5F)}, {}, progress),
                 Cancelled);
}

} // namespace
} // namespace lambert
