#include "rendering/default_camera.h"

#include "scene/example_scenes.h"
#include "tests/rendering/box_scene.h"

#include <glm/trigonometric.hpp>
#include <gtest/gtest.h>

#include <cmath>
#include <utility>

namespace lambert {
namespace {

Camera cameraOf(const Scene& scene, float aspect = 1.0F) {
    const RayCaster caster(scene);
    return defaultCamera(scene, caster, aspect);
}

void expectWholeBoxInPicture(const Scene& scene, const Camera& camera, float aspect) {
    const Bounds bounds = boundsOf(scene);
    const glm::vec3 right = glm::normalize(glm::cross(camera.direction, camera.up));
    const glm::vec3 up = glm::cross(right, camera.direction);
    const float tangent = std::tan(0.5F * camera.verticalFov);
    float largest = 0.0F;
    for (int k = 0; k < 8; ++k) {
        const glm::vec3 corner((k & 1) != 0 ? bounds.upper.x : bounds.lower.x,
                               (k & 2) != 0 ? bounds.upper.y : bounds.lower.y,
                               (k & 4) != 0 ? bounds.upper.z : bounds.lower.z);
        const glm::vec3 d = corner - camera.eye;
        const float depth = glm::dot(d, camera.direction);
        EXPECT_GT(depth, 0.0F);
        largest = std::max(largest, std::abs(glm::dot(d, up)) / (depth * tangent));
        largest = std::max(largest, std::abs(glm::dot(d, right)) / (depth * tangent * aspect));
    }
    EXPECT_LE(largest, 1.0F);
    EXPECT_GT(largest, 0.9F); // and not much smaller than the picture
}

TEST(DefaultCamera, StandsOnTheOpenSideOfABox) {
    const std::vector<std::pair<test::Side, glm::vec3>> sides{{test::Left, {-1, 0, 0}}, {test::Right, {1, 0, 0}},
                                                              {test::Front, {0, 0, 1}}, {test::Back, {0, 0, -1}},
                                                              {test::Top, {0, 1, 0}},   {test::Bottom, {0, -1, 0}}};
    for (const auto& [side, axis] : sides) {
        const Scene scene = test::boxScene({side});
        const Camera camera = cameraOf(scene);
        EXPECT_GT(glm::dot(camera.eye, axis), 2.0F) << "side " << side;
        EXPECT_GT(glm::dot(camera.direction, -axis), 0.999F);
        expectWholeBoxInPicture(scene, camera, 1.0F);
    }
}

TEST(DefaultCamera, FitsAnyAspect) {
    Scene scene = test::boxScene({test::Front});
    for (glm::vec3& p : scene.positions) p = glm::vec3(10, 20, 30) + p * glm::vec3(5.0F, 1.0F, 2.0F);
    for (const float aspect : {0.5F, 1.0F, 16.0F / 9.0F})
        expectWholeBoxInPicture(scene, cameraOf(scene, aspect), aspect);
}

TEST(DefaultCamera, PrefersTheSideThatShowsFronts) {
    // Open to the front and to the back; the only wall shows its front to the back.
    Scene scene = test::boxScene({test::Left, test::Right, test::Bottom, test::Top, test::Back});
    const Camera camera = cameraOf(scene);
    EXPECT_LT(camera.eye.z, scene.positions[4].z);
    EXPECT_GT(camera.direction.z, 0.5F);
}

TEST(DefaultCamera, LooksDownOnAFloor) {
    const Scene scene = test::boxScene({test::Left, test::Right, test::Top, test::Back, test::Front});
    const Camera camera = cameraOf(scene);
    EXPECT_GT(camera.eye.y, -1.0F);
    EXPECT_LT(camera.direction.y, -0.4F);
}

TEST(DefaultCamera, IsInsideAClosedBoxAndSeesItsFar) {
    for (const float scale : {1e-3F, 1.0F, 1e4F}) {
        Scene scene = test::boxScene();
        for (glm::vec3& p : scene.positions) p *= scale;
        const Camera camera = cameraOf(scene);
        for (int c = 0; c < 3; ++c) EXPECT_LT(std::abs(camera.eye[c]), scale);
        EXPECT_GT(std::abs(camera.eye.x), 0.8F * scale);
        EXPECT_GT(std::abs(camera.eye.z), 0.8F * scale);
        EXPECT_NEAR(glm::length(glm::cross(camera.direction, glm::normalize(-camera.eye))), 0.0F, 1e-5F);
        EXPECT_NEAR(camera.verticalFov, glm::radians(65.0F), 1e-5F);
    }
}

// The box around an L-shaped room reaches beyond its walls, so that most rays from its middle leave it.
TEST(DefaultCamera, IsInsideARoomThatIsNoBox) {
    using Quad = std::array<glm::vec3, 4>;
    const auto wall = [](glm::vec3 a, glm::vec3 b) {
        return Quad{a, b, b + glm::vec3(0, 2.5F, 0), a + glm::vec3(0, 2.5F, 0)};
    };
    std::vector<Quad> quads{{glm::vec3(0, 0, 5), {2, 0, 5}, {2, 0, 0}, {0, 0, 0}},
                            {glm::vec3(2, 0, 2), {6, 0, 2}, {6, 0, 0}, {2, 0, 0}},
                            {glm::vec3(0, 2.5F, 0), {2, 2.5F, 0}, {2, 2.5F, 5}, {0, 2.5F, 5}},
                            {glm::vec3(2, 2.5F, 0), {6, 2.5F, 0}, {6, 2.5F, 2}, {2, 2.5F, 2}},
                            wall({0, 0, 0}, {6, 0, 0}),
                            wall({6, 0, 0}, {6, 0, 2}),
                            wall({6, 0, 2}, {2, 0, 2}),
                            wall({2, 0, 2}, {2, 0, 5}),
                            wall({2, 0, 5}, {0, 0, 5}),
                            wall({0, 0, 5}, {0, 0, 0})};
    const std::vector<Material> materials(quads.size());
    const Scene scene = quadScene(quads, materials);
    const RayCaster caster(scene);
    const Camera camera = defaultCamera(scene, caster, 1.0F);
    const auto hit = caster.closest(Ray{camera.eye, camera.direction});
    ASSERT_TRUE(hit);
    EXPECT_TRUE(hit->front);
    EXPECT_TRUE(camera.eye.x < 2.0F || camera.eye.z < 2.0F) << camera.eye.x << " " << camera.eye.z;
}

TEST(DefaultCamera, ExistsForEveryScene) {
    const Camera empty = cameraOf(Scene{});
    EXPECT_NEAR(glm::length(empty.direction), 1.0F, 1e-6F);
    Scene outside = test::boxScene(); // fronts outside: closed, black inside
    for (Polygon& polygon : outside.polygons) std::swap(polygon.vertices[1], polygon.vertices[3]);
    const Camera camera = cameraOf(outside);
    EXPECT_TRUE(std::isfinite(camera.eye.x));
}

} // namespace
} // namespace lambert
