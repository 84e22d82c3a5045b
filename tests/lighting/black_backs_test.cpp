#include "lighting/solve_scene.h"
#include "scene/example_scenes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>

namespace lambert {
namespace {

using Quad = std::array<glm::vec3, 4>;

SolvedScene bake(const Scene& scene, std::size_t patches, bool splitContacts = true) {
    SolveOptions options;
    auto& light = std::get<FormFactorLight>(options.method);
    options.mesh.patches = patches;
    options.mesh.splitContacts = splitContacts;
    light.formFactors.transport.method = TransportMethod::Hemicube;
    light.formFactors.transport.resolution = 32;
    Progress progress;
    return solveScene(scene, options, progress);
}

/// Level, its front up or down.
Quad level(float low, float high, float z, bool up) {
    if (up) return {{{low, low, z}, {high, low, z}, {high, high, z}, {low, high, z}}};
    return {{{low, low, z}, {low, high, z}, {high, high, z}, {high, low, z}}};
}

/// A wide ground, a plate above it, and close above that a small lamp that shines down: on the plate's front, or on its back.
Scene lampOverPlate(bool frontUp) {
    const std::array quads{level(-10, 10, 0, true), level(-1, 1, 1, frontUp), level(-0.2F, 0.2F, 1.1F, false)};
    return quadScene(
        quads, std::array{greyMaterial("ground", 0.5F), greyMaterial("plate", 0.5F), greyMaterial("lamp", 0.5F, 1.0F)});
}

TEST(BlackBacks, TakeNothingOfALampThatShinesOnFronts) {
    const SolvedScene baked = bake(lampOverPlate(true), 200);
    EXPECT_LT(baked.blackBacks.light, 0.01); // the ground's rays meet the plate's back, but there is hardly any light
    EXPECT_EQ(baked.blackBacks.emission, 0.0);
}

TEST(BlackBacks, AreToldOfByTheLightThatFewRaysCarry) {
    const SolvedScene baked = bake(lampOverPlate(false), 200);
    // The plate reaches eight times as far beyond the lamp as that is above it: 1 − 1 / (1 + 8²) of its light.
    EXPECT_GT(baked.blackBacks.emission, 0.95);
    EXPECT_GT(baked.blackBacks.light, 0.95);
    EXPECT_LT(baked.blackBacks.rays, 0.01); // the lamp is 1/2500 of the area
    EXPECT_EQ(baked.blackBacks.material, "plate");
    ASSERT_EQ(baked.warnings.size(), 1U);
    EXPECT_NE(baked.warnings[0].find("of what the lights give off"), std::string::npos) << baked.warnings[0];
    EXPECT_NE(baked.warnings[0].find("\"plate\""), std::string::npos) << baked.warnings[0];
}

TEST(BlackBacks, TakeOfAShiningGroundWhatItsRaysMeet) {
    Scene scene = lampOverPlate(true);
    std::reverse(scene.polygons[2].vertices.begin(), scene.polygons[2].vertices.end()); // it sees only the sky
    scene.materials[0] = greyMaterial("ground", 0.0F, 1.0F);
    const SolvedScene baked = bake(scene, 200);
    EXPECT_GT(baked.blackBacks.rays, 1e-3);
    // The ground is 400 of 404 m², and gives 2500 times the light of the lamp.
    EXPECT_NEAR(baked.blackBacks.emission / baked.blackBacks.rays, 1.0, 0.02);
    EXPECT_NEAR(baked.blackBacks.light / baked.blackBacks.rays, 1.0, 0.02);
}

TEST(BlackBacks, OfOccludersAreMeant) {
    Scene scene = lampOverPlate(false);
    scene.materials[1].occluder = true;
    const SolvedScene baked = bake(scene, 200);
    EXPECT_EQ(baked.blackBacks.light, 0.0);
    EXPECT_EQ(baked.blackBacks.emission, 0.0);
    EXPECT_TRUE(baked.warnings.empty());
}

TEST(BlackBacks, OfWhatStandsOnAPatchAreHidden) {
    // Patches of the floor lie in part under the box, whose inside their rays meet from there.
    const SolvedScene baked = bake(roomWithBoxScene(), 60, false);
    double partly = 0.0;
    for (const float covered : baked.solution.covered) partly = std::max(partly, static_cast<double>(covered));
    EXPECT_GT(partly, 0.1);
    EXPECT_LT(baked.blackBacks.rays, 0.01);
    for (const std::string& warning : baked.warnings) EXPECT_EQ(warning.find("back"), std::string::npos) << warning;
}

} // namespace
} // namespace lambert
