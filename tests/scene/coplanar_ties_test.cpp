#include "scene/coplanar_pairs.h"
#include "scene/example_scenes.h"
#include "scene/rays/ray_caster.h"
#include "tests/scene/grid_scene.h"

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <random>
#include <string>
#include <vector>

namespace lambert {
namespace {

using Quad = std::array<glm::vec3, 4>;

Quad rectangle(float x0, float y0, float x1, float y1, bool up = true) {
    Quad quad{{{x0, y0, 0}, {x1, y0, 0}, {x1, y1, 0}, {x0, y1, 0}}};
    if (!up) std::reverse(quad.begin(), quad.end());
    return quad;
}

enum Face : std::uint32_t { kUp, kDown, kLamp };

/// Faces in the plane z = 0, which need not lie along axes: the plane is turned.
struct Sheets {
    explicit Sheets(const std::vector<std::pair<Quad, std::uint32_t>>& quads) {
        scene.materials = {greyMaterial("up", 0.5F), greyMaterial("down", 0.5F), greyMaterial("lamp", 0.5F, 1.0F)};
        scene.nodes = {"sheets"};
        for (const auto& [quad, material] : quads) {
            Quad placed = quad;
            for (glm::vec3& p : placed) p = place(p);
            addQuad(scene, placed, material);
        }
    }

    static glm::vec3 place(const glm::vec3& p) { return glm::vec3(turned(glm::dvec3(p))); }

    /// The material that rays through a point see from above or below, and whether its front; by single rays and by packets.
    std::pair<std::uint32_t, bool> seen(glm::vec2 point, bool fromAbove, glm::vec2 slant) const {
        const RayCaster rays(scene);
        const glm::vec3 to = place({point, 0.0F});
        const glm::vec3 from = place({point + slant, fromAbove ? 1.0F : -1.0F});
        const auto hit = rays.closest({from, to - from});
        RayPacket packet;
        for (int lane = 0; lane < RayPacket::kSize; ++lane) {
            const glm::vec3 direction = to - from;
            packet.directionX[lane] = direction.x;
            packet.directionY[lane] = direction.y;
            packet.directionZ[lane] = direction.z;
            packet.active[lane] = lane % 2 == 0 ? -1 : 0;
        }
        rays.closest(from, packet);
        EXPECT_TRUE(hit.has_value());
        if (!hit) return {kNone, false};
        EXPECT_EQ(packet.polygon[0], hit->polygon);
        EXPECT_EQ(packet.facing[0] < 0.0F, hit->front);
        // To the rounding of the origin and the corners.
        EXPECT_LT(glm::distance(polygonPoint(scene, hit->polygon, hit->u, hit->v), to), 2e-6F);
        EXPECT_LT(glm::distance(polygonPoint(scene, packet.polygon[0], packet.u[0], packet.v[0]), to), 2e-6F);
        return {scene.polygons[hit->polygon].material, hit->front};
    }

    Scene scene;
};

TEST(CoplanarTies, OfTwoBackToBackARayMeetsTheFrontHoweverTheyAreCut) {
    const std::pair up{rectangle(0, 0, 2, 2), std::uint32_t{kUp}};
    const std::pair left{rectangle(-1, -1, 0.7F, 2, false), std::uint32_t{kDown}};
    const std::pair right{rectangle(0.7F, -1, 3, 2, false), std::uint32_t{kDown}};
    std::mt19937 random(7);
    std::uniform_real_distribution<float> place(0.01F, 1.99F), slant(-1.0F, 1.0F);
    for (const auto& order : {std::vector{up, left, right}, {left, up, right}, {left, right, up}}) {
        const Sheets sheets(order);
        for (int k = 0; k < 50; ++k) {
            const glm::vec2 point(place(random), place(random));
            const glm::vec2 from(slant(random), slant(random));
            EXPECT_EQ(sheets.seen(point, true, from), std::pair(std::uint32_t{kUp}, true));
            EXPECT_EQ(sheets.seen(point, false, from), std::pair(std::uint32_t{kDown}, true));
        }
        EXPECT_EQ(sheets.seen({-0.5F, 1.0F}, true, {0.1F, 0.2F}), std::pair(std::uint32_t{kDown}, false));
    }
}

TEST(CoplanarTies, OfTwoThatFaceTheSameWayTheEmitterIsMetOrTheLater) {
    const std::pair floor{rectangle(0, 0, 4, 4), std::uint32_t{kUp}};
    const std::pair rug{rectangle(1, 1, 3, 3), std::uint32_t{kDown}};
    const std::pair lamp{rectangle(2, 1, 3.5F, 3), std::uint32_t{kLamp}};
    const Sheets sheets({lamp, floor, rug});
    EXPECT_EQ(sheets.seen({0.5F, 0.5F}, true, {0.1F, 0.2F}).first, kUp);
    EXPECT_EQ(sheets.seen({1.5F, 1.5F}, true, {0.1F, 0.2F}).first, kDown);
    EXPECT_EQ(sheets.seen({2.5F, 1.5F}, true, {0.1F, 0.2F}).first, kLamp);
    EXPECT_EQ(sheets.seen({3.25F, 1.5F}, true, {0.1F, 0.2F}).first, kLamp);
    EXPECT_FALSE(sheets.seen({2.5F, 1.5F}, false, {0.1F, 0.2F}).second);
}

TEST(CoplanarPairs, AreThoseThatOverlapAndNotThoseThatTouch) {
    const Sheets sheets({{rectangle(0, 0, 2, 2), kUp},
                         {rectangle(2, 0, 4, 2), kUp},
                         {rectangle(1, 1, 3, 3, false), kDown},
                         {rectangle(0, 2, 1, 3), kUp}});
    const auto pairs = coplanarPairs(sheets.scene, 1e-5F);
    ASSERT_EQ(pairs.size(), 2U);
    EXPECT_EQ(pairs[0].one, 0U);
    EXPECT_EQ(pairs[0].two, 2U);
    EXPECT_FALSE(pairs[0].sameFacing);
    EXPECT_EQ(pairs[1].one, 1U);
    EXPECT_EQ(pairs[1].two, 2U);
}

} // namespace
} // namespace lambert
