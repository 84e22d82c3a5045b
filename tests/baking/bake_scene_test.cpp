#include "baking/bake_scene.h"
#include "baking/probe.h"
#include "core/error.h"
#include "scene/example_scenes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace lambert {
namespace {

using Quad = std::array<glm::vec3, 4>;

BakedScene bake(const Scene& scene, std::size_t patches, int resolution) {
    FormFactorLight method;
    method.formFactors.transport.resolution = resolution;
    method.solver.tolerance = 1e-6;
    BakeOptions options;
    options.solve.mesh.patches = patches;
    options.solve.method = method;
    Progress progress;
    return bakeScene(scene, options, progress);
}

std::vector<ProbeReading> probed(const BakedScene& baked, std::span<const ProbePoint> points) {
    Progress progress;
    return probeIrradiance(baked, {}, points, progress);
}

TEST(BakeScene, FurnaceHasTheSameLightAtEveryVertex) {
    const Material wall = greyMaterial("wall", 0.5F, 1.0F);
    const BakedScene baked = bake(boxScene({2, 1.5F, 1}, {wall, wall, wall, wall, wall, wall}), 300, 32);
    // Rows sum to 1: only the residual (1e-6) and float rounding are left.
    for (const Rgb& b : baked.baked.radiosity) EXPECT_NEAR(static_cast<double>(b.x), 2.0, 1e-5);
    for (const Rgb& e : baked.baked.irradiance) EXPECT_NEAR(static_cast<double>(e.x), 2.0, 1e-5);
}

TEST(BakeScene, FacesOfTheBakedMeshAreThePatches) {
    const BakedScene baked = bake(roomWithBoxScene(), 400, 16);
    ASSERT_EQ(baked.baked.faces.size(), baked.mesh.size());
    for (std::size_t i = 0; i < baked.mesh.size(); ++i) {
        EXPECT_EQ(baked.baked.isQuad(i), baked.mesh.isQuad(i));
        for (int k = 0; k < baked.mesh.cornerCount(i); ++k)
            EXPECT_EQ(baked.baked.positions[baked.baked.faces[i][static_cast<std::size_t>(k)]],
                      baked.mesh.position(i, k));
    }
}

TEST(BakeScene, VerticesAreSplitAtCreases) {
    const Material wall = greyMaterial("wall", 0.5F, 1.0F);
    const BakedScene baked = bake(boxScene(glm::vec3(1.0F), {wall, wall, wall, wall, wall, wall}), 0, 16);
    EXPECT_EQ(baked.baked.positions.size(), 24U); // four of its own for each of six faces
}

TEST(BakeScene, DarknessUnderAnObjectDoesNotReachTheFloorAroundIt) {
    const BakedScene baked = bake(roomWithBoxScene(), 1500, 64);
    const BakedMesh& mesh = baked.baked;
    std::size_t contactVertices = 0;
    for (std::size_t face = 0; face < mesh.faces.size(); ++face) {
        if (mesh.faceMaterials[face] == 6 || baked.mesh.normal[face].z < 0.99F) continue; // the floor only
        const bool covered = baked.solution.covered[face] > 0.99F;
        for (int k = 0; k < baked.mesh.cornerCount(face); ++k) {
            const std::uint32_t vertex = mesh.faces[face][static_cast<std::size_t>(k)];
            if (covered) {
                EXPECT_LT(mesh.irradiance[vertex].x, 1e-6F);
                ++contactVertices;
            } else {
                EXPECT_GT(mesh.irradiance[vertex].x,
                          0.05F); // the darkest corner sees at least 1/20 of the lamp's light
            }
        }
    }
    EXPECT_GT(contactVertices, 20U);
}

TEST(BakeScene, WarnsAndNamesTheMaterialWhereLightMeetsBacks) {
    Scene scene = roomWithBoxScene();
    for (Polygon& polygon : scene.polygons)
        if (polygon.material == 6) std::swap(polygon.vertices[1], polygon.vertices[3]);
    const BakedScene baked = bake(scene, 400, 32);
    ASSERT_EQ(baked.warnings.size(), 1U);
    EXPECT_NE(baked.warnings[0].find("\"box\""), std::string::npos) << baked.warnings[0];
    EXPECT_NE(baked.warnings[0].find("--two-sided"), std::string::npos);
    EXPECT_TRUE(bake(roomWithBoxScene(), 400, 32).warnings.empty());
}

TEST(BakeScene, TwoSidedSheetIsLitOnBothSides) {
    Scene scene = roomWithBoxScene();
    scene.polygons.resize(6);
    addQuad(scene, {{{0.5F, 0.5F, 1}, {1.5F, 0.5F, 1}, {1.5F, 1.5F, 1}, {0.5F, 1.5F, 1}}}, 6);
    scene.materials[6].twoSided = true;
    const BakedScene baked = bake(scene, 600, 32);
    double front = 0.0;
    double back = 0.0;
    for (std::size_t i = 0; i < baked.mesh.size(); ++i) {
        if (baked.mesh.material[i] != 6) continue;
        (baked.mesh.isBack(i) ? back : front) +=
            static_cast<double>(baked.mesh.area[i]) * baked.solution.irradiance[i].x;
    }
    EXPECT_GT(front, 2.0 * back); // the lamp is above
    EXPECT_GT(back, 0.05);
    EXPECT_EQ(baked.blackBacks.rays, 0.0);
}

TEST(BakeScene, TwoSheetsBackToBackAreLitLikeOneOfTwoSides) {
    const std::array<Quad, 3> quads{{{{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}},
                                     {{{0, 0, 0}, {0, 1, 0}, {1, 1, 0}, {1, 0, 0}}},
                                     {{{0, 0, 1}, {0, 1, 1}, {1, 1, 1}, {1, 0, 1}}}}};
    const std::array materials{greyMaterial("above", 0.5F), greyMaterial("below", 0.5F),
                               greyMaterial("lamp", 0.5F, 1.0F)};
    const BakedScene baked = bake(quadScene(quads, materials), 200, 64);
    std::array<double, 3> flux{};
    for (std::size_t i = 0; i < baked.mesh.size(); ++i)
        flux[baked.mesh.material[i]] += static_cast<double>(baked.mesh.area[i]) * baked.solution.irradiance[i].x;
    EXPECT_NEAR(flux[0], 0.2, 0.02); // C-11: 0.19982, and what comes back
    EXPECT_EQ(flux[1], 0.0);
    EXPECT_EQ(baked.blackBacks.rays, 0.0);
}

TEST(BakeScene, ASceneWithoutLightNamesTheOption) {
    const Material wall = greyMaterial("wall", 0.5F);
    try {
        bake(boxScene(glm::vec3(1.0F), {wall, wall, wall, wall, wall, wall}), 100, 16);
        FAIL() << "no error";
    } catch (const InputError& error) {
        EXPECT_NE(std::string(error.what()).find("--emit"), std::string::npos);
    }
}

TEST(BakeScene, ASceneLitByAPointLightAloneKeepsTheEnergyBalance) {
    const Material wall = greyMaterial("wall", 0.5F);
    Scene scene = boxScene(glm::vec3(1.0F), {wall, wall, wall, wall, wall, wall});
    scene.lights.push_back({.name = "bulb", .position = {0.4F, 0.5F, 0.7F}});
    const BakedScene baked = bake(scene, 300, 64);
    // All of 4π I meets the walls; the rest is the error of the points of each patch.
    EXPECT_NEAR(baked.solution.energy.received.x, 4.0 * std::numbers::pi, 2e-3 * 4.0 * std::numbers::pi);
    EXPECT_EQ(baked.solution.energy.emitted.x, 0.0);
    EXPECT_LE(std::abs(baked.solution.energy.imbalance()), 5e-3); // reciprocity is not enforced
}

TEST(BakeScene, EnergyImbalanceOfRawRowsIsSmallAt1000Patches) {
    const BakedScene baked = bake(roomWithBoxScene(), 1000, 64);
    EXPECT_LE(std::abs(baked.solution.energy.imbalance()), 5e-3); // reciprocity is not enforced
}

TEST(Probe, PointOnASurfaceIsInterpolatedAndPointInSpaceIsGathered) {
    const Material wall = greyMaterial("wall", 0.5F, 1.0F);
    const BakedScene baked = bake(boxScene(glm::vec3(1.0F), {wall, wall, wall, wall, wall, wall}), 200, 32);
    const std::array points{ProbePoint{{0.3F, 0.4F, 0}, {0, 0, 1}}, ProbePoint{{0.3F, 0.4F, 0.5F}, {0, 3, 4}},
                            ProbePoint{{0, 0, 0}, {0, 0, 1}}};
    const auto readings = probed(baked, points);
    EXPECT_TRUE(readings[0].onSurface);
    EXPECT_FALSE(readings[1].onSurface);
    for (const ProbeReading& reading : readings) EXPECT_NEAR(reading.irradiance.x, 2.0, 1e-4);
}

TEST(Probe, PointUnderATwoSidedSheetReadsTheSideItFaces) {
    const std::array<Quad, 2> quads{
        {{{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}}, {{{0, 0, 1}, {0, 1, 1}, {1, 1, 1}, {1, 0, 1}}}}};
    std::array materials{greyMaterial("sheet", 0.5F), greyMaterial("lamp", 0.5F, 1.0F)};
    materials[0].twoSided = true;
    const BakedScene baked = bake(quadScene(quads, materials), 200, 32);
    const std::array points{ProbePoint{{0.5F, 0.5F, 0}, {0, 0, 1}}, ProbePoint{{0.5F, 0.5F, 0}, {0, 0, -1}}};
    const auto readings = probed(baked, points);
    EXPECT_GT(readings[0].irradiance.x, 0.1);
    EXPECT_EQ(readings[1].irradiance.x, 0.0);
}

} // namespace
} // namespace lambert
