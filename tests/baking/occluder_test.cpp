#include "baking/bake_scene.h"
#include "scene/example_scenes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

namespace lambert {
namespace {

/// The lit room with its box black, as a surface or as an occluder.
Scene roomWithBlackBox(bool occluder) {
    Scene scene = roomWithBoxScene();
    for (Material& material : scene.materials)
        if (material.name == "box") {
            material.reflectance = Rgb(0.0F);
            material.occluder = occluder;
        }
    return scene;
}

BakedScene bake(const Scene& scene, MeshOptions mesh) {
    BakeOptions options;
    auto& light = std::get<FormFactorLight>(options.solve.method);
    options.solve.mesh = mesh;
    light.formFactors.transport.method = TransportMethod::Hemicube; // auto judges patches by their neighbours in number
    light.formFactors.transport.resolution = 32;
    light.formFactors.transport.randomRotation = false; // it goes by the patches' numbers, and these differ
    Progress progress;
    return bakeScene(scene, options, progress);
}

MeshOptions patchLength(double length) {
    MeshOptions options;
    options.patchLength = length;
    return options;
}

MeshOptions oneEach() {
    MeshOptions options;
    options.patches = 0;
    return options;
}

/// The patches that are not of the box, in order.
std::vector<std::size_t> roomPatches(const BakedScene& baked) {
    std::vector<std::size_t> patches;
    for (std::size_t i = 0; i < baked.mesh.size(); ++i)
        if (baked.scene->materials[baked.mesh.material[i]].name != "box") patches.push_back(i);
    return patches;
}

TEST(Occluder, LightAroundItIsThatAroundABlackSurface) {
    for (const MeshOptions& mesh : {patchLength(0.2), oneEach()}) {
        const BakedScene surface = bake(roomWithBlackBox(false), mesh);
        const BakedScene occluder = bake(roomWithBlackBox(true), mesh);
        const std::vector<std::size_t> patches = roomPatches(surface);
        ASSERT_EQ(occluder.mesh.size(), patches.size()); // the occluder has none
        for (std::size_t i = 0; i < patches.size(); ++i) {
            EXPECT_EQ(occluder.mesh.centroid[i], surface.mesh.centroid[patches[i]]);
            EXPECT_EQ(occluder.solution.radiosity[i], surface.solution.radiosity[patches[i]]);
        }
        // What the box absorbs stands among the backs, by the other patches' rows instead of its own.
        EXPECT_GT(occluder.solution.energy.backFaces.x, surface.solution.energy.backFaces.x);
    }
}

TEST(Occluder, EnergyIsBalanced) {
    // The hemicubes' own error: measured below 1 % with 32 pixels, for patches a tenth of the room wide.
    EXPECT_NEAR(bake(roomWithBlackBox(true), patchLength(0.2)).solution.energy.imbalance(), 0.0, 0.02);
}

TEST(Occluder, LightIsNotAveragedAcrossWhereItStands) {
    const auto floorVertices = [](const BakedScene& baked) {
        std::set<std::uint32_t> vertices;
        for (const std::size_t patch : roomPatches(baked))
            for (const std::uint32_t vertex : baked.baked.faces[patch])
                if (vertex != kNone) vertices.insert(vertex);
        return vertices.size();
    };
    const MeshOptions mesh = patchLength(0.2);
    EXPECT_EQ(floorVertices(bake(roomWithBlackBox(true), mesh)), floorVertices(bake(roomWithBlackBox(false), mesh)));
}

TEST(Occluder, IsNoReasonToWarnOfBacks) {
    Scene scene = roomWithBlackBox(true);
    EXPECT_TRUE(bake(scene, patchLength(0.2)).warnings.empty());
    for (Polygon& polygon : scene.polygons) // the fronts inward
        if (isOccluder(scene, polygon))
            std::reverse(polygon.vertices.begin(), polygon.vertices.begin() + polygon.size());
    EXPECT_TRUE(bake(scene, patchLength(0.2)).warnings.empty());
}

TEST(Occluder, SurfaceOnTheSameVerticesWins) {
    Scene scene = roomWithBlackBox(true);
    const std::size_t count = scene.polygons.size();
    for (std::size_t i = 0; i < count; ++i) {
        if (!isOccluder(scene, scene.polygons[i])) continue;
        Polygon copy = scene.polygons[i];
        std::reverse(copy.vertices.begin(), copy.vertices.begin() + copy.size());
        copy.material = 0; // a wall
        scene.polygons.push_back(copy);
    }
    const Scene prepared = prepareScene(scene);
    EXPECT_TRUE(std::none_of(prepared.polygons.begin(), prepared.polygons.end(),
                             [&](const Polygon& p) { return isOccluder(prepared, p) || p.backMaterial != kNone; }));
    EXPECT_EQ(prepared.polygons.size(), prepareScene(roomWithBlackBox(false)).polygons.size());
}

} // namespace
} // namespace lambert
