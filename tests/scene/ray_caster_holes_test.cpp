#include "core/random.h"
#include "scene/example_scenes.h"
#include "scene/rays/ray_caster.h"

#include <gtest/gtest.h>

namespace lambert {
namespace {

/// Opaque where x + y is even.
std::shared_ptr<const Texture> checker(int size) {
    std::vector<std::uint8_t> rgba;
    for (int y = 0; y < size; ++y)
        for (int x = 0; x < size; ++x)
            rgba.insert(rgba.end(), {255, 255, 255, static_cast<std::uint8_t>((x + y) % 2 == 0 ? 255 : 0)});
    return std::make_shared<Texture>("checker", size, size, std::move(rgba));
}

/// A floor at z = 0, a sheet with holes at z = 1 of which the texture shows twice along x, and one of the same at z = 2
/// as two triangles; all over [0, 1]², seen from above.
class Sheets : public testing::Test {
protected:
    Sheets() {
        const auto quad = [](float z) {
            return std::array<glm::vec3, 4>{{{0, 0, z}, {1, 0, z}, {1, 1, z}, {0, 1, z}}};
        };
        const std::array quads{quad(0), quad(1), quad(2)};
        scene = quadScene(quads, std::array{greyMaterial("floor", 0.5F), leaf(), leaf()});
        scene.textures.push_back(checker(4));
        SurfaceCorners corners;
        corners.uv = {{{0, 0}, {2, 0}, {2, 1}, {0, 1}}};
        scene.surfaces.push_back(corners);
        corners.uv = {{{0, 0}, {2, 0}, {2, 1}, {}}};
        scene.surfaces.push_back(corners);
        corners.uv = {{{0, 0}, {2, 1}, {0, 1}, {}}};
        scene.surfaces.push_back(corners);
        scene.polygons[1].surface = 0;
        Polygon& half = scene.polygons[2];
        scene.polygons.push_back(half);
        half.surface = 1;
        scene.polygons[2].vertices[3] = kNone;
        Polygon& other = scene.polygons[3];
        other.surface = 2;
        other.vertices = {other.vertices[0], other.vertices[2], other.vertices[3], kNone};
    }
    static Material leaf() {
        Material material = greyMaterial("leaf", 0.5F);
        material.opacityTexture.texture = 0;
        material.opacityCutoff = 0.5F;
        return material;
    }
    static bool opaqueAt(float x, float y) {
        return (static_cast<int>(8.0F * x) + static_cast<int>(4.0F * y)) % 2 == 0;
    }
    Scene scene;
};

TEST_F(Sheets, LetRaysThroughExactlyWhereTheTexelIsClear) {
    const RayCaster caster(scene);
    for (int i = 0; i < 40; ++i)
        for (int j = 0; j < 40; ++j) {
            const float x = (static_cast<float>(i) + 0.4F) / 40.0F; // not on the diagonal
            const float y = (static_cast<float>(j) + 0.5F) / 40.0F;
            const bool above = y > x; // of the diagonal
            const std::uint32_t expectedFromAbove = opaqueAt(x, y) ? (above ? 3U : 2U) : 0U;
            const auto down = caster.closest({{x, y, 3}, {0, 0, -1}});
            ASSERT_TRUE(down);
            ASSERT_EQ(down->polygon, expectedFromAbove) << x << " " << y;
            ASSERT_TRUE(down->front);
            const auto up = caster.closest({{x, y, 0.5F}, {0, 0, 1}});
            ASSERT_EQ(up.has_value(), opaqueAt(x, y));
            ASSERT_EQ(up ? up->polygon : 1U, 1U);
            ASSERT_EQ(caster.occluded({{x, y, 3}, {0, 0, -1}, 2.5F}), opaqueAt(x, y));
        }
}

TEST_F(Sheets, StopPacketsLikeSingleRays) {
    const RayCaster caster(scene);
    const glm::vec3 origin(0.47F, 0.52F, 2.6F);
    for (int row = 0; row < 32; ++row) {
        RayPacket packet;
        for (int lane = 0; lane < RayPacket::kSize; ++lane) {
            packet.directionX[lane] = -0.5F + static_cast<float>(lane) / 16.0F;
            packet.directionY[lane] = -0.5F + static_cast<float>(row) / 32.0F;
            packet.directionZ[lane] = -1.0F;
            packet.active[lane] = lane % 5 == 4 ? 0 : -1;
        }
        caster.closest(origin, packet);
        for (int lane = 0; lane < RayPacket::kSize; ++lane) {
            const glm::vec3 direction(packet.directionX[lane], packet.directionY[lane], packet.directionZ[lane]);
            const auto hit = caster.closest({origin, direction});
            const bool traced = packet.active[lane] != 0 && hit.has_value();
            ASSERT_EQ(packet.polygon[lane], traced ? hit->polygon : kNone);
        }
    }
}

TEST_F(Sheets, WithoutTextureCoordinatesHaveNoHoles) {
    for (Polygon& polygon : scene.polygons) polygon.surface = kNone;
    const RayCaster caster(scene);
    EXPECT_EQ(caster.closest({{0.3F, 0.1F, 1.5F}, {0, 0, -1}})->polygon, 1U);
}

TEST_F(Sheets, APacketOfShadowRaysFindsWhatSingleRaysFind) {
    const RayCaster caster(scene);
    int free = 0;
    for (int k = 0; k < 200; ++k) {
        ShadowPacket packet;
        Ray rays[ShadowPacket::kSize];
        for (int lane = 0; lane < ShadowPacket::kSize; ++lane) {
            const auto bits = philox({static_cast<std::uint32_t>(k), static_cast<std::uint32_t>(lane), 0, 0}, 1);
            Ray& ray = rays[lane];
            ray.origin = {uniformFloat(bits[0]), uniformFloat(bits[1]), 0.1F};
            ray.direction = {uniformFloat(bits[2]) - 0.5F, 0.3F, 1.0F};
            ray.maxDistance = 3.0F * uniformFloat(bits[3]);
            packet.originX[lane] = ray.origin.x;
            packet.originY[lane] = ray.origin.y;
            packet.originZ[lane] = ray.origin.z;
            packet.directionX[lane] = ray.direction.x;
            packet.directionY[lane] = ray.direction.y;
            packet.directionZ[lane] = ray.direction.z;
            packet.maxDistance[lane] = ray.maxDistance;
            packet.active[lane] = lane == 3 ? 0 : -1;
        }
        caster.occluded(packet);
        for (int lane = 0; lane < ShadowPacket::kSize; ++lane) {
            ASSERT_EQ(packet.occluded[lane], lane != 3 && caster.occluded(rays[lane]));
            free += packet.occluded[lane] ? 0 : 1;
        }
    }
    EXPECT_GT(free, 400);
    EXPECT_LT(free, 2800); // both answers occur
}

} // namespace
} // namespace lambert
