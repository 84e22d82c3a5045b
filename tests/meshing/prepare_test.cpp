#include "meshing/prepare.h"
#include "scene/example_scenes.h"

#include "mesh_checks.h"
#include "meshing/plane_frame.h"
#include "sample_scenes.h"

#include <gtest/gtest.h>

namespace lambert {
namespace {

using Triangle = std::array<glm::vec3, 3>;

const Triangle kLowerHalf{{{0, 0, 0}, {2, 0, 0}, {2, 1, 0}}};
const Triangle kUpperHalf{{{0, 0, 0}, {2, 1, 0}, {0, 1, 0}}};

Scene halves(const Triangle& second = kUpperHalf) {
    Scene scene = emptyScene();
    addPolygon(scene, kLowerHalf);
    addPolygon(scene, second);
    return scene;
}

TEST(PrepareScene, MakesOneQuadOfTheHalvesOfARectangle) {
    PrepareReport report;
    const Scene prepared = prepareScene(halves(), {}, &report);
    ASSERT_EQ(prepared.polygons.size(), 1U);
    EXPECT_TRUE(prepared.polygons[0].isQuad());
    EXPECT_EQ(prepared.positions.size(), 4U);
    EXPECT_EQ(exactArea(prepared, prepared.polygons[0]), 2.0);
    EXPECT_GT(areaVector(prepared, prepared.polygons[0]).z, 0.0F);
    EXPECT_EQ(report.weldedVertices, 2U);
    EXPECT_EQ(report.joinedPairs, 1U);
    EXPECT_EQ(report.collapsedPolygons, 0U);
}

TEST(PrepareScene, KeepsTrianglesIfAsked) {
    PrepareReport report;
    EXPECT_EQ(prepareScene(halves(), {.keepPolygons = true}, &report).polygons.size(), 2U);
    EXPECT_EQ(report.joinedPairs, 0U);
}

TEST(PrepareScene, DoesNotJoinDifferentMaterials) {
    Scene scene = halves();
    scene.materials.push_back(scene.materials[0]);
    scene.polygons[1].material = 1;
    EXPECT_EQ(prepareScene(scene).polygons.size(), 2U);
}

TEST(PrepareScene, DoesNotJoinDifferentNodes) {
    Scene scene = halves();
    scene.nodes.emplace_back("other");
    scene.polygons[1].node = 1;
    EXPECT_EQ(prepareScene(scene).polygons.size(), 2U);
}

TEST(PrepareScene, DoesNotJoinNeighboursThatFaceOppositeSides) {
    EXPECT_EQ(prepareScene(halves({kUpperHalf[0], kUpperHalf[2], kUpperHalf[1]})).polygons.size(), 2U);
}

TEST(PrepareScene, DropsAndCountsASliverThatWeldingCollapses) {
    for (const float scale : {1e-6F, 1.0F, 1e6F}) {
        Scene scene = halves();
        addPolygon(scene, Triangle{{{0, 0, 0}, {1e-6F, 0, 0}, {0, 1, 0}}}); // the scene's diagonal is 2.2
        PrepareReport report;
        const Scene prepared = prepareScene(scaled(scene, scale), {}, &report);
        EXPECT_EQ(prepared.polygons.size(), 1U) << scale;
        EXPECT_EQ(report.collapsedPolygons, 1U) << scale;
        EXPECT_EQ(prepared.positions.size(), 4U) << "its vertices are gone";
    }
}

TEST(PrepareScene, KeepsSmallButSoundPolygonsAtEveryScale) {
    for (const float scale : {1e-8F, 1.0F, 1e8F}) {
        Scene scene = halves();
        addPolygon(scene, Triangle{{{5, 0, 0}, {5.001F, 0, 0}, {5, 0.001F, 0}}});
        EXPECT_EQ(prepareScene(scaled(scene, scale)).polygons.size(), 2U) << scale;
    }
}

TEST(PrepareScene, TurnsAQuadWithAVanishingEdgeIntoATriangle) {
    Scene scene = emptyScene();
    addPolygon(scene, std::array<glm::vec3, 4>{{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {1.0F, 1.0000005F, 0}}});
    const Scene prepared = prepareScene(scene);
    ASSERT_EQ(prepared.polygons.size(), 1U);
    EXPECT_FALSE(prepared.polygons[0].isQuad());
    EXPECT_NEAR(exactArea(prepared, prepared.polygons[0]), 0.5, 1e-6); // what welding moved
}

TEST(PrepareScene, KeepsTheOrderOfThePolygons) {
    Scene scene = emptyScene();
    for (int i = 0; i < 20; ++i) {
        scene.nodes.push_back("node " + std::to_string(i));
        const auto x = static_cast<float>(3 * i);
        for (const Triangle& half : {kLowerHalf, kUpperHalf})
            addPolygon(scene, Triangle{half[0] + glm::vec3(x, 0, 0), half[1] + glm::vec3(x, 0, 0),
                                       half[2] + glm::vec3(x, 0, 0)});
    }
    const Scene prepared = prepareScene(scene);
    ASSERT_EQ(prepared.polygons.size(), 20U);
    for (std::uint32_t i = 0; i < 20; ++i) EXPECT_EQ(prepared.polygons[i].node, i + 1);
}

TEST(PrepareScene, ChangesNothingTheSecondTime) {
    for (const SampleScene& sample : sampleScenes()) {
        PrepareReport report;
        const Scene again = prepareScene(sample.scene, {}, &report);
        EXPECT_EQ(again.positions.size(), sample.scene.positions.size()) << sample.name;
        EXPECT_EQ(again.polygons.size(), sample.scene.polygons.size()) << sample.name;
        EXPECT_EQ(report.weldedVertices + report.collapsedPolygons + report.joinedPairs, 0U) << sample.name;
    }
}

TEST(PrepareScene, OfAnEmptySceneIsEmpty) {
    EXPECT_TRUE(prepareScene(emptyScene()).polygons.empty());
    EXPECT_TRUE(prepareScene(Scene{}).positions.empty());
}

TEST(PlaneFrame, IsOrthonormalAndSeesTheFrontCounterClockwise) {
    for (const SampleScene& sample : sampleScenes()) {
        for (const Polygon& polygon : sample.scene.polygons) {
            SCOPED_TRACE(sample.name);
            const PlaneFrame frame = planeFrame(sample.scene, polygon);
            EXPECT_NEAR(glm::length(frame.axisX), 1.0, 1e-14); // some roundings in double
            EXPECT_NEAR(glm::length(frame.axisY), 1.0, 1e-14);
            EXPECT_NEAR(glm::dot(frame.axisX, frame.axisY), 0.0, 1e-14);
            double area = 0.0, longest = 0.0;
            for (int k = 0; k < polygon.size(); ++k) {
                const glm::vec3& here = corner(sample.scene, polygon, k);
                const glm::dvec2 a = frame.project(here);
                const glm::dvec2 b = frame.project(corner(sample.scene, polygon, (k + 1) % polygon.size()));
                area += 0.5 * (a.x * b.y - a.y * b.x);
                longest = std::max(longest, glm::distance(a, b));
                // Quads are planar to 1e-5 of their size.
                const auto size = static_cast<double>(boundsOf(sample.scene).diagonal());
                EXPECT_LE(glm::distance(glm::dvec3(frame.lift(a)), glm::dvec3(here)), 1e-5 * size);
            }
            EXPECT_NEAR(area, exactArea(sample.scene, polygon), 1e-9 * longest * longest);
        }
    }
}

TEST(PrepareScene, PolygonsOnTheSameVerticesBecomeOne) {
    const std::array<glm::vec3, 4> up{{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}};
    const std::array<glm::vec3, 4> turned{{{1, 1, 0}, {0, 1, 0}, {0, 0, 0}, {1, 0, 0}}};
    const std::array<glm::vec3, 4> down{{{0, 0, 0}, {0, 1, 0}, {1, 1, 0}, {1, 0, 0}}};
    const std::array quads{up, turned, down};
    const std::array materials{greyMaterial("a", 0.5F), greyMaterial("b", 0.5F), greyMaterial("c", 0.5F)};
    PrepareReport report;
    const Scene prepared = prepareScene(quadScene(quads, materials), {}, &report);
    ASSERT_EQ(prepared.polygons.size(), 1U);
    EXPECT_EQ(prepared.polygons[0].material, 1U) << "the later of another material";
    EXPECT_EQ(prepared.polygons[0].backMaterial, 2U);
    EXPECT_EQ(report.duplicatePolygons, 0U);
    EXPECT_EQ(report.cover.coveredPolygons, 1U);
    EXPECT_EQ(report.mergedSheets, 1U);
    EXPECT_EQ(prepareScene(quadScene(quads, materials), {.keepPolygons = true}).polygons.size(), 3U);
}

} // namespace
} // namespace lambert
