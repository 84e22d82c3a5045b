#include "scene/rays/line_caster.h"

#include "core/random.h"
#include "core/warps.h"
#include "scene/example_scenes.h"
#include "scene/rays/ray_caster.h"
#include "scene/reading/scene_reader.h"

#include <gtest/gtest.h>

#include <glm/geometric.hpp>

#include <cmath>
#include <numbers>

namespace lambert {
namespace {

struct Line {
    glm::vec3 origin, direction;
};

double number(std::uint32_t index, std::uint32_t dimension) {
    return (philox({index, dimension, 0, 0}, 7)[0] + 0.5) * 0x1p-32;
}

/// The chord number `index` of the sphere around a scene.
Line chord(const Bounds& bounds, std::uint32_t index) {
    const glm::vec3 centre = 0.5F * (bounds.lower + bounds.upper);
    const float radius = 0.5001F * bounds.diagonal();
    const glm::vec3 a(uniformSphere({number(index, 0), number(index, 1)}));
    const glm::vec3 b(uniformSphere({number(index, 2), number(index, 3)}));
    return {centre + radius * a, radius * (b - a)};
}

std::vector<Crossing> crossingsOf(const LineCaster& caster, const Line& line) {
    LinePacket packet{};
    for (int lane = 0; lane < LinePacket::kSize; ++lane) {
        packet.originX[lane] = line.origin.x;
        packet.originY[lane] = line.origin.y;
        packet.originZ[lane] = line.origin.z;
        packet.directionX[lane] = line.direction.x;
        packet.directionY[lane] = line.direction.y;
        packet.directionZ[lane] = line.direction.z;
        packet.active[lane] = lane % 2 == 0 ? -1 : 0;
    }
    LineCrossings crossings;
    caster.cross(packet, crossings);
    for (int lane = 1; lane < LinePacket::kSize; ++lane) {
        EXPECT_EQ(crossings.count(lane), lane % 2 == 0 ? crossings.count(0) : 0U);
        EXPECT_EQ(crossings.of(lane).size(), crossings.count(lane));
    }
    return crossings.of(0);
}

/// The same from hit to hit, each time from a little farther on.
std::vector<Hit> hitByHit(const RayCaster& caster, const Line& line, float step) {
    std::vector<Hit> hits;
    float distance = 0.0F;
    while (const auto hit =
               caster.closest({line.origin + distance * line.direction, line.direction, 1.0F - distance})) {
        hits.push_back(*hit);
        hits.back().distance += distance;
        distance = hits.back().distance + step;
        if (distance >= 1.0F) break;
    }
    return hits;
}

/// A floor, a sheet of eight by four squares of which every second is a hole, and an occluder, one above the other.
Scene sheets() {
    const auto quad = [](float z) { return std::array<glm::vec3, 4>{{{0, 0, z}, {1, 0, z}, {1, 1, z}, {0, 1, z}}}; };
    Material leaf = greyMaterial("leaf", 0.5F);
    leaf.opacityTexture.texture = 0;
    leaf.opacityCutoff = 0.5F;
    Material shutter = greyMaterial("shutter", 0.0F);
    shutter.occluder = true;
    Scene scene =
        quadScene(std::array{quad(0), quad(1), quad(2)}, std::array{greyMaterial("floor", 0.5F), leaf, shutter});
    std::vector<std::uint8_t> rgba;
    for (int y = 0; y < 4; ++y)
        for (int x = 0; x < 8; ++x)
            rgba.insert(rgba.end(), {255, 255, 255, static_cast<std::uint8_t>((x + y) % 2 == 0 ? 255 : 0)});
    scene.textures.push_back(std::make_shared<Texture>("checker", 8, 4, std::move(rgba)));
    SurfaceCorners corners;
    corners.uv = {{{0, 0}, {1, 0}, {1, 1}, {0, 1}}};
    scene.surfaces.push_back(corners);
    scene.polygons[1].surface = 0;
    return scene;
}

// Crossings that lie closer together than the plain way's step are not compared: one line in thirty.
TEST(LineCaster, FindsWhatTheRayCasterFindsHitByHit) {
    constexpr float kStep = 1e-4F;
    for (const Scene& scene : {readScene(LAMBERT_DATA "/table_room.gltf").scene, sheets(), roomWithBoxScene()}) {
        const RayCaster rays(scene);
        const LineCaster caster(scene);
        std::size_t compared = 0;
        std::size_t met = 0;
        for (std::uint32_t i = 0; i < 20'000; ++i) {
            const Line line = chord(rays.bounds(), i);
            const std::vector<Crossing> crossings = crossingsOf(caster, line);
            bool close = false;
            for (std::size_t k = 1; k < crossings.size(); ++k)
                close |= crossings[k].distance - crossings[k - 1].distance < 3.0F * kStep;
            if (close) continue;
            const std::vector<Hit> hits = hitByHit(rays, line, kStep);
            ASSERT_EQ(crossings.size(), hits.size()) << "line " << i;
            ++compared;
            for (std::size_t k = 0; k < hits.size(); ++k) {
                ASSERT_EQ(crossings[k].polygon, hits[k].polygon);
                ASSERT_EQ(crossings[k].front && !isOccluder(scene, scene.polygons[hits[k].polygon]), hits[k].front);
                ASSERT_NEAR(crossings[k].distance, hits[k].distance, 1e-5F);
                ASSERT_NEAR(crossings[k].u, hits[k].u, 1e-3F);
                ASSERT_NEAR(crossings[k].v, hits[k].v, 1e-3F);
                ++met;
            }
        }
        EXPECT_GT(compared, 19'000U);
        EXPECT_GT(met, 5'000U);
    }
}

// A patch is crossed with probability A / (2πR²); of a checkered sheet that is half its area. Five standard deviations.
TEST(LineCaster, HolesAreNotCrossed) {
    const Scene scene = sheets();
    const LineCaster caster(scene);
    constexpr std::uint32_t kLines = 100'000;
    std::array<int, 3> crossed{};
    for (std::uint32_t i = 0; i < kLines; ++i)
        for (const Crossing& crossing : crossingsOf(caster, chord(caster.bounds(), i))) {
            ++crossed[crossing.polygon];
            const int cell = static_cast<int>(8.0F * crossing.u) + static_cast<int>(4.0F * crossing.v);
            ASSERT_TRUE(crossing.polygon != 1 || cell % 2 == 0);
        }
    const double radius = 0.5001 * static_cast<double>(caster.bounds().diagonal());
    for (std::size_t k = 0; k < 3; ++k) {
        const double p = (k == 1 ? 0.5 : 1.0) / (2.0 * std::numbers::pi * radius * radius);
        EXPECT_NEAR(crossed[k], p * kLines, 5.0 * std::sqrt(p * (1.0 - p) * kLines)) << k;
    }
}

/// Whether a line enters and leaves a closed surface by turns; `inside`: its fronts look inward.
bool alternates(const std::vector<Crossing>& crossings, bool inside) {
    for (std::size_t k = 0; k < crossings.size(); ++k)
        if (crossings[k].front != ((k % 2 == 0) != inside)) return false;
    return crossings.size() % 2 == 0;
}

// Half of the lines are aimed at points of the box's edges, rounded to float: the worst that can happen, which a random line meets
// about once in a million. Embree accepts hits up to a few roundings outside of a polygon, more where it is long, and so of a
// line that passes an edge outside it may find one of both polygons: 1 in 90 of the lines aimed at the cube's edges, 1 in 33 at
// those of the other box enters and does not leave (1 in 20 is allowed). Of the random lines none may.
TEST(LineCaster, LosesAndDoublesNoLineOnEdges) {
    const Material wall = greyMaterial("wall", 0.5F);
    for (const glm::vec3& size : {glm::vec3(1.0F), glm::vec3(3.1F, 0.7F, 1.3F)}) {
        Scene scene = boxScene(size, {wall, wall, wall, wall, wall, wall});
        // Welded, as scenes are prepared.
        for (Polygon& polygon : scene.polygons)
            for (std::uint32_t& v : polygon.vertices)
                v = static_cast<std::uint32_t>(
                    std::find(scene.positions.begin(), scene.positions.end(), scene.positions[v]) -
                    scene.positions.begin());
        for (const bool inside : {true, false}) {
            if (!inside)
                for (Polygon& polygon : scene.polygons) std::swap(polygon.vertices[1], polygon.vertices[3]);
            const LineCaster caster(scene);
            int wrong = 0;
            for (std::uint32_t i = 0; i < 200'000; ++i) {
                Line line = chord(caster.bounds(), i);
                ASSERT_TRUE(alternates(crossingsOf(caster, line), inside)) << "line " << i;
                const Polygon& polygon = scene.polygons[i % 6];
                const int k = static_cast<int>(i / 6 % 4);
                const auto t = static_cast<float>(number(i, 5));
                const glm::vec3 target =
                    (1.0F - t) * corner(scene, polygon, k) + t * corner(scene, polygon, (k + 1) % 4);
                line.direction = 2.0F * (target - line.origin);
                wrong += alternates(crossingsOf(caster, line), inside) ? 0 : 1;
            }
            EXPECT_LT(wrong, 10'000) << "of 200000, inside " << inside;
        }
    }
}

TEST(LineCaster, MeetsFrontsBeforeBacksWhereTheyCoincide) {
    // Two boxes that touch: the walls between them lie in one plane but have no vertices in common.
    const std::array<std::array<glm::vec3, 4>, 2> walls{
        {{{{1, 0, 0}, {1, 1, 0}, {1, 1, 1}, {1, 0, 1}}}, {{{1, -1, -1}, {1, -1, 2}, {1, 2, 2}, {1, 2, -1}}}}};
    for (const bool swapped : {false, true}) {
        const Material wall = greyMaterial("wall", 0.5F);
        const Scene scene =
            quadScene(std::array{walls[swapped ? 1 : 0], walls[swapped ? 0 : 1]}, std::array{wall, wall});
        const LineCaster caster(scene);
        for (std::uint32_t i = 0; i < 2'000; ++i) {
            const auto y = static_cast<float>(number(i, 0));
            const auto z = static_cast<float>(number(i, 1));
            const glm::vec3 origin(i % 2 == 0 ? -1 : 3, static_cast<float>(number(i, 2)),
                                   static_cast<float>(number(i, 3)));
            const auto crossings = crossingsOf(caster, {origin, 2.0F * (glm::vec3(1, y, z) - origin)});
            ASSERT_EQ(crossings.size(), 2U);
            ASSERT_TRUE(crossings[0].front);
            ASSERT_FALSE(crossings[1].front);
        }
    }
}

TEST(LineCaster, CountsCoincidentPolygonsOnce) {
    const std::array<glm::vec3, 4> low{{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}};
    const std::array<glm::vec3, 4> wide{{{-1, -1, 0}, {2, -1, 0}, {2, 2, 0}, {-1, 2, 0}}};
    const Material wall = greyMaterial("wall", 0.5F);
    const Scene scene = quadScene(std::array{low, wide}, std::array{wall, wall});
    const LineCaster caster(scene);
    for (std::uint32_t i = 0; i < 2'000; ++i) ASSERT_LE(crossingsOf(caster, chord(caster.bounds(), i)).size(), 1U);
}

} // namespace
} // namespace lambert
