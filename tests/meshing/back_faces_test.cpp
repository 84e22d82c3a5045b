#include "meshing/back_faces.h"

#include "meshing/prepare.h"
#include "sample_scenes.h"
#include "scene/example_scenes.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace lambert {
namespace {

/// Two parallel unit squares, a distance of 1 apart: the lamp faces the other, which faces it or turns its back.
Scene parallelSquares(bool turned) {
    const std::array quads{std::array{glm::vec3(0, 0, 0), glm::vec3(1, 0, 0), glm::vec3(1, 1, 0), glm::vec3(0, 1, 0)},
                           std::array{glm::vec3(0, 1, 1), glm::vec3(1, 1, 1), glm::vec3(1, 0, 1), glm::vec3(0, 0, 1)}};
    Scene scene = quadScene(quads, std::array{greyMaterial("lamp", 0.0F, 1.0F), greyMaterial("panel", 0.5F)});
    auto& vertices = scene.polygons[1].vertices;
    if (turned) std::reverse(vertices.begin(), vertices.end());
    return prepareScene(scene);
}

// Of parallel unit squares at distance 1: J. Howell's catalogue, C-11.
constexpr double kFormFactor = 0.199825;
// 65,536 stratified rays: the standard error of a mean of 0.2 would be 0.0016 without strata.
constexpr double kTolerance = 0.005;

TEST(BackFaces, NoneAreMetAmongFronts) {
    const Scene scene = parallelSquares(false);
    const RayCaster rays(scene);
    EXPECT_EQ(sampleBackFaces(rays).fraction, 0.0);
    EXPECT_EQ(sampleBackFaces(rays).mostMet(), kNone);
    EXPECT_EQ(sampleBackFacesFromLights(rays).fraction, 0.0);
}

TEST(BackFaces, FractionIsTheFormFactorToATurnedSquare) {
    const Scene scene = parallelSquares(true);
    const RayCaster rays(scene);
    const BackFaceSample lights = sampleBackFacesFromLights(rays);
    EXPECT_NEAR(lights.fraction, kFormFactor, kTolerance);
    EXPECT_EQ(lights.mostMet(), 1U);
    EXPECT_NEAR(lights.byMaterial[1], lights.fraction, 1e-12);
    // The panel's own rays, half of all, meet nothing.
    EXPECT_NEAR(sampleBackFaces(rays).fraction, 0.5 * kFormFactor, kTolerance);
}

TEST(BackFaces, OccludersAndSecondSidesAreNone) {
    Scene scene = parallelSquares(true);
    scene.materials[1].occluder = true;
    EXPECT_EQ(sampleBackFacesFromLights(RayCaster(scene)).fraction, 0.0);
    scene.materials[1].occluder = false;
    scene.polygons[1].backMaterial = 1;
    EXPECT_EQ(sampleBackFacesFromLights(RayCaster(scene)).fraction, 0.0);
}

TEST(BackFaces, InsidesOfClosedObjectsDoNotCount) {
    // The base of a box is missing: its part of the floor sees nothing but backs.
    const Scene scene = roomWithTurnedBox();
    EXPECT_LT(sampleBackFaces(RayCaster(scene)).fraction, 1e-3);
}

TEST(BackFaces, SceneWithoutLightHasNoneFromLights) {
    const Scene scene = roomWithTurnedBox();
    EXPECT_EQ(sampleBackFacesFromLights(RayCaster(scene)).fraction, 0.0);
}

} // namespace
} // namespace lambert
