#include "core/random.h"
#include "formfactors/block_cover.h"
#include "meshing/prepare.h"
#include "scene/example_scenes.h"
#include "scene/reading/scene_reader.h"

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>

namespace lambert {
namespace {

constexpr int kViews = 60;

struct Found {
    std::size_t covered = 0, pixels = 0;
};

/// Every ray of a covered block, traced: it must meet the block's polygon, at the same place of its chart, on the same side.
/// Views stand above random points of the scene's polygons, turned at random.
Found compareWithRays(const Scene& input, int resolution, const std::string& name) {
    const Scene scene = prepareScene(input);
    const RayCaster rays(scene);
    Found found;
    for (std::uint32_t view = 0; view < kViews; ++view) {
        const auto bits = philox({view, 0, 0, 0}, 7);
        const auto uniform = [&](int k) { return static_cast<float>(bits[static_cast<std::size_t>(k)]) * 0x1p-32F; };
        const auto polygon = static_cast<std::uint32_t>(uniform(0) * static_cast<float>(scene.polygons.size()));
        const Polygon& p = scene.polygons[polygon];
        const glm::vec3 normal = glm::normalize(glm::cross(corner(scene, p, 1) - corner(scene, p, 0),
                                                           corner(scene, p, p.size() - 1) - corner(scene, p, 0)));
        const glm::vec3 point = polygonPoint(scene, polygon, 0.05F + 0.4F * uniform(1), 0.05F + 0.4F * uniform(2));
        const glm::vec3 origin = point + rays.originOffset(1.0F) * normal;
        BlockCover cover(scene, origin);
        for (const HemicubeFace& face :
             hemicubeFaces(normal, 2.0F * std::numbers::pi_v<float> * uniform(3), resolution)) {
            cover.face(face, resolution);
            for (int row = 0; row < face.rows; row += 4) {
                for (int column = 0; column < face.columns; column += 4) {
                    found.pixels += 16;
                    const std::uint32_t expected = cover.polygonAt(column, row);
                    if (expected == kNone) continue;
                    found.covered += 16;
                    RayPacket packet;
                    RayPacket traced;
                    cover.hits(expected, column, row, packet);
                    tileDirections(face, column, row, resolution, traced);
                    rays.closest(origin, traced);
                    for (int lane = 0; lane < RayPacket::kSize; ++lane) {
                        EXPECT_NE(traced.active[lane], 0);
                        EXPECT_EQ(traced.polygon[lane], expected) << name << " view " << view;
                        if (traced.polygon[lane] != expected) return found;
                        EXPECT_EQ(packet.polygon[lane], expected);
                        EXPECT_EQ(traced.facing[lane] < 0.0F, packet.facing[lane] < 0.0F) << name;
                        // Coordinates have 24 bits; a ray that grazes magnifies their rounding by the inverse of a
                        // pixel's angle, at most.
                        const float tolerance = 4e-7F * static_cast<float>(resolution);
                        EXPECT_NEAR(traced.u[lane], packet.u[lane], tolerance) << name;
                        EXPECT_NEAR(traced.v[lane], packet.v[lane], tolerance) << name;
                    }
                }
            }
        }
    }
    return found;
}

double coveredShare(const Scene& scene, int resolution, const std::string& name) {
    const Found found = compareWithRays(scene, resolution, name);
    const double share = static_cast<double>(found.covered) / static_cast<double>(found.pixels);
    ::testing::Test::RecordProperty(name, std::to_string(share));
    return share;
}

Scene file(const std::string& name) { return readScene(LAMBERT_DATA "/" + name).scene; }

TEST(BlockCover, FindsWhatRaysFind) {
    EXPECT_GT(coveredShare(file("furnace_box.obj"), 128, "furnace"), 0.75);
    EXPECT_GT(coveredShare(file("cornell_box.obj"), 128, "cornell"), 0.5);
    EXPECT_GT(coveredShare(file("table_room.obj"), 128, "table"), 0.3);
    EXPECT_GT(coveredShare(file("tetrahedron.obj"), 128, "tetrahedron"), 0.7);
    EXPECT_GT(coveredShare(file("textured_room.obj"), 128, "textured"), 0.0);
    EXPECT_GT(coveredShare(roomWithBoxScene(), 128, "box"), 0.5);
}

TEST(BlockCover, AtAnyResolution) {
    for (const int resolution : {8, 10, 16, 20, 34, 100, 512})
        coveredShare(file("cornell_box.obj"), resolution, "resolution" + std::to_string(resolution));
    EXPECT_EQ(coveredShare(file("cornell_box.obj"), 4, "four"), 0.0);
}

} // namespace
} // namespace lambert
