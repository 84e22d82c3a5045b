#include "meshing/half_edge_mesh.h"

#include "meshing/prepare.h"
#include "sample_scenes.h"
#include "scene/example_scenes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <set>

namespace lambert {
namespace {

constexpr float kCrease = 0.5F; ///< radians

using Topology = decltype(HalfEdgeMesh::topology);
using Face = std::array<glm::vec3, 4>;

Scene facesScene(std::span<const Face> faces) {
    Scene scene = emptyScene();
    for (const Face& face : faces) addPolygon(scene, face);
    return prepareScene(scene);
}

/// Polygons whose patches share an edge with patches of `polygon`.
std::set<std::uint32_t> neighbours(const PatchMesh& mesh, const Topology& topology, std::uint32_t polygon,
                                   bool back = false) {
    std::set<std::uint32_t> found;
    for (std::uint32_t patch = 0; patch < mesh.size(); ++patch) {
        if (mesh.polygon[patch] != polygon || mesh.isBack(patch) != back) continue;
        for (const auto other : topology.ff_range(topology.face_handle(patch))) {
            const auto index = static_cast<std::uint32_t>(other.idx());
            EXPECT_EQ(mesh.isBack(index), back) << "a front beside a back";
            if (mesh.polygon[index] != polygon) found.insert(mesh.polygon[index]);
        }
    }
    return found;
}

/// What must hold for every mesh: a face per patch, with the patch's corners in their order.
void expectFacesArePatches(const PatchMesh& mesh, const HalfEdgeMesh& halfEdges) {
    const Topology& topology = halfEdges.topology;
    ASSERT_EQ(topology.n_faces(), mesh.size());
    ASSERT_EQ(halfEdges.corners.size(), mesh.size());
    for (std::uint32_t patch = 0; patch < mesh.size(); ++patch) {
        std::vector<std::uint32_t> walk, expected;
        for (const auto vertex : topology.fv_range(topology.face_handle(patch)))
            walk.push_back(static_cast<std::uint32_t>(vertex.idx()));
        for (int k = 0; k < mesh.cornerCount(patch); ++k) {
            expected.push_back(halfEdges.corners[patch][static_cast<std::size_t>(k)]);
            const auto& p = topology.point(topology.vertex_handle(expected.back()));
            ASSERT_EQ(glm::vec3(p[0], p[1], p[2]), mesh.position(patch, k)) << "patch " << patch;
        }
        ASSERT_EQ(halfEdges.corners[patch][3] == kNone, !mesh.isQuad(patch));
        const auto start = std::find(walk.begin(), walk.end(), expected[0]);
        ASSERT_NE(start, walk.end());
        std::rotate(walk.begin(), start, walk.end());
        ASSERT_EQ(walk, expected) << "patch " << patch;
    }
}

TEST(HalfEdgeMesh, IsSmoothInsideARefinedSquare) {
    const Scene scene = flatScene(std::array<glm::vec2, 4>{{{0, 0}, {1, 0}, {1, 1}, {0, 1}}});
    const PatchMesh mesh = meshWithLength(scene, 0.1);
    const HalfEdgeMesh halfEdges = buildHalfEdgeMesh(mesh, kCrease);
    expectFacesArePatches(mesh, halfEdges);
    EXPECT_EQ(halfEdges.separatedFaces, 0U);
    EXPECT_EQ(halfEdges.topology.n_vertices(), 11U * 11U);
    std::map<unsigned, int> valences;
    for (const auto vertex : halfEdges.topology.vertices()) ++valences[halfEdges.topology.valence(vertex)];
    EXPECT_EQ(valences, (std::map<unsigned, int>{{2, 4}, {3, 36}, {4, 81}}));
}

TEST(HalfEdgeMesh, BreaksAtTheEdgesOfABox) {
    std::array<Material, 6> materials;
    materials.fill(greyMaterial("grey", 0.5F));
    Scene scene = boxScene(glm::vec3(1.0F), materials);
    for (Polygon& polygon : scene.polygons) polygon.material = 0;
    scene = prepareScene(scene);
    const PatchMesh mesh = meshWithLength(scene, 0.25);
    const HalfEdgeMesh sharp = buildHalfEdgeMesh(mesh, kCrease);
    expectFacesArePatches(mesh, sharp);
    for (std::uint32_t i = 0; i < 6; ++i) EXPECT_TRUE(neighbours(mesh, sharp.topology, i).empty());
    EXPECT_EQ(sharp.topology.n_vertices(), 6U * 25U);

    const HalfEdgeMesh round = buildHalfEdgeMesh(mesh, 1.6F); // above 90°
    for (std::uint32_t i = 0; i < 6; ++i) EXPECT_EQ(neighbours(mesh, round.topology, i).size(), 4U);
    EXPECT_EQ(round.topology.n_vertices(), 6U * 9U + 12U * 3U + 8U);
}

TEST(HalfEdgeMesh, BreaksBetweenMaterials) {
    const Face faces[]{{{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}}, {{{1, 0, 0}, {2, 0, 0}, {2, 1, 0}, {1, 1, 0}}}};
    Scene scene = facesScene(faces);
    const PatchMesh same = meshWithLength(scene, 0.5);
    EXPECT_EQ(neighbours(same, buildHalfEdgeMesh(same, kCrease).topology, 0), std::set<std::uint32_t>{1});
    scene.materials.push_back(scene.materials[0]);
    scene.polygons[1].material = 1;
    const PatchMesh different = meshWithLength(scene, 0.5);
    EXPECT_TRUE(neighbours(different, buildHalfEdgeMesh(different, kCrease).topology, 0).empty());
}

TEST(HalfEdgeMesh, BreaksAroundTheFootprintOfABox) {
    Scene scene = emptyScene();
    addPolygon(scene, Face{{{0, 0, 0}, {4, 0, 0}, {4, 4, 0}, {0, 4, 0}}});
    addBox(scene, {1.1F, 1.2F, 0.0F}, {2.3F, 2.6F, 1.0F}, false);
    scene = prepareScene(scene);
    const PatchMesh mesh = meshWithLength(scene, 0.3);
    const HalfEdgeMesh halfEdges = buildHalfEdgeMesh(mesh, kCrease);
    EXPECT_EQ(halfEdges.separatedFaces, 0U);
    const auto below = [&](std::uint32_t patch) {
        const glm::vec3& c = mesh.centroid[patch];
        return c.x > 1.1F && c.x < 2.3F && c.y > 1.2F && c.y < 2.6F;
    };
    double areaBelow = 0.0;
    for (std::uint32_t patch = 0; patch < mesh.size(); ++patch) {
        if (mesh.polygon[patch] != 0) continue;
        if (below(patch)) areaBelow += static_cast<double>(mesh.area[patch]);
        for (const auto other : halfEdges.topology.ff_range(halfEdges.topology.face_handle(patch)))
            EXPECT_EQ(below(static_cast<std::uint32_t>(other.idx())), below(patch));
    }
    EXPECT_NEAR(areaBelow, 1.2 * 1.4, 1e-5); // no patch lies half under the box; coordinates of 4 m in float
}

TEST(HalfEdgeMesh, BreaksTheSideOnWhichSomethingStands) {
    // A two-sided sheet of two faces, and a wall on their common edge: above the fronts, or above the backs.
    for (const float top : {1.0F, -1.0F}) {
        const Face faces[]{{{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}},
                           {{{1, 0, 0}, {2, 0, 0}, {2, 1, 0}, {1, 1, 0}}},
                           {{{1, 0, 0}, {1, 1, 0}, {1, 1, top}, {1, 0, top}}}};
        Scene scene = facesScene(faces);
        for (Polygon& polygon : scene.polygons) polygon.backMaterial = polygon.material;
        const PatchMesh mesh = meshWithLength(scene, 0.5);
        const HalfEdgeMesh halfEdges = buildHalfEdgeMesh(mesh, kCrease);
        expectFacesArePatches(mesh, halfEdges);
        EXPECT_EQ(neighbours(mesh, halfEdges.topology, 0).empty(), top > 0.0F) << top;
        EXPECT_EQ(neighbours(mesh, halfEdges.topology, 0, true).empty(), top < 0.0F) << top;
    }
}

TEST(HalfEdgeMesh, IsSmoothAroundACylinderWithinTheCreaseAngle) {
    constexpr int kSides = 24; // 15° each
    std::vector<Face> faces;
    for (int i = 0; i < kSides; ++i) {
        const auto at = [](int k, float z) {
            const float angle = 2.0F * std::numbers::pi_v<float> * static_cast<float>(k % kSides) / kSides;
            return glm::vec3(std::cos(angle), std::sin(angle), z);
        };
        faces.push_back({at(i, 0), at(i + 1, 0), at(i + 1, 2), at(i, 2)});
    }
    const Scene scene = facesScene(faces);
    const PatchMesh mesh = meshWithLength(scene, 0.3);
    const HalfEdgeMesh smooth = buildHalfEdgeMesh(mesh, 0.27F); // 15.5°
    const HalfEdgeMesh sharp = buildHalfEdgeMesh(mesh, 0.25F);  // 14.3°
    for (std::uint32_t i = 0; i < kSides; ++i) {
        EXPECT_EQ(neighbours(mesh, smooth.topology, i).size(), 2U);
        EXPECT_TRUE(neighbours(mesh, sharp.topology, i).empty());
    }
}

TEST(HalfEdgeMesh, KeepsSheetsBackToBackApartAndSmooth) {
    // The same square twice, facing up and facing down.
    const Face faces[]{{{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}}, {{{0, 0, 0}, {0, 1, 0}, {1, 1, 0}, {1, 0, 0}}}};
    const Scene scene = facesScene(faces);
    const PatchMesh mesh = meshWithLength(scene, 0.25);
    const HalfEdgeMesh halfEdges = buildHalfEdgeMesh(mesh, kCrease);
    expectFacesArePatches(mesh, halfEdges);
    EXPECT_EQ(halfEdges.separatedFaces, 0U);
    EXPECT_EQ(halfEdges.topology.n_vertices(), 2U * 25U);
    EXPECT_TRUE(neighbours(mesh, halfEdges.topology, 0).empty());
}

TEST(HalfEdgeMesh, GivesBacksOfTwoSidedPolygonsTheirOwnVertices) {
    Scene scene = flatScene(std::array<glm::vec2, 4>{{{0, 0}, {1, 0}, {1, 1}, {0, 1}}});
    for (Polygon& polygon : scene.polygons) polygon.backMaterial = polygon.material;
    const PatchMesh mesh = meshWithLength(scene, 0.25);
    ASSERT_EQ(mesh.size(), 32U);
    const HalfEdgeMesh halfEdges = buildHalfEdgeMesh(mesh, kCrease);
    expectFacesArePatches(mesh, halfEdges);
    EXPECT_EQ(halfEdges.separatedFaces, 0U);
    EXPECT_EQ(halfEdges.topology.n_vertices(), 2U * 25U);
    neighbours(mesh, halfEdges.topology, 0, true);
}

/// Three sheets at the edge x = 1; the last one rises by `slope` above the second.
PatchMesh threeSheets(float slope) {
    const Face faces[]{{{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}},
                       {{{1, 0, 0}, {2, 0, 0}, {2, 1, 0}, {1, 1, 0}}},
                       {{{1, 0, 0}, {2, 0, slope}, {2, 1, slope}, {1, 1, 0}}}};
    return meshWithLength(facesScene(faces), 0.5);
}

TEST(HalfEdgeMesh, ConnectsTheUpperTwoOfThreeSheets) {
    const PatchMesh mesh = threeSheets(0.1F);
    const HalfEdgeMesh halfEdges = buildHalfEdgeMesh(mesh, kCrease);
    expectFacesArePatches(mesh, halfEdges);
    EXPECT_EQ(halfEdges.separatedFaces, 0U);
    EXPECT_EQ(neighbours(mesh, halfEdges.topology, 0), std::set<std::uint32_t>{2});
}

TEST(HalfEdgeMesh, CountsTheFacesThatAreNotManifold) {
    const PatchMesh mesh = threeSheets(0.005F); // too flat to tell which one is above
    const HalfEdgeMesh halfEdges = buildHalfEdgeMesh(mesh, kCrease);
    expectFacesArePatches(mesh, halfEdges);
    EXPECT_EQ(halfEdges.separatedFaces, 2U) << "the third sheet's faces at the edge";
}

class HalfEdgeMeshOf : public testing::TestWithParam<SampleScene> {};

TEST_P(HalfEdgeMeshOf, HasThePatchesAsFacesAndRefusesNone) {
    const Scene& scene = GetParam().scene;
    const PatchMesh mesh = meshWithLength(scene, 0.1 * static_cast<double>(boundsOf(scene).diagonal()));
    const HalfEdgeMesh halfEdges = buildHalfEdgeMesh(mesh, kCrease);
    expectFacesArePatches(mesh, halfEdges);
    EXPECT_EQ(halfEdges.separatedFaces, 0U);
}

INSTANTIATE_TEST_SUITE_P(Samples, HalfEdgeMeshOf, testing::ValuesIn(sampleScenes()),
                         [](const auto& sample) { return sample.param.name; });

} // namespace
} // namespace lambert
