#include "baking/exposure.h"
#include "picture/srgb.h"

#include <glm/ext/scalar_constants.hpp>
#include <gtest/gtest.h>

#include <cmath>

namespace lambert {
namespace {

/// A row of quads of the given widths, each with one shown radiance, of a material that does not emit.
BakedMesh strip(const std::vector<std::pair<float, float>>& widthsAndValues) {
    BakedMesh mesh;
    mesh.materials.resize(1);
    float x = 0.0F;
    for (const auto& [width, value] : widthsAndValues) {
        const auto first = static_cast<std::uint32_t>(mesh.positions.size());
        for (const glm::vec3& p :
             {glm::vec3(x, 0, 0), glm::vec3(x + width, 0, 0), glm::vec3(x + width, 1, 0), glm::vec3(x, 1, 0)}) {
            mesh.positions.push_back(p);
            mesh.normals.emplace_back(0.0F, 0.0F, 1.0F);
            mesh.radiosity.push_back(Rgb(0.5F, 1.0F, 0.25F) * value * glm::pi<float>());
            mesh.irradiance.push_back(Rgb(value) * 4.0F * glm::pi<float>());
        }
        mesh.faces.push_back({first, first + 1, first + 2, first + 3});
        mesh.faceMaterials.push_back(0);
        mesh.emitters.push_back(false);
        x += width;
    }
    return mesh;
}

float shownAt(const BakedMesh& mesh, float value, Quantity quantity = Quantity::Radiosity) {
    return value * std::exp2(automaticExposure(mesh, quantity));
}

constexpr float kRounding = 1e-5F; // a few units in the last place of a float EV

TEST(AutomaticExposure, MakesPercentileNinetyPercentOfDisplay) {
    EXPECT_NEAR(shownAt(strip({{50.0F, 1.0F}, {48.5F, 2.0F}, {1.0F, 5.0F}, {0.5F, 80.0F}}), 5.0F), 0.9F, kRounding);
    EXPECT_NEAR(shownAt(strip({{1.0F, 3e-8F}}), 3e-8F), 0.9F, kRounding);
    EXPECT_NEAR(shownAt(strip({{1.0F, 3e8F}}), 3e8F), 0.9F, kRounding * 10.0F);
}

TEST(AutomaticExposure, WeighsByAreaNotByCount) {
    const BakedMesh mesh = strip({{1e-3F, 9.0F}, {1e-3F, 9.0F}, {1e-3F, 9.0F}, {1.0F, 2.0F}});
    EXPECT_NEAR(shownAt(mesh, 2.0F), 0.9F, kRounding);
}

TEST(AutomaticExposure, FollowsTheQuantity) {
    EXPECT_NEAR(shownAt(strip({{1.0F, 1.0F}}), 4.0F, Quantity::Irradiance), 0.9F, kRounding);
}

TEST(AutomaticExposure, TakesDimLightForLightButNotThatOfStrayRays) {
    EXPECT_NEAR(shownAt(strip({{1.0F, 1.0F}, {1000.0F, 1e-6F}}), 1e-6F), 0.9F, kRounding);
    EXPECT_NEAR(shownAt(strip({{1.0F, 1.0F}, {1000.0F, 1e-8F}}), 1.0F), 0.9F, kRounding);
}

TEST(AutomaticExposure, LeavesEmittersOutUnlessEverythingEmits) {
    BakedMesh mesh = strip({{1.0F, 1.0F}, {1.0F, 100.0F}});
    mesh.emitters[1] = true;
    EXPECT_NEAR(shownAt(mesh, 1.0F), 0.9F, kRounding);
    mesh.emitters[0] = true;
    EXPECT_NEAR(shownAt(mesh, 100.0F), 0.9F, kRounding);
}

TEST(AutomaticExposure, OfAlmostDarkSceneIsThatOfItsLitPart) {
    EXPECT_NEAR(shownAt(strip({{1000.0F, 0.0F}, {1.0F, 3.0F}}), 3.0F), 0.9F, kRounding);
}

TEST(AutomaticExposure, OfBlackOrEmptySceneIsZero) {
    EXPECT_EQ(automaticExposure(strip({{1.0F, 0.0F}}), Quantity::Radiosity), 0.0F);
    EXPECT_EQ(automaticExposure(BakedMesh{}, Quantity::Radiosity), 0.0F);
}

TEST(DisplayColour, IsExposedAndClamped) {
    EXPECT_EQ(displayColour(Rgb(0.0625F, 0.25F, 3.0F), 1.0F), Rgb(0.125F, 0.5F, 1.0F));
    EXPECT_EQ(displayColour(Rgb(0.0F, 1.0F, 1e-30F), 1000.0F), Rgb(0.0F, 1.0F, 1.0F));
    EXPECT_EQ(displayColour(Rgb(3e38F), -1000.0F), Rgb(0.0F));
    EXPECT_EQ(displayColour(Rgb(-2e-5F, -3e38F, 0.5F), 0.0F), Rgb(0.0F, 0.0F, 0.5F)); // noise of stochastic solvers
}

TEST(SrgbCurve, HasItsKnownValues) {
    EXPECT_EQ(srgbEncode(0.0F), 0.0F);
    EXPECT_EQ(srgbEncode(-2e-5F), 0.0F);
    EXPECT_NEAR(srgbEncode(1.0F), 1.0F, 1e-6F);
    EXPECT_NEAR(srgbEncode(0.002F), 0.02584F, 1e-6F);                   // linear part: 12.92 x
    EXPECT_NEAR(srgbEncode(0.2140411F), 0.5F, 1e-6F);                   // middle of the display scale
    EXPECT_NEAR(srgbEncode(0.18F), 0.4613561F, 1e-6F);                  // 1.055 · 0.18^(1/2.4) − 0.055
    EXPECT_NEAR(srgbEncode(0.0031308F), srgbEncode(0.0031309F), 1e-5F); // its two parts meet
}

} // namespace
} // namespace lambert
