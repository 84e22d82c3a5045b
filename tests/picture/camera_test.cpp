#include "picture/camera_rays.h"

#include "core/error.h"

#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <glm/vec2.hpp>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace lambert {
namespace {

constexpr float kRounding = 1e-6F; // unit vectors in float

void expectNear(const glm::vec3& found, const glm::vec3& expected) {
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(found[c], expected[c], kRounding);
}

TEST(CameraRays, MeetTheCornersOfThePicture) {
    const Camera camera = lookAtCamera({1, 2, 3}, {1, 2, -5}, {0, 1, 0}, 90.0F);
    const CameraRays rays(camera, 200, 100);
    // Half the height is tan 45° = 1 at distance 1, half the width twice that.
    expectNear(rays.direction(0, 0), {-2, 1, -1});
    expectNear(rays.direction(200, 0), {2, 1, -1});
    expectNear(rays.direction(0, 100), {-2, -1, -1});
    expectNear(rays.direction(200, 100), {2, -1, -1});
    expectNear(rays.direction(100, 50), {0, 0, -1});
    expectNear(rays.direction(0.5F, 0.5F), {-1.99F, 0.99F, -1});
}

TEST(CameraRays, HaveSquarePixels) {
    const Camera camera = lookAtCamera({3, 1, 2}, {0, 0.5F, 0}, {0.1F, 1, 0}, 35.0F);
    for (const glm::ivec2& size : {glm::ivec2(64, 64), glm::ivec2(160, 90), glm::ivec2(30, 200)}) {
        const CameraRays rays(camera, size.x, size.y);
        const glm::vec3 x = rays.direction(1, 0) - rays.direction(0, 0);
        const glm::vec3 y = rays.direction(0, 1) - rays.direction(0, 0);
        EXPECT_NEAR(glm::length(x), glm::length(y), kRounding);
        EXPECT_NEAR(glm::dot(x, y), 0.0F, kRounding);
        EXPECT_NEAR(glm::length(y) * static_cast<float>(size.y), 2.0F * std::tan(glm::radians(17.5F)), 1e-5F);
    }
}

TEST(CameraRays, DoNotNeedUpAcrossTheView) {
    const CameraRays rays(lookAtCamera({0, 0, 0}, {0, -1, -1}, {0, 5, 0}, 60.0F), 10, 10);
    const glm::vec3 upward = rays.direction(5, 0) - rays.direction(5, 5);
    EXPECT_NEAR(glm::dot(upward, rays.direction(5, 5)), 0.0F, kRounding);
    EXPECT_GT(upward.y, 0.0F);
    EXPECT_NEAR(upward.x, 0.0F, kRounding);
}

TEST(LookAtCamera, RefusesWhatHasNoView) {
    const glm::vec3 up(0, 1, 0);
    const float infinity = std::numeric_limits<float>::infinity();
    EXPECT_THROW(lookAtCamera({1, 2, 3}, {1, 2, 3}, up, 45.0F), UsageError);
    EXPECT_THROW(lookAtCamera({0, 0, 0}, {0, -3, 0}, up, 45.0F), UsageError);
    EXPECT_THROW(lookAtCamera({0, 0, 0}, {0, 0, 1}, {0, 0, 0}, 45.0F), UsageError);
    EXPECT_THROW(lookAtCamera({0, 0, 0}, {0, 0, 1}, up, 0.0F), UsageError);
    EXPECT_THROW(lookAtCamera({0, 0, 0}, {0, 0, 1}, up, 180.0F), UsageError);
    EXPECT_THROW(lookAtCamera({0, 0, 0}, {0, 0, 1}, up, std::nanf("")), UsageError);
    EXPECT_THROW(lookAtCamera({infinity, 0, 0}, {0, 0, 1}, up, 45.0F), UsageError);
}

TEST(LookAtCamera, WorksAtAnyScale) {
    for (const float scale : {1e-20F, 1e-8F, 1e8F, 1e30F}) {
        const Camera camera = lookAtCamera(glm::vec3(0), scale * glm::vec3(3, 0, 4), scale * glm::vec3(0, 1, 0), 45);
        expectNear(camera.direction, {0.6F, 0.0F, 0.8F});
        expectNear(camera.up, {0, 1, 0});
    }
}

} // namespace
} // namespace lambert
