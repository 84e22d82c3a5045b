// E_0 against closed forms. Where nothing is said, tolerances are 0.2 %, which the default points and rays must keep.
#include "core/error.h"
#include "core/parallel.h"
#include "meshing/build_patch_mesh.h"
#include "meshing/prepare.h"
#include "scene/environment.h"
#include "scene/example_scenes.h"
#include "scene/sky.h"
#include "solver/direct_light.h"

#include <gtest/gtest.h>

#include <glm/geometric.hpp>
#include <glm/gtc/constants.hpp>

#include <array>
#include <cmath>
#include <numbers>

namespace lambert {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kTolerance = 2e-3;

using Quad = std::array<glm::vec3, 4>;

/// Level, its front up.
Quad levelQuad(const glm::vec3& centre, float halfSize) {
    const float h = halfSize;
    return {centre + glm::vec3(-h, 0, h), centre + glm::vec3(h, 0, h), centre + glm::vec3(h, 0, -h),
            centre + glm::vec3(-h, 0, -h)};
}

Quad turned(const Quad& quad) { return {quad[3], quad[2], quad[1], quad[0]}; }

/// The first quad in about `patches` patches, under whatever stands above it. A quad of black has no say here.
struct Ground {
    explicit Ground(std::vector<Quad> quads, std::size_t patches = 400)
        : scene(prepareScene(quadScene(quads, std::vector<Material>(quads.size(), greyMaterial("grey", 0.5F))))),
          rays(scene) {
        MeshOptions options;
        options.patches = patches;
        mesh = buildPatchMesh(scene, options, progress);
    }

    std::vector<RgbSum> light(const LightSources& sources, const DirectLightOptions& options = {}) {
        return DirectLight(rays, options).irradiance(mesh, sources, progress);
    }

    /// Σ A E_0 over the patches of the first quad, first channel.
    double flux(const std::vector<RgbSum>& irradiance) const {
        double sum = 0.0;
        for (std::size_t i = 0; i < mesh.size(); ++i)
            if (mesh.polygon[i] == 0) sum += static_cast<double>(mesh.area[i]) * irradiance[i].x;
        return sum;
    }

    Progress progress;
    Scene scene;
    RayCaster rays;
    PatchMesh mesh;
};

/// A. Van Oosterom, J. Strackee, "The solid angle of a plane triangle", 1983.
double solidAngle(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {
    const double la = glm::length(a), lb = glm::length(b), lc = glm::length(c);
    const double below = la * lb * lc + glm::dot(a, b) * lc + glm::dot(a, c) * lb + glm::dot(b, c) * la;
    return 2.0 * std::atan2(std::abs(glm::dot(a, glm::cross(b, c))), below);
}

TEST(DirectLight, PointLightSendsEachPatchItsSolidAngle) {
    Ground ground({levelQuad({0, 0, 0}, 1.0F)});
    const std::array lights{
        PunctualLight{.name = "bulb", .position = {0.3F, 0.8F, -0.1F}, .intensity = {100.0F, 50.0F, 0.0F}}};
    const auto found = ground.light({lights});
    for (std::size_t i = 0; i < ground.mesh.size(); ++i) {
        const auto at = [&](int k) { return glm::dvec3(ground.mesh.position(i, k)) - glm::dvec3(lights[0].position); };
        double angle = solidAngle(at(0), at(1), at(2));
        if (ground.mesh.isQuad(i)) angle += solidAngle(at(0), at(2), at(3));
        const double expected = 100.0 * angle / static_cast<double>(ground.mesh.area[i]);
        EXPECT_NEAR(found[i].x, expected, kTolerance * expected);
        EXPECT_NEAR(found[i].y, 0.5 * found[i].x, 1e-9 * found[i].x); // the same rays
        EXPECT_EQ(found[i].z, 0.0);
    }
}

TEST(DirectLight, SpotSendsTheIntegralOfItsCone) {
    Ground ground({levelQuad({0, 0, 0}, 2.0F)}, 2000);
    PunctualLight spot{.name = "spot",
                       .kind = PunctualLight::Kind::Spot,
                       .position = {0, 1, 0},
                       .direction = {0, -1, 0},
                       .intensity = Rgb(10.0F),
                       .innerConeAngle = 0.4F,
                       .outerConeAngle = 0.9F};
    const double inner = std::cos(0.4), outer = std::cos(0.9);
    // ∫ ((c − outer)/(inner − outer))² dc from outer to inner is a third of the interval.
    const double expected = 2.0 * kPi * 10.0 * ((1.0 - inner) + (inner - outer) / 3.0);
    EXPECT_NEAR(ground.flux(ground.light({{&spot, 1}})), expected, kTolerance * expected);
    spot.direction = {0, 1, 0};
    EXPECT_EQ(ground.flux(ground.light({{&spot, 1}})), 0.0);
}

TEST(DirectLight, SunIsCosineAndALevelBlockerTakesItsOwnArea) {
    const PunctualLight sun{.name = "sun",
                            .kind = PunctualLight::Kind::Directional,
                            .direction = glm::normalize(glm::vec3(0.2F, -0.8F, -0.3F)),
                            .intensity = Rgb(100.0F)};
    const double across = 100.0 * static_cast<double>(-sun.direction.y);
    Ground open({levelQuad({0, 0, 0}, 2.0F)});
    for (const RgbSum& e : open.light({{&sun, 1}})) EXPECT_NEAR(e.x, across, 1e-5 * across); // single precision
    // Turned down, so that it casts a shadow by its back.
    Ground shaded({levelQuad({0, 0, 0}, 2.0F), levelQuad({0.1F, 0.5F, 0.2F}, 0.7F)}, 1000);
    const double expected = across * (16.0 - 1.4 * 1.4);
    EXPECT_NEAR(shaded.flux(shaded.light({{&sun, 1}})), expected, kTolerance * expected);
}

TEST(DirectLight, OnlyFrontsAreLit) {
    Ground ground({turned(levelQuad({0, 0, 0}, 1.0F))});
    const std::array lights{
        PunctualLight{.name = "bulb", .position = {0, 1, 0}},
        PunctualLight{.name = "sun", .kind = PunctualLight::Kind::Directional, .direction = {0, -1, 0}}};
    EXPECT_EQ(ground.flux(ground.light({lights})), 0.0);
    const Environment sky = overcastSky(1000.0);
    EXPECT_EQ(ground.flux(ground.light({{}, &sky})), 0.0);
}

TEST(DirectLight, LightInACeilingsPlaneIsNotBehindIt) {
    Ground ground({levelQuad({0, 0, 0}, 1.0F), turned(levelQuad({0, 1, 0}, 1.0F))});
    const PunctualLight bulb{.name = "bulb", .position = {0, 1, 0}};
    const double expected = 4.0 * kPi / 6.0; // a cube's face from its centre has a sixth; here twice as wide as far
    const auto found = ground.light({{&bulb, 1}});
    EXPECT_NEAR(ground.flux(found), expected, kTolerance * expected);
    for (std::size_t i = 0; i < ground.mesh.size(); ++i) {
        if (ground.mesh.polygon[i] == 1) {
            EXPECT_EQ(found[i], RgbSum(0.0));
        }
    }
}

TEST(DirectLight, UniformSkyIsPiLOnOpenGround) {
    Ground ground({levelQuad({0, 0, 0}, 1.0F)});
    const Environment sky = Environment::constant({1.0F, 2.0F, 3.0F});
    for (const RgbSum& e : ground.light({{}, &sky}))
        for (int c = 0; c < 3; ++c) EXPECT_NEAR(e[c], (c + 1) * kPi, 1e-6 * kPi); // every ray is worth the same
}

TEST(DirectLight, AWallTakesHalfOfTheSkyAtItsFoot) {
    // 1 mm before a wall 100 m wide and high: 1 − 1e-5 of the half.
    const Quad wall{{{-50, 0, 0}, {50, 0, 0}, {50, 100, 0}, {-50, 100, 0}}};
    Ground ground({levelQuad({0, 0, 0.5F}, 0.2F), wall}, 2);
    const DirectLight light(ground.rays, {.skyRays = 16384});
    for (const Environment& sky : {Environment::constant(Rgb(1.0F)), overcastSky(kPi)}) {
        const double expected = kPi / 2.0;
        for (std::uint32_t index = 0; index < 20; ++index)
            EXPECT_NEAR(light.irradiance({0, 0, 1e-3F}, {0, 1, 0}, index, {{}, &sky}).x, expected,
                        kTolerance * expected);
    }
}

TEST(DirectLight, OvercastAndClearSkiesGiveTheirIlluminance) {
    Ground ground({levelQuad({0, 0, 0}, 1.0F)});
    const Environment overcast = overcastSky(7.0 * kPi / 9.0); // zenith luminance 1
    const Environment clear = clearSky(135.0, 35.0);
    const double clearExpected = clearSkyIlluminance(35.0);
    for (const RgbSum& e : ground.light({{}, &overcast}))
        EXPECT_NEAR(e.x, 7.0 * kPi / 9.0, kTolerance * 7.0 * kPi / 9.0);
    for (const RgbSum& e : ground.light({{}, &clear})) EXPECT_NEAR(e.x, clearExpected, kTolerance * clearExpected);
}

TEST(DirectLight, OneBrightTexelIsItsSolidAngleTimesCosine) {
    constexpr int kColumns = 64, kRows = 32, kColumn = 50, kRow = 9;
    std::vector<glm::vec4> texels(kColumns * kRows, glm::vec4(0.0F));
    texels[kRow * kColumns + kColumn] = glm::vec4(1000.0F, 0.0F, 0.0F, 1.0F);
    const Environment sky = Environment::image(std::make_shared<Texture>("sky", kColumns, kRows, std::move(texels)));
    const double from = kPi * (0.5 - static_cast<double>(kRow) / kRows); // elevations
    const double to = kPi * (0.5 - static_cast<double>(kRow + 1) / kRows);
    const double width = 2.0 * kPi / kColumns;

    // The cosine-distributed half hits the texel rarely, and each hit counts as much as one of the other half: of 2 × 8192 rays
    // 12 ± 3.5 do, which leaves 0.04 %. (Of 2 × 2048 it would be 0.08 %.)
    const DirectLightOptions options{.skyRays = 16384};
    Ground ground({levelQuad({0, 0, 0}, 1.0F)}, 50);
    const double level = 1000.0 * width * (std::pow(std::sin(from), 2) - std::pow(std::sin(to), 2)) / 2.0;
    for (const RgbSum& e : ground.light({{}, &sky}, options)) EXPECT_NEAR(e.x, level, kTolerance * level);

    // On a wall that faces east: ∫ cos² elevation × ∫ sin azimuth.
    const auto half = [](double angle) { return angle / 2.0 + std::sin(2.0 * angle) / 4.0; };
    const double azimuth = 2.0 * kPi * (static_cast<double>(kColumn) / kColumns - 0.5);
    const double upright = 1000.0 * (half(from) - half(to)) * (std::cos(azimuth) - std::cos(azimuth + width));
    Ground wall({Quad{{{0, 0, 1}, {0, 0, -1}, {0, 1, -1}, {0, 1, 1}}}}, 50);
    ASSERT_EQ(wall.mesh.normal[0], glm::vec3(1, 0, 0));
    for (const RgbSum& e : wall.light({{}, &sky}, options)) EXPECT_NEAR(e.x, upright, kTolerance * upright);
}

TEST(DirectLight, BothSetsOfSkyRaysTogetherAreUnbiasedUnderABlocker) {
    std::vector<glm::vec4> texels;
    for (int k = 0; k < 16 * 8; ++k)
        texels.emplace_back(1.0F + 40.0F * static_cast<float>(k % 37 == 5), 0.3F, 2.0F, 1.0F);
    const Environment sky = Environment::image(std::make_shared<Texture>("sky", 16, 8, std::move(texels)));
    Ground ground({levelQuad({0, 0, 0}, 0.5F), levelQuad({0.2F, 0.4F, -0.3F}, 0.5F)}, 1);
    const auto at = [&](std::uint32_t rays, std::uint64_t seed) {
        return ground.flux(ground.light({{}, &sky}, {.skyRays = rays, .seed = seed}));
    };
    double reference = 0.0, sum = 0.0, squares = 0.0;
    for (std::uint64_t seed = 0; seed < 4; ++seed) reference += at(1U << 19, 1000 + seed) / 4.0;
    constexpr int kRuns = 1600;
    for (int k = 0; k < kRuns; ++k) {
        const double value = at(16, static_cast<std::uint64_t>(k));
        sum += value;
        squares += value * value;
    }
    const double mean = sum / kRuns;
    const double deviation = std::sqrt((squares / kRuns - mean * mean) / kRuns);
    EXPECT_NEAR(mean, reference, 4.0 * deviation); // 1 in 16000; seeds 0 to 1599
    EXPECT_LT(deviation, 0.02 * reference);        // or the test would say little
}

TEST(DirectLight, IsTheSameOnAnyNumberOfThreads) {
    Ground ground({levelQuad({0, 0, 0}, 1.0F), levelQuad({0.2F, 0.4F, -0.3F}, 0.5F)}, 300);
    const Environment sky = clearSky(135.0, 35.0);
    const PunctualLight bulb{.name = "bulb", .position = {0.3F, 0.8F, 0.9F}};
    const LightSources sources{{&bulb, 1}, &sky};
    setThreadCount(1);
    const auto one = ground.light(sources);
    setThreadCount(4);
    const auto four = ground.light(sources);
    setThreadCount(0);
    EXPECT_EQ(one, four);
}

TEST(DirectLight, RefusesCountsOutOfRange) {
    Ground ground({levelQuad({0, 0, 0}, 1.0F)}, 1);
    EXPECT_THROW(DirectLight(ground.rays, {.points = 0}), UsageError);
    EXPECT_THROW(DirectLight(ground.rays, {.skyRays = 1}), UsageError);
}

} // namespace
} // namespace lambert
