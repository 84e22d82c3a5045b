#include "baking/bake_scene.h"
#include "baking/write_baked.h"
#include "core/error.h"
#include "formfactors/hemicube.h"
#include "scene/example_scenes.h"
#include "tests/baking/sample_mesh.h"

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace lambert {
namespace {

using Quad = std::array<glm::vec3, 4>;
constexpr int kLeafTexels = 8;

bool leafHas(int x, int y) { return (x - 3) * (x - 3) + (y - 4) * (y - 4) <= 9 && x != 4; }

std::shared_ptr<const Texture> leafTexture() {
    std::vector<std::uint8_t> rgba;
    for (int y = 0; y < kLeafTexels; ++y)
        for (int x = 0; x < kLeafTexels; ++x)
            rgba.insert(rgba.end(), {90, 160, 60, static_cast<std::uint8_t>(leafHas(x, y) ? 255 : 0)});
    return std::make_shared<Texture>("leaf", kLeafTexels, kLeafTexels, std::move(rgba));
}

/// A room of 2 m with a lamp in its ceiling's middle; `leaves` hang below it.
Scene leafRoom(const std::vector<Quad>& leaves, const Material& leaf) {
    std::vector<Quad> quads{{{{0.9F, 0.9F, 1.999F}, {0.9F, 1.1F, 1.999F}, {1.1F, 1.1F, 1.999F}, {1.1F, 0.9F, 1.999F}}}};
    std::vector<Material> materials{greyMaterial("lamp", 0.0F, 100.0F)};
    for (const Quad& quad : leaves) {
        quads.push_back(quad);
        materials.push_back(leaf);
    }
    Scene scene = quadScene(quads, materials);
    std::array<Material, 6> walls;
    walls.fill(greyMaterial("wall", 0.5F));
    walls[4].name = "floor";
    const Scene room = boxScene(glm::vec3(2.0F), walls);
    for (Polygon polygon : room.polygons) {
        for (std::uint32_t& vertex : polygon.vertices) vertex += static_cast<std::uint32_t>(scene.positions.size());
        polygon.material += static_cast<std::uint32_t>(scene.materials.size());
        scene.polygons.push_back(polygon);
    }
    scene.materials.insert(scene.materials.end(), room.materials.begin(), room.materials.end());
    scene.positions.insert(scene.positions.end(), room.positions.begin(), room.positions.end());
    return scene;
}

glm::vec3 onLeaf(double x, double y) { return {0.5 + x / kLeafTexels, 1.5 - y / kLeafTexels, 1.2}; }

Material leafMaterial() {
    Material leaf = greyMaterial("leaf", 0.4F);
    leaf.twoSided = true;
    return leaf;
}

/// The leaf as an image on one quad.
Scene leafOfTexture() {
    Material leaf = leafMaterial();
    leaf.opacityTexture.texture = 0;
    leaf.opacityCutoff = 0.5F;
    const double n = kLeafTexels;
    Scene scene = leafRoom({{{onLeaf(0, n), onLeaf(n, n), onLeaf(n, 0), onLeaf(0, 0)}}}, leaf);
    SurfaceCorners corners;
    corners.uv = {{{0, 1}, {1, 1}, {1, 0}, {0, 0}}};
    scene.surfaces.push_back(corners);
    scene.polygons[1].surface = 0;
    scene.textures.push_back(leafTexture());
    return scene;
}

/// The leaf as a quad per texel.
Scene leafOfPolygons() {
    std::vector<Quad> quads;
    for (int y = 0; y < kLeafTexels; ++y)
        for (int x = 0; x < kLeafTexels; ++x)
            if (leafHas(x, y))
                quads.push_back({{onLeaf(x, y + 1), onLeaf(x + 1, y + 1), onLeaf(x + 1, y), onLeaf(x, y)}});
    return leafRoom(quads, leafMaterial());
}

BakedScene bake(const Scene& scene, double patchLength, int bounces, int resolution = 64) {
    BakeOptions options;
    auto& light = std::get<FormFactorLight>(options.solve.method);
    options.solve.mesh.patchLength = patchLength;
    light.formFactors.transport.resolution = resolution;
    light.solver.tolerance = 1e-8;
    if (bounces > 0) light.solver.method = SolverMethod::Jacobi;
    light.solver.bounces = bounces;
    light.formFactors.transport.randomRotation = false;
    Progress progress;
    return bakeScene(scene, options, progress);
}

/// The irradiance on the floor, with the patches' centroids.
std::vector<std::pair<glm::vec3, double>> floorLight(const BakedScene& baked) {
    std::vector<std::pair<glm::vec3, double>> light;
    for (std::size_t i = 0; i < baked.mesh.size(); ++i)
        if (baked.scene->materials[baked.mesh.material[i]].name == "floor")
            light.emplace_back(baked.mesh.centroid[i], baked.solution.irradiance[i].x);
    return light;
}

TEST(TexturedScenes, ALeafOfATextureCastsTheShadowOfOneOfPolygons) {
    // Direct light only: what the rays from the floor meet is then the same on both leaves.
    const auto textured = floorLight(bake(leafOfTexture(), 0.15, 1, 48));
    const auto modelled = floorLight(bake(leafOfPolygons(), 0.15, 1, 48));
    ASSERT_EQ(textured.size(), modelled.size());
    const double brightest = std::max_element(modelled.begin(), modelled.end(), [](const auto& a, const auto& b) {
                                 return a.second < b.second;
                             })->second;
    std::size_t shaded = 0;
    for (std::size_t i = 0; i < textured.size(); ++i) {
        ASSERT_EQ(textured[i].first, modelled[i].first);
        // A ray that meets the very border of a texel may fall on either side: a pixel of the lamp's dozen.
        EXPECT_NEAR(textured[i].second, modelled[i].second, 0.05 * brightest) << i;
        shaded += modelled[i].second < 0.5 * brightest && textured[i].second > 0.0 ? 1 : 0;
    }
    EXPECT_GT(shaded, 5U);
}

TEST(TexturedScenes, ALeafOfATextureTakesAsMuchLightAsOneOfPolygons) {
    const auto absorbed = [](const BakedScene& baked) {
        double sum = 0.0;
        for (std::size_t i = 0; i < baked.mesh.size(); ++i)
            if (baked.scene->materials[baked.mesh.material[i]].name == "leaf")
                sum += static_cast<double>(baked.mesh.area[i]) * baked.solution.irradiance[i].x;
        return sum;
    };
    // Patches of the texture are partly holes, and lit as their centres are.
    const double textured = absorbed(bake(leafOfTexture(), 0.11, 1, 32));
    const double modelled = absorbed(bake(leafOfPolygons(), 0.125, 1, 32));
    EXPECT_NEAR(textured, modelled, 0.03 * modelled);
}

TEST(TexturedScenes, HolesKeepTheEnergyBalanceAndClosure) {
    Scene scene = leafOfTexture();
    for (Material& material : scene.materials) material.emittedRadiance = Rgb(1.0F); // no small lamp to sample
    const BakedScene baked = bake(scene, 0.1, 0, 48);
    EXPECT_NEAR(baked.solution.energy.imbalance(), 0.0, 1e-3);
    EXPECT_LT(baked.formFactors()->largestClosureError, 1e-6); // entries are rounded to float
    EXPECT_LT(baked.blackBacks.rays, 1e-4);                    // the back of the lamp, a millimetre below the ceiling
}

TEST(TexturedScenes, HolesKeepReciprocityInTheMean) {
    const BakedScene baked = bake(leafOfTexture(), 0.2, 1, 16);
    const Hemicube hemicube(baked.mesh, *baked.rays, {.resolution = 128, .randomRotation = false});
    Progress progress;
    const FormFactorMatrix matrix = computeMatrix(hemicube, MatrixStorage::Float, progress);
    // Between the leaf's upper side and the room.
    double up = 0.0;
    double down = 0.0;
    const auto isLeaf = [&](std::size_t i) {
        return baked.scene->materials[baked.mesh.material[i]].name == "leaf" && baked.mesh.normal[i].z > 0.0F;
    };
    for (std::size_t i = 0; i < baked.mesh.size(); ++i)
        matrix.visit(i, [&](std::uint32_t j, double factor) {
            const double flow = static_cast<double>(baked.mesh.area[i]) * factor;
            if (isLeaf(i) && !isLeaf(j)) up += flow;
            if (!isLeaf(i) && isLeaf(j)) down += flow;
        });
    EXPECT_NEAR(up, down, 0.02 * up); // centres for patches; texel borders within a pixel
}

TEST(TexturedScenes, FurnaceOfOneMeanReflectanceIsThatOfAPlainOne) {
    // A checker finer than the patches: every patch reflects the mean of its two colours.
    std::vector<glm::vec4> texels{glm::vec4(0.2F, 0.2F, 0.2F, 1), glm::vec4(0.8F, 0.8F, 0.8F, 1),
                                  glm::vec4(0.8F, 0.8F, 0.8F, 1), glm::vec4(0.2F, 0.2F, 0.2F, 1)};
    Material wall = greyMaterial("wall", 0.9F, 1.0F);
    wall.reflectanceTexture.texture = 0;
    Scene scene = boxScene({2, 1.5F, 1}, {wall, wall, wall, wall, wall, wall});
    scene.textures.push_back(std::make_shared<Texture>("checker", 2, 2, std::move(texels)));
    SurfaceCorners corners;
    corners.uv = {{{0, 0}, {60, 0}, {60, 60}, {0, 60}}}; // whole images per patch
    scene.surfaces.push_back(corners);
    for (Polygon& polygon : scene.polygons) polygon.surface = 0;
    const BakedScene baked = bake(scene, 0.5, 0, 32);
    // B = E/(1 − ρ) with ρ = 0.9 · 0.5; rows sum to 1 but for rounding to float.
    for (const Rgb& b : baked.baked.radiosity) EXPECT_NEAR(static_cast<double>(b.x), 1.0 / 0.55, 1e-4);
}

TEST(TexturedScenes, TextureShowsAtVertices) {
    Material wall = greyMaterial("wall", 0.9F, 1.0F);
    Scene scene = boxScene(glm::vec3(1.0F), {wall, wall, wall, wall, wall, wall});
    scene.materials[4].emittedRadiance = Rgb(0.0F);
    scene.materials[4].reflectanceTexture.texture = 0;
    scene.textures.push_back(std::make_shared<Texture>(
        "halves", 2, 1, std::vector<glm::vec4>{glm::vec4(0, 0, 0, 1), glm::vec4(1, 0.5F, 0, 1)}));
    SurfaceCorners corners;
    corners.uv = {{{0, 0}, {1, 0}, {1, 1}, {0, 1}}};
    scene.surfaces.push_back(corners);
    scene.polygons[4].surface = 0;
    const BakedScene baked = bake(scene, 0.1, 0, 32);
    for (std::size_t face = 0; face < baked.mesh.size(); ++face) {
        if (baked.mesh.material[face] != 4) continue;
        for (int k = 0; k < baked.mesh.cornerCount(face); ++k) {
            const std::uint32_t vertex = baked.baked.faces[face][static_cast<std::size_t>(k)];
            const Rgb reflected = baked.baked.radiosity[vertex] / baked.baked.irradiance[vertex];
            const float x = baked.mesh.position(face, k).x;
            if (x < 0.45F) {
                EXPECT_EQ(reflected, Rgb(0.0F));
            }
            if (x > 0.55F) {
                EXPECT_LT(glm::distance(reflected, Rgb(0.9F, 0.45F, 0.0F)), 1e-5F);
            }
        }
    }
}

TEST(TexturedScenes, ABlackEmissionTextureIsNoLight) {
    Material wall = greyMaterial("wall", 0.5F, 1.0F);
    wall.emissionTexture.texture = 0;
    Scene scene = boxScene(glm::vec3(1.0F), {wall, wall, wall, wall, wall, wall});
    scene.textures.push_back(std::make_shared<Texture>("black", 1, 1, std::vector<std::uint8_t>{0, 0, 0, 255}));
    scene.surfaces.emplace_back();
    for (Polygon& polygon : scene.polygons) polygon.surface = 0;
    try {
        bake(scene, 1.0, 0, 16);
        FAIL() << "no error";
    } catch (const InputError& error) {
        EXPECT_NE(std::string(error.what()).find("emission texture"), std::string::npos);
    }
}

TEST(TexturedScenes, HolesAreNotWrittenAndNotDark) {
    const BakedScene baked = bake(leafOfTexture(), 0.07, 0, 16);
    const BakedMesh written = withoutHoles(baked.baked);
    ASSERT_EQ(baked.baked.opacity.size(), baked.baked.faces.size());
    const auto clear = std::count(baked.baked.opacity.begin(), baked.baked.opacity.end(), 0.0F);
    EXPECT_GT(clear, 10);
    EXPECT_EQ(written.faces.size(), baked.baked.faces.size() - static_cast<std::size_t>(clear));
    EXPECT_LT(written.positions.size(), baked.baked.positions.size());
    EXPECT_EQ(written.radiosity.size(), written.positions.size());
    float leastOnLeaf = 1e30F;
    float mostOnLeaf = 0.0F;
    for (std::size_t face = 0; face < written.faces.size(); ++face) {
        for (const std::uint32_t vertex : written.faces[face]) {
            if (vertex == kNone) continue;
            ASSERT_LT(vertex, written.positions.size());
            if (written.materials[written.faceMaterials[face]].name != "leaf" || written.normals[vertex].z < 0.0F)
                continue;
            leastOnLeaf = std::min(leastOnLeaf, written.radiosity[vertex].x);
            mostOnLeaf = std::max(mostOnLeaf, written.radiosity[vertex].x);
        }
    }
    EXPECT_GT(leastOnLeaf, 0.2F * mostOnLeaf); // cos⁴ of the angle to the lamp is at least 0.3

    // A glTF leaves them out by itself.
    for (const char* name : {"holes.glb", "holes.gltf"}) {
        const std::filesystem::path withHoles = test::temporaryFile(name);
        const std::filesystem::path without = test::temporaryFile(std::string("no_") + name);
        writeBaked(baked.baked, withHoles, *formatOf(withHoles), {});
        writeBaked(written, without, *formatOf(without), {});
        EXPECT_EQ(test::contentOf(withHoles), test::contentOf(without));
    }
}

} // namespace
} // namespace lambert
