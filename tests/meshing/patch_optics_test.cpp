#include "meshing/patch_optics.h"

#include "meshing/build_patch_mesh.h"
#include "meshing/prepare.h"
#include "scene/example_scenes.h"
#include "scene/rays/ray_caster.h"
#include "scene/surface.h"

#include "mesh_checks.h"
#include "sample_scenes.h"

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace lambert {
namespace {

std::shared_ptr<const Texture> patterned(int width, int height) {
    std::vector<std::uint8_t> rgba;
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
            rgba.insert(rgba.end(),
                        {static_cast<std::uint8_t>((x * 37 + y * 11) % 256),
                         static_cast<std::uint8_t>((x * y * 5) % 256), static_cast<std::uint8_t>(y % 3 == 0 ? 255 : 20),
                         static_cast<std::uint8_t>((x / 3 + y / 2) % 3 == 0 ? 10 : 250)});
    return std::make_shared<Texture>("pattern", width, height, std::move(rgba));
}

/// A trapezoid, the texture turned, repeated along u and mirrored along v, in other proportions on each half.
Scene texturedTrapezoid() {
    const std::array<std::array<glm::vec3, 4>, 1> quad{{{{{0, 0, 0}, {3, 0, 0}, {2.2F, 2, 0}, {0.1F, 1.5F, 0}}}}};
    Scene scene = quadScene(quad, std::array{greyMaterial("paper", 0.8F)});
    scene.materials[0].reflectanceTexture = {0, TextureWrap::Repeat, TextureWrap::Mirror};
    scene.materials[0].emissionTexture = {0, TextureWrap::Clamp, TextureWrap::Repeat};
    scene.materials[0].emittedRadiance = Rgb(2.0F);
    scene.textures.push_back(patterned(17, 23));
    SurfaceCorners corners;
    corners.uv = {{{-0.4F, 0.3F}, {1.6F, 1.1F}, {0.9F, 2.7F}, {-0.9F, 1.4F}}};
    corners.emissionUv = {{{0.0F, 0.0F}, {0.0F, 1.5F}, {-1.2F, 1.2F}, {-1.0F, 0.0F}}};
    corners.tint = {Rgb(1), Rgb(0.5F), Rgb(1), Rgb(0.5F)};
    scene.surfaces.push_back(corners);
    scene.polygons[0].surface = 0;
    return scene;
}

/// What a ray straight down finds, averaged over the hits of each patch; the caster's charts are the reference.
struct Seen {
    std::vector<glm::dvec3> reflectance, emission;
    std::vector<double> points, solid;
};

glm::dvec4 lookup(const Scene& scene, const TextureUse& use, const glm::vec2& uv) {
    const Texture& texture = *scene.textures[use.texture];
    return glm::dvec4(
        texture.texel(texelAt(uv.x, texture.width(), use.wrapU), texelAt(uv.y, texture.height(), use.wrapV)));
}

/// Points all over the chart of polygon 0, weighted by the chart's area on each half.
Seen look(const Scene& scene, const PatchMesh& mesh, int steps) {
    Seen seen{std::vector(mesh.size(), glm::dvec3(0.0)), std::vector(mesh.size(), glm::dvec3(0.0)),
              std::vector(mesh.size(), 0.0), std::vector(mesh.size(), 0.0)};
    const Polygon& polygon = scene.polygons[0];
    const Material& material = scene.materials[0];
    const SurfaceCorners& corners = scene.surfaces[polygon.surface];
    for (int i = 0; i < steps; ++i)
        for (int j = 0; j < steps; ++j) {
            const float u = (static_cast<float>(i) + 0.5F) / static_cast<float>(steps);
            const float v = (static_cast<float>(j) + 0.5F) / static_cast<float>(steps);
            if (!polygon.isQuad() && u + v > 1.0F) continue;
            const bool firstHalf = u + v <= 1.0F;
            const std::array<int, 3> half = firstHalf ? std::array{0, 1, 3} : std::array{2, 3, 1};
            const glm::vec3 o = corner(scene, polygon, half[0]);
            const double weight = static_cast<double>(
                glm::length(glm::cross(corner(scene, polygon, half[1]) - o, corner(scene, polygon, half[2]) - o)));
            const std::uint32_t patch = mesh.lookup.patchAt(0, u, v);
            seen.points[patch] += weight;
            if (hasHoles(scene, polygon) && isHole(scene, polygon, u, v)) continue;
            seen.solid[patch] += weight;
            if (material.reflectanceTexture)
                seen.reflectance[patch] += weight * glm::dvec3(lookup(scene, material.reflectanceTexture,
                                                                      uvAt(corners, polygon.isQuad(), u, v)));
            if (material.emissionTexture)
                seen.emission[patch] += weight * glm::dvec3(lookup(scene, material.emissionTexture,
                                                                   emissionUvAt(corners, polygon.isQuad(), u, v)));
        }
    for (std::size_t i = 0; i < mesh.size(); ++i) {
        seen.reflectance[i] /= seen.solid[i];
        seen.emission[i] /= seen.solid[i];
    }
    return seen;
}

PatchMesh meshOf(const Scene& scene, std::size_t patches) {
    Progress progress;
    MeshOptions options;
    options.patches = patches;
    return buildPatchMesh(scene, options, progress);
}

TEST(PatchOptics, ReflectanceAndEmissionAreTheImagesAreaAverages) {
    Scene scene = texturedTrapezoid();
    scene.surfaces[0].tint = SurfaceCorners().tint;
    for (const std::size_t patches : {0U, 1U, 30U}) {
        const PatchMesh mesh = meshOf(scene, patches);
        const PatchOptics optics = patchOptics(scene, mesh);
        const Seen seen = look(scene, mesh, 2000);
        EXPECT_TRUE(mesh.opacity.empty());
        for (std::size_t i = 0; i < mesh.size(); ++i)
            for (int k = 0; k < 3; ++k) {
                EXPECT_NEAR(static_cast<double>(optics.reflectance[i][k]), 0.8 * seen.reflectance[i][k], 1.0 / 255.0)
                    << i;
                EXPECT_NEAR(static_cast<double>(optics.emittedRadiosity[i][k]),
                            2.0 * std::numbers::pi * seen.emission[i][k], 2.0 * std::numbers::pi / 255.0)
                    << i;
            }
    }
}

TEST(PatchOptics, PlainMaterialsAreTheirConstants) {
    Scene scene = texturedTrapezoid();
    scene.polygons[0].surface = kNone;
    const PatchMesh mesh = meshOf(scene, 10);
    const PatchOptics optics = patchOptics(scene, mesh);
    ASSERT_EQ(optics.reflectance.size(), mesh.size());
    for (std::size_t i = 0; i < mesh.size(); ++i) {
        EXPECT_EQ(optics.reflectance[i], scene.materials[0].reflectance);
        EXPECT_EQ(optics.emittedRadiosity[i], std::numbers::pi_v<float> * scene.materials[0].emittedRadiance);
    }
}

TEST(PatchOptics, TintIsLinearOnTheTriangles) {
    Scene scene = texturedTrapezoid();
    scene.materials[0].reflectanceTexture = {};
    const PatchMesh mesh = meshOf(scene, 0);
    const PatchOptics optics = patchOptics(scene, mesh);
    // Areas of the halves (0, 1, 3) and (2, 3, 1): 2.25 and 2.05 - found by hand; mean tints 2/3 on both.
    EXPECT_NEAR(optics.reflectance[0].x, 0.8F * 2.0F / 3.0F, 1e-6F);
}

TEST(PatchOptics, HolesTakeAwayAreaAndTheColourInThem) {
    Scene scene = texturedTrapezoid();
    scene.surfaces[0].tint = SurfaceCorners().tint;
    scene.surfaces[0].emissionUv = scene.surfaces[0].uv;
    Material& material = scene.materials[0];
    material.emissionTexture = material.opacityTexture = material.reflectanceTexture;
    material.opacityCutoff = 0.5F;
    material.twoSided = true;
    scene = prepareScene(scene);
    const PatchMesh mesh = meshOf(scene, 60);
    const PatchOptics optics = patchOptics(scene, mesh);
    const Seen seen = look(scene, mesh, 2000);
    ASSERT_EQ(mesh.opacity.size(), mesh.size());
    for (std::size_t i = 0; i < mesh.frontCount; ++i) {
        const double opacity = seen.solid[i] / seen.points[i];
        EXPECT_NEAR(static_cast<double>(mesh.opacity[i]), opacity, 1.0 / 255.0);
        EXPECT_NEAR(static_cast<double>(mesh.area[i]), opacity * exactArea(mesh, i), exactArea(mesh, i) / 255.0);
        for (int k = 0; k < 3; ++k) {
            EXPECT_NEAR(static_cast<double>(optics.reflectance[i][k]), 0.8 * seen.reflectance[i][k], 2.0 / 255.0);
            EXPECT_NEAR(static_cast<double>(optics.emittedRadiosity[i][k]), 2.0 * std::numbers::pi * seen.emission[i][k],
                        4.0 * std::numbers::pi / 255.0);
        }
        const std::uint32_t back = mesh.lookup.backPatch(0, static_cast<std::uint32_t>(i));
        EXPECT_NEAR(mesh.opacity[back], mesh.opacity[i], 1e-6F); // another order of the same sums
        EXPECT_NEAR(mesh.area[back], mesh.area[i], 1e-6F);
        EXPECT_NEAR(optics.reflectance[back].x, optics.reflectance[i].x, 1e-5F);
    }
}

TEST(PatchOptics, APatchThatIsOneHoleKeepsAMillionthOfItsArea) {
    Scene scene = texturedTrapezoid();
    Material& material = scene.materials[0];
    material.opacityTexture.texture = 1;
    material.opacityCutoff = 0.5F;
    scene.textures.push_back(std::make_shared<Texture>("clear", 1, 1, std::vector<std::uint8_t>{255, 255, 255, 0}));
    const PatchMesh mesh = meshOf(scene, 10);
    const PatchOptics optics = patchOptics(scene, mesh);
    for (std::size_t i = 0; i < mesh.size(); ++i) {
        EXPECT_EQ(mesh.opacity[i], 0.0F);
        EXPECT_NEAR(static_cast<double>(mesh.area[i]), 1e-6 * exactArea(mesh, i), 1e-12 * exactArea(mesh, i));
        EXPECT_EQ(optics.reflectance[i], Rgb(0.0F));
        EXPECT_EQ(optics.emittedRadiosity[i], Rgb(0.0F));
    }
}

TEST(PatchOptics, NeverReflectMoreThanAllowed) {
    Scene scene = texturedTrapezoid();
    scene.materials[0].reflectance = Rgb(0.99F);
    scene.textures[0] =
        std::make_shared<Texture>("bright", 1, 1, std::vector<glm::vec4>{glm::vec4(50.0F, 0.5F, 1.0F, 1.0F)});
    const PatchMesh mesh = meshOf(scene, 0);
    const PatchOptics optics = patchOptics(scene, mesh);
    EXPECT_EQ(optics.reflectance[0].x, 0.99F);
    EXPECT_GT(optics.emittedRadiosity[0].x, 90.0F);
}

TEST(PrepareScene, JoinedTrianglesShowWhatTheyShowed) {
    Scene scene = texturedTrapezoid();
    const SurfaceCorners whole = scene.surfaces[0];
    const auto v = scene.polygons[0].vertices;
    const auto half = [&](std::array<std::size_t, 3> c) {
        SurfaceCorners surface;
        Polygon polygon = scene.polygons[0];
        polygon.vertices[3] = kNone;
        for (std::size_t k = 0; k < 3; ++k) {
            polygon.vertices[k] = v[c[k]];
            surface.uv[k] = whole.uv[c[k]];
            surface.emissionUv[k] = whole.emissionUv[c[k]];
            surface.tint[k] = whole.tint[c[k]];
        }
        polygon.surface = static_cast<std::uint32_t>(scene.surfaces.size());
        scene.surfaces.push_back(surface);
        scene.polygons.push_back(polygon);
    };
    half({1, 2, 3});
    half({3, 0, 1});
    scene.polygons.erase(scene.polygons.begin());
    const Scene split = prepareScene(scene, {.keepPolygons = true});
    const PatchMesh triangles = meshOf(split, 0);
    const PatchOptics ofTriangles = patchOptics(split, triangles);
    PrepareReport report;
    const Scene joined = prepareScene(scene, {}, &report);
    ASSERT_EQ(report.joinedPairs, 1U);
    const PatchMesh quad = meshOf(joined, 0);
    ASSERT_EQ(triangles.size(), 2U);
    const double area = static_cast<double>(triangles.area[0]) + static_cast<double>(triangles.area[1]);
    const glm::dvec3 expected = (static_cast<double>(triangles.area[0]) * glm::dvec3(ofTriangles.reflectance[0]) +
                                 static_cast<double>(triangles.area[1]) * glm::dvec3(ofTriangles.reflectance[1])) /
                                area;
    EXPECT_LT(glm::distance(glm::dvec3(patchOptics(joined, quad).reflectance[0]), expected), 1e-6); // rounding to float

    scene.surfaces.back().uv[0] += glm::vec2(0.25F, 0.0F);
    EXPECT_EQ(prepareScene(scene).polygons.size(), 2U) << "a seam";
    scene.materials[0].reflectanceTexture = {};
    EXPECT_EQ(prepareScene(scene).polygons.size(), 1U) << "a seam of a texture that is not there";
}

TEST(PrepareScene, SheetsBackToBackKeepBothSurfacesAndTheOpaqueOneGoesFirst) {
    Scene scene = texturedTrapezoid();
    scene.materials[0].opacityTexture = scene.materials[0].reflectanceTexture;
    scene.materials[0].opacityCutoff = 0.5F;
    scene.materials.push_back(greyMaterial("card", 0.25F));
    scene.materials[1].reflectanceTexture = scene.materials[0].reflectanceTexture;
    const auto v = scene.polygons[0].vertices;
    SurfaceCorners other;
    for (std::size_t k = 0; k < 4; ++k) other.uv[k] = glm::vec2(scene.positions[v[(6 - k) % 4]]);
    Polygon reversed = scene.polygons[0];
    reversed.vertices = {v[2], v[1], v[0], v[3]};
    reversed.material = 1;
    reversed.surface = 1;
    scene.surfaces.push_back(other);
    scene.polygons.push_back(reversed);
    const Scene prepared = prepareScene(scene);
    ASSERT_EQ(prepared.polygons.size(), 1U);
    const Polygon& sheet = prepared.polygons[0];
    EXPECT_EQ(sheet.material, 1U) << "light must not pass where there is cardboard";
    EXPECT_EQ(sheet.backMaterial, 0U);
    EXPECT_FALSE(hasHoles(prepared, sheet));
    ASSERT_NE(sheet.backSurface, kNone);
    for (int k = 0; k < 4; ++k) {
        const auto corner = static_cast<std::size_t>(k);
        const glm::vec3& p = prepared.positions[sheet.vertices[corner]];
        EXPECT_EQ(prepared.surfaces[sheet.surface].uv[corner], glm::vec2(p));
        for (std::size_t j = 0; j < 4; ++j) {
            if (scene.positions[v[j]] != p) continue;
            EXPECT_EQ(prepared.surfaces[sheet.backSurface].uv[corner], scene.surfaces[0].uv[j]);
        }
    }
}

TEST(PrepareScene, AQuadThatWeldsToATriangleKeepsItsTextureCoordinates) {
    Scene scene = texturedTrapezoid();
    scene.positions[1] = scene.positions[0] + glm::vec3(1e-7F, 0, 0);
    const Scene prepared = prepareScene(scene);
    ASSERT_EQ(prepared.polygons.size(), 1U);
    ASSERT_FALSE(prepared.polygons[0].isQuad());
    for (const auto& [now, before] : {std::pair(0, 0), {1, 2}, {2, 3}})
        EXPECT_EQ(prepared.surfaces[prepared.polygons[0].surface].uv[static_cast<std::size_t>(now)],
                  scene.surfaces[0].uv[static_cast<std::size_t>(before)]);
}

} // namespace
} // namespace lambert
