#include "rendering/render.h"

#include "core/error.h"
#include "core/parallel.h"
#include "picture/camera_rays.h"
#include "picture/tone_mapping.h"
#include "scene/environment.h"
#include "tests/rendering/box_scene.h"

#include <glm/ext/scalar_constants.hpp>
#include <glm/vec2.hpp>
#include <gtest/gtest.h>

#include <cmath>

namespace lambert {
namespace {

const float kPi = glm::pi<float>();

RenderOptions sized(int width, int height) {
    RenderOptions options;
    options.width = width;
    options.height = height;
    return options;
}

Image picture(const Scene& scene, const PatchMesh& mesh, const BakedMesh& baked, const Camera& camera,
              const RenderOptions& options) {
    const RayCaster caster(scene);
    Progress progress;
    return renderBaked(mesh, baked, caster, camera, options, progress);
}

/// In the middle of the box, toward a corner.
Camera insideCamera() { return lookAtCamera({0.1F, 0.2F, 0.3F}, {-1, -0.8F, -1}, {0, 1, 0}, 70.0F); }

TEST(RenderBaked, ShowsUniformLightInEveryPixel) {
    const Scene scene = test::boxScene();
    const PatchMesh mesh = test::gridMesh(scene, 3);
    const Rgb radiosity(0.5F, 1.0F, 20.0F);
    const BakedMesh baked = test::bakedWith(scene, mesh, [&](auto&, auto&) { return radiosity; });
    for (const glm::ivec2& size : {glm::ivec2(16, 16), glm::ivec2(13, 7), glm::ivec2(1, 1)}) {
        const Image image = picture(scene, mesh, baked, insideCamera(), sized(size.x, size.y));
        ASSERT_EQ(image.pixels.size(), static_cast<std::size_t>(size.x * size.y));
        EXPECT_EQ(image.content, PixelContent::Radiance);
        for (const Rgb& pixel : image.pixels)
            for (int c = 0; c < 3; ++c) EXPECT_NEAR(pixel[c] * kPi / radiosity[c], 1.0F, 1e-5F);
    }
}

TEST(RenderBaked, ReproducesLinearLight) {
    const Scene scene = test::boxScene();
    const PatchMesh mesh = test::gridMesh(scene, 5);
    const auto light = [](const glm::vec3& p, const glm::vec3&) { return kPi * (glm::vec3(2.0F) + p); };
    const BakedMesh baked = test::bakedWith(scene, mesh, light);
    const Camera camera = insideCamera();
    RenderOptions options = sized(64, 48);
    const Image image = picture(scene, mesh, baked, camera, options);
    const RayCaster caster(scene);
    const CameraRays rays(camera, options.width, options.height);
    for (int y = 0; y < options.height; ++y) {
        for (int x = 0; x < options.width; ++x) {
            const glm::vec3 direction = rays.direction(static_cast<float>(x) + 0.5F, static_cast<float>(y) + 0.5F);
            const auto hit = caster.closest(Ray{camera.eye, direction});
            ASSERT_TRUE(hit);
            const glm::vec3 expected = glm::vec3(2.0F) + camera.eye + hit->distance * direction;
            // A pixel is 0.03 wide at distance 1, and the walls are seen as obliquely as 1 : 4 from up to 2
            // m.
            for (int c = 0; c < 3; ++c) EXPECT_NEAR(image.at(x, y)[c], expected[c], 0.05F) << x << ", " << y;
        }
    }
}

TEST(RenderBaked, DoesNotDependOnThreads) {
    const Scene scene = test::boxScene({test::Front});
    const PatchMesh mesh = test::gridMesh(scene, 4);
    const BakedMesh baked = test::bakedWith(scene, mesh, [](auto& p, auto&) { return glm::vec3(1.0F) + p * p; });
    const Camera camera = lookAtCamera({0, 0, 4}, {0, 0, 0}, {0, 1, 0}, 50.0F);
    const RenderOptions options = sized(50, 50);
    setThreadCount(1);
    const Image one = picture(scene, mesh, baked, camera, options);
    setThreadCount(4);
    const Image four = picture(scene, mesh, baked, camera, options);
    setThreadCount(0);
    EXPECT_EQ(one.pixels, four.pixels);
}

TEST(RenderBaked, SeedMovesTheSamples) {
    const Scene scene = test::boxScene({test::Front});
    const PatchMesh mesh = test::gridMesh(scene, 2);
    const BakedMesh baked = test::bakedWith(scene, mesh, [](auto& p, auto&) { return glm::vec3(1.0F) + p * p; });
    const Camera camera = lookAtCamera({0, 0, 4}, {0, 0, 0}, {0, 1, 0}, 50.0F);
    RenderOptions options = sized(20, 20);
    const Image first = picture(scene, mesh, baked, camera, options);
    options.seed = 1;
    EXPECT_NE(first.pixels, picture(scene, mesh, baked, camera, options).pixels);
}

/// A wall at z = -1 whose front shows 1 to +z, seen from both sides; its back, if it has one, shows 3.
class Wall : public testing::Test {
protected:
    Rgb seenFrom(float z, const RenderOptions& options = sized(4, 4)) const {
        const PatchMesh mesh = test::gridMesh(scene_, 2);
        const BakedMesh baked =
            test::bakedWith(scene_, mesh, [](auto&, auto& n) { return Rgb(kPi * (n.z > 0.0F ? 1.0F : 3.0F)); });
        const Camera camera = lookAtCamera({0.1F, 0.1F, z}, {0.1F, 0.1F, -1}, {0, 1, 0}, 10.0F);
        return picture(scene_, mesh, baked, camera, options).at(2, 1);
    }
    Scene scene_ = test::boxScene({test::Left, test::Right, test::Bottom, test::Top, test::Front});
};

constexpr float kRounding = 1e-5F; // sums of 16 samples and of 4 weights

TEST_F(Wall, OfOneSideHasABlackBack) {
    EXPECT_NEAR(seenFrom(2.0F).x, 1.0F, kRounding);
    EXPECT_EQ(seenFrom(-4.0F), Rgb(0.0F));
}

TEST_F(Wall, OfTwoSidesShowsEach) {
    for (Polygon& polygon : scene_.polygons) polygon.backMaterial = polygon.material;
    EXPECT_NEAR(seenFrom(2.0F).x, 1.0F, kRounding);
    EXPECT_NEAR(seenFrom(-4.0F).x, 3.0F, kRounding);
}

TEST_F(Wall, ShowsIrradianceUnlessItEmits) {
    RenderOptions options = sized(4, 4);
    options.quantity = Quantity::Irradiance;
    EXPECT_NEAR(seenFrom(2.0F, options).x, 2.0F, kRounding);
    scene_.materials[0].emittedRadiance = Rgb(0.5F);
    EXPECT_NEAR(seenFrom(2.0F, options).x, 1.0F, kRounding);
}

TEST_F(Wall, StandsBeforeTheSky) {
    scene_.environment = std::make_shared<Environment>(Environment::constant(Rgb(0.25F, 0.5F, 2.0F)));
    const PatchMesh mesh = test::gridMesh(scene_, 1);
    const BakedMesh baked = test::bakedWith(scene_, mesh, [](auto&, auto&) { return Rgb(kPi); });
    const Camera camera = lookAtCamera({0, 0, 3}, {0, 0, -1}, {0, 1, 0}, 90.0F);
    const Image image = picture(scene_, mesh, baked, camera, sized(64, 64));
    EXPECT_EQ(image.at(0, 0), Rgb(0.25F, 0.5F, 2.0F));
    EXPECT_NEAR(image.at(32, 32).x, 1.0F, kRounding);
}

TEST_F(Wall, StandsBeforeTheBackground) {
    RenderOptions options = sized(64, 64);
    options.background = Rgb(0.0F, 0.25F, 0.5F);
    const PatchMesh mesh = test::gridMesh(scene_, 1);
    const BakedMesh baked = test::bakedWith(scene_, mesh, [](auto&, auto&) { return Rgb(kPi); });
    const Camera camera = lookAtCamera({0, 0, 3}, {0, 0, -1}, {0, 1, 0}, 90.0F);
    const Image image = picture(scene_, mesh, baked, camera, options);
    EXPECT_EQ(image.at(0, 0), options.background);
    EXPECT_NEAR(image.at(32, 32).x, 1.0F, kRounding);
    // The wall fills a quarter of the picture's width and of its height. Each of its four edges is
    // resolved to 1/16 of a pixel.
    float covered = 0.0F;
    for (const Rgb& pixel : image.pixels) covered += pixel.x;
    EXPECT_NEAR(covered, 16.0F * 16.0F, 4.0F * 16.0F / 16.0F);
}

TEST_F(Wall, IsToneMappedBeforePixelsAreAveraged) {
    RenderOptions options = sized(33, 33);
    options.toneMapExposure = 6.0F;
    const PatchMesh mesh = test::gridMesh(scene_, 1);
    const BakedMesh baked = test::bakedWith(scene_, mesh, [](auto&, auto&) { return Rgb(kPi); });
    const Camera camera = lookAtCamera({0, 0, 3}, {0, 0, -1}, {0, 1, 0}, 90.0F);
    const Image image = picture(scene_, mesh, baked, camera, options);
    EXPECT_EQ(image.content, PixelContent::Display);
    const float wall = toneMap(Rgb(1.0F), 6.0F).x;
    bool edge = false;
    for (const Rgb& pixel : image.pixels) {
        EXPECT_LE(pixel.x, wall + kRounding);
        // A pixel that is half covered shows half the wall's colour, however bright the wall.
        edge = edge || (pixel.x > 0.3F * wall && pixel.x < 0.7F * wall);
    }
    EXPECT_TRUE(edge);
}

TEST_F(Wall, IsNotRenderedWithoutPixelsOrSamples) {
    EXPECT_THROW(seenFrom(2.0F, sized(0, 4)), UsageError);
    EXPECT_THROW(seenFrom(2.0F, sized(4, -1)), UsageError);
    RenderOptions options = sized(4, 4);
    options.samplesPerAxis = 0;
    EXPECT_THROW(seenFrom(2.0F, options), UsageError);
}

} // namespace
} // namespace lambert
