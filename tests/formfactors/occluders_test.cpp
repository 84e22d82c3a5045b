#include "formfactors/occluders.h"

#include "meshing/prepare.h"
#include "tests/scene/grid_scene.h"

#include <gtest/gtest.h>

namespace lambert {
namespace {

// Rounding turns the small quads by more than the tolerance; the whole walls it does not.
TEST(Occluders, WallsOfManyQuadsBecomeOnePolygonEach) {
    for (const GridScene::Map& map : {GridScene::Map(same), GridScene::Map(turned)}) {
        for (const int n : {1, 5, 24}) {
            const Scene scene = prepareScene(GridScene()
                                                 .box({0, 0, 0}, {1, 1, 1}, n, true, map)
                                                 .box({0.35, 0.3, 0.4}, {0.65, 0.6, 0.7}, n, false, map)
                                                 .scene());
            Directions directions;
            const Occluders occluders =
                gatherOccluders(scene, directions, 2.0 * static_cast<double>(weldTolerance(scene)));
            ASSERT_EQ(occluders.list.size(), 12U) << n;
            EXPECT_EQ(directions.list().size(), 3U);
            int solid = 0;
            for (const Occluder& o : occluders.list) {
                EXPECT_EQ(o.corners.size(), 4U);
                solid += o.solid ? 1 : 0;
            }
            EXPECT_EQ(solid, 6); // the box; a room is not closed to the outside
            ASSERT_EQ(occluders.ofPolygon.size(), scene.polygons.size());
            for (std::size_t p = 0; p < scene.polygons.size(); ++p) {
                const Plane& plane = occluders.list[occluders.ofPolygon[p]].plane;
                for (int k = 0; k < 4; ++k)
                    EXPECT_NEAR(plane.height(glm::dvec3(corner(scene, scene.polygons[p], k))), 0.0, 4e-6);
            }
        }
    }
}

TEST(Occluders, WhatWouldNotBeConvexStaysApart) {
    // An L of three squares.
    const std::array<std::array<glm::vec3, 4>, 3> quads{{{{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}},
                                                         {{{1, 0, 0}, {2, 0, 0}, {2, 1, 0}, {1, 1, 0}}},
                                                         {{{0, 1, 0}, {1, 1, 0}, {1, 2, 0}, {0, 2, 0}}}}};
    const std::array<Material, 3> materials{greyMaterial("a", 0.5F), greyMaterial("b", 0.5F), greyMaterial("c", 0.5F)};
    const Scene scene = prepareScene(quadScene(quads, materials));
    Directions directions;
    EXPECT_EQ(gatherOccluders(scene, directions, 1e-6).list.size(), 2U);
}

} // namespace
} // namespace lambert
