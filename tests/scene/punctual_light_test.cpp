#include "core/random.h"
#include "scene/example_scenes.h"
#include "scene/polygon_points.h"
#include "scene/punctual_light.h"
#include "scene/rays/ray_caster.h"

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

namespace lambert {
namespace {

PunctualLight spot(float inner, float outer) {
    PunctualLight light;
    light.kind = PunctualLight::Kind::Spot;
    light.direction = glm::normalize(glm::vec3(1.0F, -2.0F, 0.5F));
    light.intensity = Rgb(2.0F, 1.0F, 0.5F);
    light.innerConeAngle = inner;
    light.outerConeAngle = outer;
    return light;
}

/// ∫ I dω by the midpoint rule over the cosine to the axis.
double integratedFlux(const PunctualLight& light) {
    constexpr int kSteps = 200000;
    const glm::dvec3 axis(light.direction);
    const glm::dvec3 across = glm::normalize(glm::cross(axis, glm::dvec3(0.0, 0.0, 1.0)));
    double sum = 0.0;
    for (int i = 0; i < kSteps; ++i) {
        const double cosine = (i + 0.5) / kSteps;
        const glm::dvec3 direction = cosine * axis + std::sqrt(1.0 - cosine * cosine) * across;
        sum += static_cast<double>(intensityToward(light, glm::vec3(direction)).x) / kSteps;
    }
    return 2.0 * std::numbers::pi * sum;
}

// The directions are rounded to float, 6e-8 of the narrowest falloff's width of 1e-3.
TEST(PunctualLight, TotalFluxIsTheIntegralOfItsIntensity) {
    for (const auto& [inner, outer] : std::vector<std::pair<float, float>>{
             {0.0F, 0.785F}, {0.3F, 0.5F}, {0.5F, 0.5F}, {1.2F, 1.5707963F}, {0.1F, 0.11F}}) {
        const PunctualLight light = spot(inner, outer);
        EXPECT_NEAR(totalFlux(light).x, integratedFlux(light), 1e-3 * totalFlux(light).x) << inner << " " << outer;
        EXPECT_NEAR(totalFlux(light).z, 0.25 * totalFlux(light).x, 1e-6 * totalFlux(light).x);
    }
    PunctualLight point;
    EXPECT_NEAR(totalFlux(point).x, 4.0 * std::numbers::pi, 1e-12);
}

// χ² of 10^5 sampled cosines against the integrated falloff in 16 equal steps from the rim to the axis: 99.99 % of χ²(15)
// lie below 44.3; four lights: odds of 1 in 2500.
TEST(PunctualLight, SampledDirectionsFollowTheIntensity) {
    constexpr std::uint64_t kSeed = 5;
    constexpr int kCells = 16, kSamples = 100000, kSteps = 4000;
    for (const auto& [inner, outer] :
         std::vector<std::pair<float, float>>{{0.0F, 0.785F}, {0.3F, 0.5F}, {0.5F, 0.5F}, {1.2F, 1.57F}}) {
        const PunctualLight light = spot(inner, outer);
        const glm::dvec3 axis(light.direction);
        const double rim = std::cos(static_cast<double>(outer));
        const glm::dvec3 across = glm::normalize(glm::cross(axis, glm::dvec3(0.0, 0.0, 1.0)));
        std::vector<double> expected(kCells, 0.0), counts(kCells, 0.0);
        double total = 0.0;
        for (int i = 0; i < kCells * kSteps; ++i) {
            const double cosine = rim + (1.0 - rim) * (i + 0.5) / (kCells * kSteps);
            const glm::dvec3 direction = cosine * axis + std::sqrt(1.0 - cosine * cosine) * across;
            const auto value = static_cast<double>(intensityToward(light, glm::vec3(direction)).x);
            expected[static_cast<std::size_t>(i / kSteps)] += value;
            total += value;
        }
        glm::dvec3 mean(0.0);
        for (std::uint32_t i = 0; i < kSamples; ++i) {
            const auto bits = philox({i, 0, 0, 0}, kSeed);
            const glm::dvec3 d = sampleDirection(light, 0x1p-32 * glm::dvec2(bits[0], bits[1]));
            ASSERT_NEAR(glm::length(d), 1.0, 1e-12);
            const double cell = kCells * (glm::dot(d, axis) - rim) / (1.0 - rim);
            ++counts[static_cast<std::size_t>(std::clamp(cell, 0.0, kCells - 1.0))];
            mean += d / static_cast<double>(kSamples);
        }
        double chiSquared = 0.0;
        for (std::size_t k = 0; k < kCells; ++k) {
            const double e = kSamples * expected[k] / total;
            chiSquared += (counts[k] - e) * (counts[k] - e) / e;
        }
        EXPECT_LT(chiSquared, 44.3) << inner << " " << outer << ", seed " << kSeed;
        // Even about the axis: four standard deviations of at most 1 / √(2 · 10^5).
        EXPECT_LT(glm::length(glm::cross(mean, axis)), 4.0 * 1.5 / std::sqrt(2.0 * kSamples));
    }
}

// A trapezoid's centroid, its triangles (0, 1, 3) and (2, 3, 1) being of different size; 10^5 random points, a standard
// deviation of 0.7 and 0.3 each: four of them.
TEST(PolygonPoints, AreUniformOnAQuad) {
    const std::array<glm::vec3, 4> trapezoid{{{0, 0, 0}, {4, 0, 0}, {2, 1, 0}, {0, 1, 0}}};
    const Scene scene = quadScene(std::vector{trapezoid}, std::array{greyMaterial("grey", 0.5F)});
    const PolygonPoints points(scene, scene.polygons[0]);
    glm::dvec3 mean(0.0);
    for (std::uint32_t i = 0; i < 100000; ++i) {
        const auto bits = philox({i, 0, 0, 0}, 9);
        const glm::vec2 chart = points.chartAt(0x1p-32 * glm::dvec2(bits[0], bits[1]));
        const glm::vec3 p = polygonPoint(scene, 0, chart.x, chart.y);
        EXPECT_LE(p.x, 4.0F - 2.0F * p.y + 1e-5F);
        mean += 1e-5 * glm::dvec3(p);
    }
    EXPECT_NEAR(mean.x, (2.0 * 2.0 + 2.0 / 3.0) / 3.0, 4 * 1.0 / std::sqrt(1e5));
    EXPECT_NEAR(mean.y, (2.0 / 3.0 + 2.0 / 3.0) / 3.0, 4 * 0.3 / std::sqrt(1e5));
}

} // namespace
} // namespace lambert
