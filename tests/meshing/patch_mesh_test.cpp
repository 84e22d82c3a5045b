#include "mesh_checks.h"
#include "sample_scenes.h"

#include "core/error.h"
#include "core/parallel.h"

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace lambert {
namespace {

class PatchMeshOf : public testing::TestWithParam<SampleScene> {
protected:
    /// Patch lengths from coarse to fine, of a scene `scale` times as large.
    std::vector<double> lengths(const Scene& scene) const {
        const auto size = static_cast<double>(boundsOf(scene).diagonal());
        return {10.0 * size, 0.4 * size, 0.13 * size, 0.041 * size};
    }
};

TEST_P(PatchMeshOf, IsSoundAtEveryScaleAndLength) {
    for (const float scale : {1e-8F, 1e-3F, 1.0F, 1e3F, 1e8F}) {
        const Scene scene = scaled(GetParam().scene, scale);
        for (const double length : lengths(scene)) {
            SCOPED_TRACE(testing::Message() << "scale " << scale << ", patch length " << length);
            MeshReport report;
            const PatchMesh mesh = meshWithLength(scene, length, &report);
            expectSoundMesh(scene, mesh);
            EXPECT_EQ(report.undividedPolygons, 0U);
            EXPECT_EQ(report.degeneratePatches, 0U);
            EXPECT_EQ(report.ignoredContactPolygons, 0U);
            EXPECT_EQ(report.patchLength, length);
        }
    }
}

TEST_P(PatchMeshOf, HasNoTVertex) {
    for (const double length : lengths(GetParam().scene)) {
        SCOPED_TRACE(testing::Message() << "patch length " << length);
        const PatchMesh mesh = meshWithLength(GetParam().scene, length);
        expectNoTVertex(GetParam().scene, mesh);
        if (GetParam().closed) expectClosed(mesh);
    }
}

TEST_P(PatchMeshOf, DividesBordersToThePatchLength) {
    const Scene& scene = GetParam().scene;
    for (const double length : lengths(scene)) {
        const PatchMesh mesh = meshWithLength(scene, length);
        // Inner edges of a triangulation may be longer: the diagonal of a lattice square, stretched next to
        // the border by up to one and a half clearances on either side.
        double longest = 0.0;
        for (std::size_t patch = 0; patch < mesh.size(); ++patch) longest = std::max(longest, longestEdge(mesh, patch));
        EXPECT_LE(longest, 2.1 * length);
        RecordProperty("longest_edge", std::to_string(longest / length));
        // Each edge is divided into equal parts, of which a thousandth more is allowed.
        for (std::size_t patch = 0; patch < mesh.size(); ++patch)
            for (int k = 0; k < mesh.cornerCount(patch); ++k) {
                const glm::vec3& a = mesh.position(patch, k);
                const glm::vec3& b = mesh.position(patch, (k + 1) % mesh.cornerCount(patch));
                const Polygon& polygon = scene.polygons[mesh.polygon[patch]];
                for (int side = 0; side < polygon.size(); ++side) {
                    const glm::dvec3 c(corner(scene, polygon, side));
                    const glm::dvec3 d(corner(scene, polygon, (side + 1) % polygon.size()));
                    const auto onSide = [&](const glm::vec3& p) {
                        const double far = glm::distance(c, glm::dvec3(p)) + glm::distance(glm::dvec3(p), d);
                        return far <= glm::distance(c, d) * (1.0 + 1e-6);
                    };
                    if (!onSide(a) || !onSide(b)) continue;
                    EXPECT_LE(glm::distance(glm::dvec3(a), glm::dvec3(b)), length * (1.0 + 1.1e-3));
                }
            }
    }
}

TEST_P(PatchMeshOf, IsTheSameOnAnyNumberOfThreads) {
    const Scene& scene = GetParam().scene;
    for (const double length : lengths(scene)) {
        setThreadCount(1);
        const PatchMesh one = meshWithLength(scene, length);
        setThreadCount(3);
        const PatchMesh three = meshWithLength(scene, length);
        setThreadCount(0);
        EXPECT_EQ(one.positions, three.positions);
        EXPECT_EQ(one.corners, three.corners);
        EXPECT_EQ(one.polygon, three.polygon);
    }
}

TEST_P(PatchMeshOf, KeepsThePolygonsForZeroPatches) {
    const Scene& scene = GetParam().scene;
    Progress progress;
    MeshOptions options;
    options.patches = 0;
    MeshReport report;
    const PatchMesh mesh = buildPatchMesh(scene, options, progress, &report);
    ASSERT_EQ(mesh.frontCount, scene.polygons.size());
    for (std::size_t i = 0; i < mesh.frontCount; ++i) EXPECT_EQ(mesh.corners[i], scene.polygons[i].vertices);
    expectSoundMesh(scene, mesh);
    EXPECT_TRUE(std::isinf(report.patchLength));
}

INSTANTIATE_TEST_SUITE_P(Samples, PatchMeshOf, testing::ValuesIn(sampleScenes()),
                         [](const auto& sample) { return sample.param.name; });

TEST(BuildPatchMesh, MakesAboutAsManyPatchesAsWanted) {
    std::vector<std::pair<std::string, Scene>> scenes{{"room with a box", roomWithTurnedBox()}};
    for (const char* name : {"cornell_box.obj", "room432.obj", "furnace_box.obj", "table_room.gltf", "tetrahedron.obj"})
        scenes.emplace_back(name, dataScene(name));
    for (const auto& [name, scene] : scenes) {
        for (const std::size_t wanted : {500U, 2000U, 5000U, 20000U}) {
            if (wanted < 3 * scene.polygons.size()) continue; // the polygons themselves are a good part of it
            Progress progress;
            MeshOptions options;
            options.patches = wanted;
            const auto found = static_cast<double>(buildPatchMesh(scene, options, progress).size());
            EXPECT_NEAR(found, static_cast<double>(wanted), 0.1 * static_cast<double>(wanted)) << name;
        }
    }
}

TEST(BuildPatchMesh, KeepsNoLargePolygonWholeBecauseOfManySmallOnes) {
    const Scene scene = dataScene("table_room.gltf"); // 520 polygons, walls of 11 to 21 m² among them
    double area = 0.0;
    for (const Polygon& polygon : scene.polygons) area += polygonArea(scene, polygon);
    double before = std::numeric_limits<double>::infinity();
    for (const double wanted : {260.0, 400.0, 500.0, 540.0, 600.0, 900.0, 1100.0, 2000.0}) {
        Progress progress;
        MeshOptions options;
        options.patches = static_cast<std::size_t>(wanted);
        MeshReport report;
        const PatchMesh mesh = buildPatchMesh(scene, options, progress, &report);
        const double longest = 2.0 * std::sqrt(area / wanted); // the contract
        EXPECT_LE(report.patchLength, 1.0001 * longest) << wanted;
        EXPECT_LE(report.patchLength, 1.03 * before) << wanted << ": more patches, larger ones"; // found to within 3 %
        EXPECT_LE(*std::max_element(mesh.area.begin(), mesh.area.end()), 2.0 * longest * longest) << wanted;
        before = report.patchLength;
    }
}

TEST(BuildPatchMesh, MakesSquaresOfARectangle) {
    const Scene scene = flatScene(std::array<glm::vec2, 4>{{{0, 0}, {3, 0}, {3, 2}, {0, 2}}});
    const PatchMesh mesh = meshWithLength(scene, 0.1);
    EXPECT_EQ(mesh.size(), 30U * 20U); // 3 / 0.1 in floating point is a hair above 30
    for (std::size_t patch = 0; patch < mesh.size(); ++patch) {
        EXPECT_TRUE(mesh.isQuad(patch));
        EXPECT_NEAR(longestEdge(mesh, patch), 0.1, 1e-6); // coordinates of about 3 m
        EXPECT_NEAR(shortestEdge(mesh, patch), 0.1, 1e-6);
    }
}

TEST(BuildPatchMesh, GivesTwoSidedPolygonsTwoSides) {
    Scene scene = roomWithTurnedBox();
    Material leaf = scene.materials[0];
    leaf.twoSided = true;
    scene.materials.push_back(leaf);
    for (std::size_t i = 0; i < scene.polygons.size(); i += 2) scene.polygons[i].material = 1;
    for (const double length : {10.0, 0.5}) expectSoundMesh(scene, meshWithLength(scene, length));
}

TEST(BuildPatchMesh, RefusesAPatchLengthThatIsNotPositive) {
    const Scene scene = roomWithTurnedBox();
    for (const double length : {0.0, -1.0, std::nan("")}) EXPECT_THROW(meshWithLength(scene, length), UsageError);
    EXPECT_THROW(meshWithLength(scene, 1e-6), UsageError) << "more patches than indices";
}

TEST(BuildPatchMesh, StopsWhenCancelled) {
    Progress progress;
    progress.cancel();
    EXPECT_THROW(buildPatchMesh(roomWithTurnedBox(), {}, progress), Cancelled);
}

TEST(BuildPatchMesh, OfAnEmptySceneIsEmpty) {
    Progress progress;
    EXPECT_EQ(buildPatchMesh(emptyScene(), {}, progress).size(), 0U);
}

} // namespace
} // namespace lambert
