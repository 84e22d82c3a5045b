// Scenes that no modeller should write and every modeller does: the mesh may be poor, but it must exist,
// cover the polygons, and be looked up without leaving them.

#include "mesh_checks.h"
#include "meshing/half_edge_mesh.h"
#include "meshing/prepare.h"
#include "sample_scenes.h"

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace lambert {
namespace {

using Quad = std::array<glm::vec3, 4>;
using Triangle = std::array<glm::vec3, 3>;

/// Meshes at several lengths, and looks at what must hold for any input.
void expectSurvives(const Scene& input) {
    const Scene scene = prepareScene(input);
    const auto size = static_cast<double>(boundsOf(scene).diagonal());
    for (const double length : {10.0 * size, 0.1 * size, 0.03 * size}) {
        SCOPED_TRACE(testing::Message() << "patch length " << length);
        const PatchMesh mesh = meshWithLength(scene, length);
        ASSERT_GE(mesh.frontCount, scene.polygons.size());
        std::vector<double> covered(scene.polygons.size(), 0.0);
        for (std::size_t patch = 0; patch < mesh.size(); ++patch) {
            ASSERT_GT(mesh.area[patch], 0.0F);
            ASSERT_NEAR(static_cast<double>(glm::length(mesh.normal[patch])), 1.0, 1e-6);
            ASSERT_TRUE(std::isfinite(glm::dot(mesh.centroid[patch], mesh.centroid[patch])));
            if (!mesh.isBack(patch)) covered[mesh.polygon[patch]] += static_cast<double>(mesh.area[patch]);
        }
        std::mt19937 random(7);
        std::uniform_real_distribution<float> uniform(0.0F, 0.5F);
        for (std::uint32_t i = 0; i < scene.polygons.size(); ++i) {
            const Polygon& polygon = scene.polygons[i];
            double perimeter = 0.0;
            for (int k = 0; k < polygon.size(); ++k)
                perimeter += glm::distance(glm::dvec3(corner(scene, polygon, k)),
                                           glm::dvec3(corner(scene, polygon, (k + 1) % polygon.size())));
            // Vertices up to two welding tolerances off a border are put into it.
            const double moved = 2.0 * static_cast<double>(weldTolerance(scene)) + coordinateRounding(scene);
            const double area = exactArea(scene, polygon);
            ASSERT_NEAR(covered[i], area, 1e-5 * area + moved * perimeter) << "polygon " << i;
            const std::uint32_t patch = mesh.lookup.patchAt(i, uniform(random), uniform(random));
            ASSERT_LT(patch, mesh.frontCount);
            ASSERT_EQ(mesh.polygon[patch], i);
        }
        EXPECT_EQ(buildHalfEdgeMesh(mesh, 0.5F).topology.n_faces(), mesh.size());
    }
}

Scene triangleSoup(std::uint32_t seed, int count, float size, float grid) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> uniform(-1.0F, 1.0F);
    const auto snap = [grid](glm::vec3 p) {
        return grid > 0.0F ? glm::vec3(std::round(p.x / grid), std::round(p.y / grid), std::round(p.z / grid)) * grid
                           : p;
    };
    Scene scene = emptyScene();
    scene.materials.push_back(scene.materials[0]);
    scene.materials[1].twoSided = true;
    for (int i = 0; i < count; ++i) {
        const glm::vec3 centre(uniform(random), uniform(random), uniform(random));
        Triangle triangle;
        for (glm::vec3& p : triangle)
            p = snap(centre + size * glm::vec3(uniform(random), uniform(random), uniform(random)));
        addPolygon(scene, triangle);
        scene.polygons.back().material = random() % 2;
    }
    return scene;
}

TEST(HostileScene, TenThousandRandomTriangles) {
    SCOPED_TRACE("seed 1");
    expectSurvives(triangleSoup(1, 10000, 0.2F, 0.0F));
}

TEST(HostileScene, TrianglesOnALattice) {
    // Many coincide, share parts of edges, lie on and cross each other in the same planes.
    for (std::uint32_t seed = 1; seed <= 8; ++seed) {
        SCOPED_TRACE(testing::Message() << "seed " << seed);
        expectSurvives(triangleSoup(seed, 400, 1.0F, 0.5F));
        expectSurvives(triangleSoup(seed, 400, 0.4F, 0.1F));
    }
}

TEST(HostileScene, NeedlesAndNearlyEqualVertices) {
    for (std::uint32_t seed = 1; seed <= 20; ++seed) {
        SCOPED_TRACE(testing::Message() << "seed " << seed);
        std::mt19937 random(seed);
        Scene scene = triangleSoup(seed, 300, 0.5F, 0.1F);
        std::uniform_int_distribution<int> exponent(-8, -4);
        std::normal_distribution<float> normal;
        for (glm::vec3& p : scene.positions)
            p += std::pow(10.0F, static_cast<float>(exponent(random))) *
                 glm::vec3(normal(random), normal(random), normal(random));
        for (Polygon& polygon : scene.polygons) // needles: a corner moves almost onto an edge
            if (random() % 4 == 0) {
                const glm::vec3 middle = 0.5F * (corner(scene, polygon, 0) + corner(scene, polygon, 1));
                glm::vec3& tip = scene.positions[polygon.vertices[2]];
                tip = middle + std::pow(10.0F, static_cast<float>(exponent(random))) * (tip - middle);
            }
        expectSurvives(scene);
    }
}

TEST(HostileScene, DuplicatedPolygons) {
    Scene scene = roomWithTurnedBox();
    const std::vector<Polygon> polygons = scene.polygons;
    for (int copy = 0; copy < 3; ++copy) scene.polygons.insert(scene.polygons.end(), polygons.begin(), polygons.end());
    expectSurvives(scene);
}

TEST(HostileScene, PolygonsThatRepeatAVertex) {
    Scene scene = roomWithTurnedBox();
    Polygon repeated = scene.polygons[0];
    repeated.vertices[2] = repeated.vertices[1];
    scene.polygons.push_back(repeated);
    repeated = scene.polygons[0];
    repeated.vertices[1] = repeated.vertices[0];
    repeated.vertices[2] = repeated.vertices[0];
    scene.polygons.push_back(repeated);
    PrepareReport report;
    const Scene prepared = prepareScene(scene, {}, &report);
    EXPECT_EQ(report.collapsedPolygons, 1U);
    EXPECT_EQ(prepared.polygons.size(), scene.polygons.size() - 1);
    expectSurvives(scene);
}

TEST(HostileScene, SheetsThatOverlapInOnePlane) {
    for (std::uint32_t seed = 1; seed <= 20; ++seed) {
        SCOPED_TRACE(testing::Message() << "seed " << seed);
        std::mt19937 random(seed);
        std::uniform_real_distribution<float> uniform(0.0F, 3.0F);
        Scene scene = emptyScene();
        for (int i = 0; i < 12; ++i) {
            const glm::vec2 lower(uniform(random), uniform(random));
            const glm::vec2 upper = lower + glm::vec2(uniform(random) + 0.1F, uniform(random) + 0.1F);
            addPolygon(
                scene,
                Quad{{{lower.x, lower.y, 0}, {upper.x, lower.y, 0}, {upper.x, upper.y, 0}, {lower.x, upper.y, 0}}});
        }
        expectSurvives(scene);
        expectSurvives(turned(scene));
    }
}

TEST(HostileScene, AFloorOfTilesUnderTurnedBoxes) {
    Scene scene = emptyScene();
    for (int i = 0; i < 6; ++i)
        for (int k = 0; k < 6; ++k) {
            const auto x = static_cast<float>(i);
            const auto y = static_cast<float>(k);
            addPolygon(scene, Quad{{{x, y, 0}, {x + 1, y, 0}, {x + 1, y + 1, 0}, {x, y + 1, 0}}});
        }
    const std::size_t floorVertices = scene.positions.size();
    addBox(scene, {0.5F, -1.0F, 0.0F}, {3.5F, 1.0F, 1.0F}, true);
    for (std::size_t i = floorVertices; i < scene.positions.size(); ++i) {
        glm::vec3& p = scene.positions[i];
        p = glm::vec3(1.5F + 0.8F * p.x - 0.6F * p.y, 1.2F + 0.6F * p.x + 0.8F * p.y, p.z);
    }
    expectSurvives(scene);
}

TEST(HostileScene, FarFromTheOrigin) {
    Scene scene = roomWithTurnedBox();
    for (glm::vec3& p : scene.positions) p += glm::vec3(30000.0F, -20000.0F, 10000.0F); // millimetres remain
    expectSurvives(scene);
}

TEST(HostileScene, VeryLongAndVeryShortTogether) {
    Scene scene = emptyScene();
    addPolygon(scene, Quad{{{0, 0, 0}, {1000, 0, 0}, {1000, 0.01F, 0}, {0, 0.01F, 0}}});
    addPolygon(scene, Triangle{{{0, 0, 0}, {0.01F, 0, 0}, {0, 0, 0.01F}}});
    addPolygon(scene, Triangle{{{0, 0.01F, 0}, {1000, 0.01F, 0}, {500, 300, 0}}});
    expectSurvives(scene);
}

} // namespace
} // namespace lambert
