#include "meshing/surface_check.h"

#include "meshing/prepare.h"
#include "sample_scenes.h"
#include "scene/example_scenes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace lambert {
namespace {

Scene unitBox() {
    Scene scene = emptyScene();
    addBox(scene, glm::vec3(0.0F), {1.0F, 2.0F, 3.0F}, true);
    return scene;
}

void turn(Polygon& polygon) { std::reverse(polygon.vertices.begin(), polygon.vertices.begin() + polygon.size()); }

Scene turnedInsideOut(Scene scene) {
    for (Polygon& polygon : scene.polygons) turn(polygon);
    return scene;
}

TEST(SurfaceCheck, ClosedBoxIsOneShellWithItsVolume) {
    for (const float size : {1e-3F, 1.0F, 1e3F}) {
        const SurfaceCheck check = checkSurfaces(prepareScene(scaled(turned(unitBox()), size)));
        ASSERT_EQ(check.shells.size(), 1U);
        EXPECT_TRUE(check.shells[0].isClosed());
        EXPECT_EQ(check.shells[0].polygons, 6U);
        EXPECT_EQ(check.closedShells, 1U);
        EXPECT_EQ(check.openEdges + check.branchedEdges + check.inconsistentEdges, 0U);
        // Of coordinates in single precision.
        EXPECT_NEAR(check.shells[0].volume / std::pow(static_cast<double>(size), 3.0), 6.0, 1e-4);
        EXPECT_NEAR(check.shells[0].area / std::pow(static_cast<double>(size), 2.0), 22.0, 1e-4);
    }
}

TEST(SurfaceCheck, RoomHasNegativeVolumeAndIsNotInsideOut) {
    const SurfaceCheck check = checkSurfaces(prepareScene(turnedInsideOut(unitBox())));
    ASSERT_EQ(check.shells.size(), 1U);
    EXPECT_NEAR(check.shells[0].volume, -6.0, 1e-5);
    EXPECT_EQ(check.insideOutShells, 0U);
}

TEST(SurfaceCheck, OpenBoxHasTheEdgesOfItsMissingFace) {
    Scene scene = unitBox();
    scene.polygons.pop_back();
    const SurfaceCheck check = checkSurfaces(prepareScene(scene));
    ASSERT_EQ(check.shells.size(), 1U);
    EXPECT_FALSE(check.shells[0].isClosed());
    EXPECT_EQ(check.openEdges, 4U);
    EXPECT_EQ(check.shells[0].volume, 0.0);
}

TEST(SurfaceCheck, SideDividedByANeighboursVerticesIsMatched) {
    // The box's top as two quads whose common edge ends within the sides of the others.
    Scene scene = unitBox();
    std::erase_if(scene.polygons, [&](const Polygon& p) { return areaVector(scene, p).z > 0.5F; });
    addPolygon(scene, std::array{glm::vec3(0, 0, 3), glm::vec3(1, 0, 3), glm::vec3(1, 0.7F, 3), glm::vec3(0, 0.7F, 3)});
    addPolygon(scene, std::array{glm::vec3(0, 0.7F, 3), glm::vec3(1, 0.7F, 3), glm::vec3(1, 2, 3), glm::vec3(0, 2, 3)});
    for (const Scene& variant : {scene, turned(scene)}) {
        const SurfaceCheck check = checkSurfaces(prepareScene(variant));
        ASSERT_EQ(check.shells.size(), 1U);
        EXPECT_TRUE(check.shells[0].isClosed());
        EXPECT_NEAR(check.shells[0].volume, 6.0, 1e-4);
    }
}

TEST(SurfaceCheck, TurnedFaceDisagreesWithItsFourNeighbours) {
    Scene scene = unitBox();
    turn(scene.polygons[2]);
    EXPECT_EQ(checkSurfaces(prepareScene(scene)).inconsistentEdges, 4U);
    // Then it does not matter:
    Scene occluder = scene;
    occluder.materials[0].occluder = true;
    EXPECT_EQ(checkSurfaces(prepareScene(occluder)).inconsistentEdges, 0U);
    scene.materials[0].twoSided = true;
    EXPECT_EQ(checkSurfaces(prepareScene(scene)).inconsistentEdges, 0U);
}

TEST(SurfaceCheck, ThreeFacesOfANodeOnAnEdgeAreNonManifold) {
    Scene scene = unitBox();
    addPolygon(scene, std::array{glm::vec3(0, 0, 0), glm::vec3(1, 0, 0), glm::vec3(1, -1, -1)});
    const SurfaceCheck check = checkSurfaces(prepareScene(scene));
    EXPECT_EQ(check.branchedEdges, 1U);
    EXPECT_EQ(check.openEdges, 2U);
    EXPECT_EQ(check.closedShells, 0U);
}

TEST(SurfaceCheck, BoxesOfTwoNodesThatShareAnEdgeAreTwoClosedShells) {
    Scene scene = unitBox();
    addBox(scene, {1.0F, 2.0F, 0.0F}, {2.0F, 3.0F, 3.0F}, true);
    const SurfaceCheck check = checkSurfaces(prepareScene(scene));
    EXPECT_EQ(check.shells.size(), 2U);
    EXPECT_EQ(check.closedShells, 2U);
}

TEST(SurfaceCheck, BoxWithItsFrontsInsideWithinARoomIsInsideOut) {
    Scene room = emptyScene();
    addBox(room, glm::vec3(0.0F), glm::vec3(4.0F), true);
    room = turnedInsideOut(room);
    Scene good = room;
    addBox(good, glm::vec3(1.0F), glm::vec3(2.0F), true);
    EXPECT_EQ(checkSurfaces(prepareScene(good)).insideOutShells, 0U);

    Scene bad = good;
    for (std::size_t i = room.polygons.size(); i < bad.polygons.size(); ++i) turn(bad.polygons[i]);
    const SurfaceCheck check = checkSurfaces(prepareScene(bad));
    EXPECT_EQ(check.insideOutShells, 1U);
    EXPECT_FALSE(check.shells[0].insideOut); // the room
    EXPECT_TRUE(check.shells[1].insideOut);

    for (Material& material : bad.materials) material.twoSided = true;
    EXPECT_EQ(checkSurfaces(prepareScene(bad)).insideOutShells, 0U);

    // A closet in a house is a room as well if something stands in it.
    Scene closet = bad;
    closet.materials[0].twoSided = false;
    addBox(closet, glm::vec3(1.25F), glm::vec3(1.75F), true);
    EXPECT_EQ(checkSurfaces(prepareScene(closet)).insideOutShells, 0U);
}

TEST(SurfaceCheck, SampleScenesAreClosedAsTheySay) {
    for (const SampleScene& sample : sampleScenes()) {
        const SurfaceCheck check = checkSurfaces(sample.scene);
        EXPECT_EQ(check.inconsistentEdges, 0U) << sample.name;
        EXPECT_EQ(check.insideOutShells, 0U) << sample.name;
        if (sample.closed) {
            EXPECT_EQ(check.openEdges, 0U) << sample.name;
        }
    }
}

} // namespace
} // namespace lambert
