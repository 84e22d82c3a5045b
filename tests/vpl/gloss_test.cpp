/// Phong lobes of lights and of receivers.
#include "core/error.h"
#include "core/parallel.h"
#include "core/random.h"
#include "scene/environment.h"
#include "scene/reading/scene_reader.h"
#include "statistics.h"
#include "vpl_case.h"

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include <cstdio>
#include <numbers>
#include <numeric>

namespace lambert {
namespace {

constexpr double kPi = std::numbers::pi;

/// Nothing but a scrap of paper, far away.
Scene emptySpace() {
    return quadScene(
        std::array<std::array<glm::vec3, 4>, 1>{
            {{{{500, 500, 500}, {501, 500, 500}, {501, 501, 500}, {500, 501, 500}}}}},
        std::array{greyMaterial("paper", 0.0F)});
}

/// A light at the origin of a surface that looks up, with flux 1 in its lobe alone.
VirtualPointLight lobeLight(const glm::vec3& axis, float exponent) {
    VirtualPointLight light;
    light.normal = {0, 0, 1};
    light.lobe = {Rgb(1.0F), glm::normalize(axis), exponent};
    return light;
}

// Points on the unit sphere that look at the light, n² of them in equal areas of the hemisphere above the horizon, by
// the middle points of cells: the rule errs by P (P+1) / (24 · 500²), 0.0004 for P = 50.
double fluxAbove(const VplCase& c, const VirtualPointLight& light) {
    constexpr int n = 500;
    std::vector<Receiver> receivers;
    for (int row = 0; row < n; ++row) {
        for (int column = 0; column < n; ++column) {
            const float z = (static_cast<float>(row) + 0.5F) / n;
            const float angle = 2.0F * std::numbers::pi_v<float> * (static_cast<float>(column) + 0.5F) / n;
            const glm::vec3 p(std::sqrt(1 - z * z) * std::cos(angle), std::sqrt(1 - z * z) * std::sin(angle), z);
            receivers.push_back({p, -p});
        }
    }
    const Gathered gathered = c.gather(std::array{light}, receivers, {.bound = kUnbounded});
    const double sum = std::accumulate(gathered.irradiance.begin(), gathered.irradiance.end(), 0.0,
                                       [](double s, const glm::dvec3& e) { return s + e.x; });
    return sum * 2.0 * kPi / (n * n);
}

TEST(LightLobe, UprightSendsAllItsFluxAbove) {
    const VplCase c(emptySpace());
    for (const float exponent : {0.0F, 1.0F, 10.0F, 50.0F})
        EXPECT_NEAR(fluxAbove(c, lobeLight({0, 0, 1}, exponent)), 1.0, 1e-3) << exponent;
}

// Of a hemisphere tilted by θ the part above the horizon is 1 − θ/π, of a cosine (1 + cosθ)/2; of a lobe that lies down
// one half.
TEST(LightLobe, TiltedLosesWhatLiesBelowTheHorizon) {
    const VplCase c(emptySpace());
    for (const double degrees : {20.0, 45.0, 70.0, 90.0}) {
        const double theta = kPi / 180.0 * degrees;
        const glm::vec3 axis(std::sin(theta), 0.0, std::cos(theta));
        EXPECT_NEAR(fluxAbove(c, lobeLight(axis, 0.0F)), 1.0 - theta / kPi, 2e-3) << degrees;
        EXPECT_NEAR(fluxAbove(c, lobeLight(axis, 1.0F)), 0.5 + 0.5 * std::cos(theta), 2e-3) << degrees;
    }
    EXPECT_NEAR(fluxAbove(c, lobeLight({1, 0, 0}, 40.0F)), 0.5, 2e-3);
}

// E = (P+1)/2π Φ h^(P+1) / d^(P+3) at distance d from a light that shines straight down on a plane h below; in float to
// 1e-5.
TEST(LightLobe, OnAPlaneBelowIsTheClosedForm) {
    const VplCase c(emptySpace());
    for (const double exponent : {0.0, 1.0, 7.0, 50.0}) {
        for (const double h : {0.5, 2.0}) {
            std::vector<Receiver> receivers;
            std::vector<double> expected;
            for (const double s : {0.0, 0.3, 1.0, 2.5}) {
                receivers.push_back({glm::vec3(glm::dvec3(s, 0.0, h)), {0, 0, -1}});
                expected.push_back((exponent + 1.0) / (2.0 * kPi) * std::pow(h, exponent + 1.0) /
                                   std::pow(std::hypot(s, h), exponent + 3.0));
            }
            const Gathered gathered = c.gather(std::array{lobeLight({0, 0, 1}, static_cast<float>(exponent))},
                                               receivers, {.bound = kUnbounded});
            for (std::size_t i = 0; i < receivers.size(); ++i)
                EXPECT_NEAR(gathered.irradiance[i].y, expected[i], 2e-5 * expected[i]) << exponent << ' ' << h;
        }
    }
}

// (P+1)/2 cosθ_x / d² is the geometric term of a lobe along its axis.
TEST(LightLobe, IsBoundedAndWhatIsCutIsTold) {
    const VplCase c(emptySpace());
    const double largest = largestGeometricTerm(c.scene, 1.0); // 6 / m²
    EXPECT_NEAR(largest, 6.0, 1e-3);
    const Receiver receiver{{0, 0, 0.5F}, {0, 0, -1}};
    const Gathered gathered = c.gather(std::array{lobeLight({0, 0, 1}, 9.0F)}, std::array{receiver}, {.bound = 1.0});
    EXPECT_NEAR(gathered.irradiance[0].x, largest / kPi, 1e-5);
    EXPECT_NEAR(gathered.cutAt[0].x, (5.0 / 0.25 - largest) / kPi, 1e-4);
}

// What arrives from o and is seen from i, against the reverse: f(i, o) cosθ_o is the same, f is not.
TEST(ReceiverGloss, ChangesWithTheDirectionsExchangedAsItsCosines) {
    const VplCase c(emptySpace());
    const glm::vec3 i = glm::normalize(glm::vec3(0.9F, 0.2F, 0.4F)), o = glm::normalize(glm::vec3(-0.5F, 0.1F, 0.9F));
    const auto brdf = [&](const glm::vec3& from, const glm::vec3& to) {
        VirtualPointLight light{from, -from, Rgb(1.0F)};
        Receiver receiver{{0, 0, 0}, {0, 0, 1}};
        receiver.gloss = {{Rgb(0.25F, 0.5F, 1.0F), 5.0F}, to};
        const Gathered gathered = c.gather(std::array{light}, std::array{receiver}, {.bound = kUnbounded});
        EXPECT_NEAR(gathered.glossyRadiance[0].x, 0.25 * gathered.glossyRadiance[0].z, 1e-9);
        return gathered.glossyRadiance[0].z / gathered.irradiance[0].z;
    };
    const glm::vec3 mirror(-i.x, -i.y, i.z);
    const double expected = phongDensity(5.0, static_cast<double>(glm::dot(mirror, o))) / static_cast<double>(o.z);
    EXPECT_NEAR(brdf(i, o), expected, 1e-5 * expected);
    EXPECT_NEAR(brdf(i, o) / brdf(o, i), static_cast<double>(i.z / o.z), 1e-4);
}

/// A lamp of 1 m² that looks down on a floor of 3 m × 3 m from 1 m.
Scene lampOverFloor() {
    const std::array quads{std::array<glm::vec3, 4>{{{0, 0, 1}, {0, 1, 1}, {1, 1, 1}, {1, 0, 1}}},
                           std::array<glm::vec3, 4>{{{-1, -1, 0}, {2, -1, 0}, {2, 2, 0}, {-1, 2, 0}}}};
    return quadScene(quads, std::array{greyMaterial("lamp", 0.0F, 3.0F), greyMaterial("floor", 0.0F)});
}

// In a mirror of ρ_s = 0.8 the lamp's middle has 0.8 of its radiance, and beside it is nothing. 65536 lights, of which
// the lobe sees a hundred: 2 % for their noise and for the lobe's width, 1/P of the curvature of cosines.
TEST(ReceiverGloss, OfALargeExponentIsAMirror) {
    const VplCase c(lampOverFloor());
    const VirtualPointLights lights = c.trace({.particles = 65536});
    std::vector<Receiver> receivers;
    for (const float x :
         {0.2F, -1.5F}) { // mirrored, the one meets the lamp 0.3 m from its edge, the other passes it by 1 m
        Receiver receiver = c.receiver(1, 0.5F, 0.5F);
        receiver.gloss = {{Rgb(0.8F), 1000.0F}, glm::normalize(glm::vec3(x, 0.0F, 1.0F))};
        receivers.push_back(receiver);
    }
    const Gathered gathered = c.gather(lights.lights, receivers, {.bound = kUnbounded});
    const double radiance = 3.0 / kPi * 0.8;
    EXPECT_NEAR(gathered.glossyRadiance[0].x, radiance, 0.02 * radiance);
    EXPECT_LT(gathered.glossyRadiance[1].x, 1e-6);
    // Whoever looks from below sees nothing, and who has no gloss sends nothing.
    receivers[0].gloss.toEye = {0, 0, -1};
    receivers[1].gloss = {};
    for (const glm::dvec3& l : c.gather(lights.lights, receivers, {.bound = kUnbounded}).glossyRadiance)
        EXPECT_EQ(l, glm::dvec3(0.0));
    EXPECT_TRUE(c.gather(lights.lights, std::span(receivers).subspan(1), {}).glossyRadiance.empty());
}

// The highlight of a point light is what the lobe makes of its irradiance.
TEST(ReceiverGloss, ShowsLightsWithoutAreaAndTheSky) {
    Scene scene = emptySpace();
    PunctualLight& lamp = scene.lights.emplace_back();
    lamp.position = {0, 3, 4};
    lamp.intensity = Rgb(50.0F);
    Receiver receiver{{0, 0, 0}, {0, 0, 1}};
    receiver.gloss = {{Rgb(0.5F), 20.0F}, glm::normalize(glm::vec3(0.0F, -2.0F, 4.0F))};
    const auto radiance = [&](const Scene& s) {
        return VplCase(s).gather({}, std::array{receiver}, {}).glossyRadiance.at(0).x;
    };
    const double cosine =
        static_cast<double>(glm::dot(glm::normalize(glm::vec3(0, 3, 4)), glm::normalize(glm::vec3(0, 2, 4))));
    const double toEye = 4.0 / std::sqrt(20.0);
    const double expected = 50.0 * 0.8 / 25.0 * 0.5 * phongDensity(20.0, cosine) / toEye;
    EXPECT_NEAR(radiance(scene), expected, 1e-5 * expected);
    // Of a sky that is 1 everywhere, seen from straight above: ρ_s (P+1) ∫ cos^(P+1) = ρ_s (P+1)/(P+2). By 1024
    // stratified rays.
    scene.lights.clear();
    scene.environment = std::make_shared<Environment>(Environment::constant(Rgb(1.0F)));
    receiver.gloss.toEye = {0, 0, 1};
    EXPECT_NEAR(radiance(scene), 0.5 * 21.0 / 22.0, 1e-3);
}

std::vector<PhongLobe> glossOfFloor(const Scene& scene, const Rgb& reflectance, float exponent) {
    std::vector<PhongLobe> gloss(scene.materials.size());
    for (std::size_t m = 0; m < gloss.size(); ++m)
        if (scene.materials[m].name == "floor") gloss[m] = {reflectance, exponent};
    return gloss;
}

// The same light two ways: lobes that particles leave on the floor shine on a wall point; and points of the floor look
// toward the wall point and reflect the lamp's own lights, weighted as an emitter would be. Over 16 seeds; four
// standard errors of the difference, odds of 1 in 1000 by Student's distribution.
TEST(Gloss, OfLightsIsThatOfReceivers) {
    const VplCase c(lampOverFloor());
    const Receiver sensor{{2.2F, 0.6F, 0.7F}, glm::normalize(glm::vec3(-1.0F, 0.1F, -0.4F))};
    const std::vector<PhongLobe> gloss = glossOfFloor(c.scene, Rgb(0.6F), 12.0F);
    std::vector<double> byLights, byReceivers;
    for (std::uint64_t seed = 1; seed <= 16; ++seed) {
        const VirtualPointLights lights =
            c.trace({.particles = 20000, .walk = Walk::Fixed, .bounces = 1, .gloss = gloss, .seed = seed});
        const Gathered onSensor = c.gather(lights.ofBounces(1, 1), std::array{sensor}, {.bound = kUnbounded});
        byLights.push_back(onSensor.irradiance[0].x);

        std::vector<Receiver> floor;
        std::vector<double> weight; // cosines / d² dA
        for (std::uint32_t k = 0; k < 2500; ++k) {
            const auto bits = philox({k, 0, 0, 0}, seed);
            Receiver receiver = c.receiver(1, (static_cast<float>(k % 50) + uniformFloat(bits[0])) / 50,
                                           (static_cast<float>(k / 50) + uniformFloat(bits[1])) / 50);
            const glm::vec3 way = sensor.position - receiver.position;
            const auto squared = static_cast<double>(glm::dot(way, way));
            receiver.gloss = {gloss[1], glm::normalize(way)};
            const float cosine = -glm::dot(sensor.normal, receiver.gloss.toEye);
            weight.push_back(std::max(0.0, static_cast<double>(cosine * receiver.gloss.toEye.z)) / squared * 9.0 /
                             2500);
            floor.push_back(receiver);
        }
        const VirtualPointLights lamp =
            c.trace({.particles = 1000, .walk = Walk::Fixed, .bounces = 0, .seed = seed + 100});
        const Gathered seen = c.gather(lamp.lights, floor, {.bound = kUnbounded});
        double sum = 0.0;
        for (std::size_t k = 0; k < floor.size(); ++k) sum += weight[k] * seen.glossyRadiance[k].x;
        byReceivers.push_back(sum);
    }
    const MeanOfRuns a(byLights), b(byReceivers);
    std::printf("by lights %.5f +- %.5f, by receivers %.5f +- %.5f\n", a.mean, a.standardError, b.mean,
                b.standardError);
    EXPECT_LT(std::hypot(a.standardError, b.standardError), 0.01 * b.mean);
    EXPECT_NEAR(a.mean, b.mean, 4.0 * std::hypot(a.standardError, b.standardError));
}

// A point light over a mirror is as if there were a second one below, but for the lobe's width: its mean direction is
// shorter than 1 by 1/P and its light spreads over 1/√P. Over 8 seeds, five standard errors (Student, 7 degrees of
// freedom: 1 in 600) and 1/P twice.
TEST(Gloss, OfALargeExponentMakesAMirrorImageOfAPointLight) {
    const std::array<std::array<glm::vec3, 4>, 1> quads{{{{{-9, -9, 0}, {9, -9, 0}, {9, 9, 0}, {-9, 9, 0}}}}};
    Scene scene = quadScene(quads, std::array{greyMaterial("floor", 0.0F)});
    PunctualLight& lamp = scene.lights.emplace_back();
    lamp.position = {0, 0, 1};
    lamp.intensity = Rgb(1.0F);
    const VplCase c(scene);
    const float exponent = 400.0F;
    const Receiver receiver{{1.5F, 0, 1}, {0, 0, -1}};
    std::vector<double> found;
    for (std::uint64_t seed = 1; seed <= 8; ++seed) {
        const VirtualPointLights lights = c.trace({.particles = 1 << 18,
                                                   .walk = Walk::Fixed,
                                                   .bounces = 1,
                                                   .gloss = glossOfFloor(c.scene, Rgb(0.8F), exponent),
                                                   .seed = seed});
        found.push_back(
            c.gather(lights.lights, std::array{receiver}, {.bound = kUnbounded, .direct = false}).irradiance[0].x);
    }
    const MeanOfRuns mean(found);
    const double expected = 0.8 * 2.0 / std::pow(1.5 * 1.5 + 4.0, 1.5); // cosθ = 2/d, from 2 m below
    std::printf("mirror image: %.5f +- %.5f, expected %.5f\n", mean.mean, mean.standardError, expected);
    EXPECT_LT(mean.standardError, 0.01 * expected);
    EXPECT_NEAR(mean.mean, expected, 5.0 * mean.standardError + 2.0 / static_cast<double>(exponent) * expected);
}

Scene greyRoom() {
    std::array<Material, 6> walls;
    walls.fill(greyMaterial("floor", 0.4F, 1.0F));
    return boxScene({4.0F, 3.0F, 2.5F}, walls);
}

// Every hit leaves 0.4 of the flux diffusely and 0.3 in a lobe. What goes on is chosen by chance, so that sums balance
// on average: a walk's weight varies by less than its mean, of 20 000 walks 0.7 %; four of them. Survivors of roulette:
// 0.7 ± 0.0032, four of them.
TEST(GlossyWalk, KeepsTheFlux) {
    const VplCase c(greyRoom());
    const std::vector<PhongLobe> gloss = glossOfFloor(c.scene, Rgb(0.3F), 8.0F);
    EXPECT_NEAR(meanReflectance(c.scene, gloss), 0.7, 1e-6);
    for (const Walk walk : {Walk::Quasi, Walk::Roulette, Walk::Fixed}) {
        const VirtualPointLights lights =
            c.trace({.particles = 20000, .walk = walk, .bounces = 6, .gloss = gloss, .seed = 3});
        const double emitted = lights.flux.emitted.x;
        glm::dvec2 first(0.0);
        for (const VirtualPointLight& light : lights.ofBounces(1, 1))
            first += glm::dvec2(light.flux.x, light.lobe.flux.x);
        EXPECT_NEAR(first.x / emitted, 0.4, walk == Walk::Roulette ? 0.013 : 1e-4);
        EXPECT_NEAR(first.y / emitted, 0.3, walk == Walk::Roulette ? 0.013 : 1e-4);
        EXPECT_EQ(lights.ofBounces(0, 0).front().lobe.flux, Rgb(0.0F));
        const ParticleFlux& flux = lights.flux;
        EXPECT_GT(flux.belowHorizon.x, 0.01 * emitted);
        EXPECT_EQ(flux.escaped.x, 0.0);
        EXPECT_NEAR((flux.absorbed.x + flux.belowHorizon.x + flux.lost.x) / emitted, 1.0, 0.028);
    }
}

// Cosine-distributed light on a wall: of a lobe with P = 1 about the mirrored direction (1 + cosθ)/2 lies above the
// horizon, its mean over 2 sinθ cosθ dθ is 5/6. One sixth of a lobe's flux goes below. One particle in 14 has that end
// with the weight 0.7: of 50 000 the mean has a standard deviation of at most 0.0008; four of them.
TEST(GlossyWalk, LosesBelowTheHorizonWhatTheLobeHasThere) {
    const VplCase c(greyRoom());
    const VirtualPointLights lights = c.trace({.particles = 50000,
                                               .walk = Walk::Fixed,
                                               .bounces = 2,
                                               .gloss = glossOfFloor(c.scene, Rgb(0.3F), 1.0F),
                                               .seed = 1});
    EXPECT_NEAR(lights.flux.belowHorizon.x / lights.flux.emitted.x, 0.3 / 6.0, 0.0032);
}

TEST(GlossyWalk, WithoutGlossIsTheDiffuseOneToTheBit) {
    const VplCase c(readScene(LAMBERT_DATA "/cornell_box.obj").scene);
    const VirtualPointLights none = c.trace({.particles = 2000});
    const VirtualPointLights black =
        c.trace({.particles = 2000, .gloss = std::vector<PhongLobe>(c.scene.materials.size())});
    ASSERT_EQ(none.lights.size(), black.lights.size());
    for (std::size_t i = 0; i < none.lights.size(); ++i) {
        EXPECT_EQ(none.lights[i].position, black.lights[i].position);
        EXPECT_EQ(none.lights[i].flux, black.lights[i].flux);
    }
}

TEST(Gloss, GivesTheSameBitsWithAnyNumberOfThreads) {
    const VplCase c(readScene(LAMBERT_DATA "/cornell_box.obj").scene);
    const auto run = [&](int threads) {
        setThreadCount(threads);
        const VirtualPointLights lights =
            c.trace({.particles = 2000, .gloss = glossOfFloor(c.scene, Rgb(0.2F), 30.0F), .seed = 4});
        std::vector<Receiver> receivers = c.receivers(8);
        for (Receiver& receiver : receivers) receiver.gloss = {{Rgb(0.3F), 50.0F}, receiver.normal};
        const Gathered gathered = c.gather(lights.lights, receivers, {});
        setThreadCount(0);
        return std::pair(gathered.irradiance, gathered.glossyRadiance);
    };
    EXPECT_EQ(run(1), run(5));
}

TEST(Gloss, RefusesWhatIsWrong) {
    const VplCase c(lampOverFloor());
    const auto trace = [&](const std::vector<PhongLobe>& gloss) { return c.trace({.particles = 10, .gloss = gloss}); };
    EXPECT_THROW(trace({{Rgb(0.1F), 1.0F}}), UsageError);                  // one of two materials
    EXPECT_THROW(trace({{}, {Rgb(1.1F), 1.0F}}), UsageError);              // more than arrives
    EXPECT_THROW(trace({{}, {Rgb(0.1F, -0.1F, 0.1F), 1.0F}}), UsageError); // less than nothing
    EXPECT_THROW(trace({{}, {Rgb(0.1F), -1.0F}}), UsageError);             // no density
    EXPECT_THROW(trace({{}, {Rgb(0.1F), std::nanf("")}}), UsageError);
    EXPECT_NO_THROW(trace({{}, {Rgb(1.0F), 1e6F}}));
    Receiver glossy = c.receiver(1, 0.5F, 0.5F);
    EXPECT_THROW(c.gather(std::array{lobeLight({0, 0, 1}, 1.0F)}, std::array{glossy}, {.recoveryRays = 4}), UsageError);
    glossy.gloss.lobe.reflectance = Rgb(0.1F);
    EXPECT_THROW(c.gather({}, std::array{glossy}, {.recoveryRays = 4}), UsageError);
}

} // namespace
} // namespace lambert
