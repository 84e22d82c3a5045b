#include "formfactors/block_visibility.h"

#include "closed_form_case.h"
#include "core/random.h"
#include "formfactors/patch_sampling.h"
#include "meshing/build_patch_mesh.h"
#include "meshing/patch_offset.h"
#include "meshing/prepare.h"
#include "scene/example_scenes.h"
#include "scene/reading/scene_reader.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <optional>
#include <string>

namespace lambert {
namespace {

struct Case {
    Case(const Scene& source, std::size_t patches)
        : scene(prepareScene(source)),
          rays(scene),
          mesh(divided(scene, patches)),
          blocks(mesh),
          known(scene, mesh, blocks, 2.0 * static_cast<double>(weldTolerance(scene))) {}

    static PatchMesh divided(const Scene& scene, std::size_t patches) {
        MeshOptions options;
        options.patches = patches;
        Progress progress;
        return buildPatchMesh(scene, options, progress);
    }

    std::uint32_t patchOf(std::uint32_t sourcePolygon) const {
        const auto found = std::find(mesh.polygon.begin(), mesh.polygon.end(), sourcePolygon);
        return static_cast<std::uint32_t>(found - mesh.polygon.begin());
    }
    ConvexPolygon polygon(std::uint32_t patch) const {
        ConvexPolygon result;
        for (int k = 0; k < mesh.cornerCount(patch); ++k) result.add(glm::dvec3(mesh.position(patch, k)));
        return result;
    }

    /// Whether a line between points of two patches is free; nothing if it leaves or arrives at a back.
    std::optional<bool> isFree(std::uint32_t from, std::uint32_t to, const std::array<float, 4>& u) const {
        const glm::vec3 x = PatchPoints(mesh, from).at({u[0], u[1]}), y = PatchPoints(mesh, to).at({u[2], u[3]});
        const glm::vec3 way = y - x;
        const float reach = 0.01F * glm::length(way);
        if (glm::dot(way, mesh.normal[from]) < reach || glm::dot(way, mesh.normal[to]) > -reach) return std::nullopt;
        const glm::vec3 origin = x + patchOriginOffset(rays, mesh, from) * mesh.normal[from];
        const glm::vec3 end = y + patchOriginOffset(rays, mesh, to) * mesh.normal[to];
        return !rays.occluded({origin, end - origin, 1.0F});
    }

    Scene scene;
    RayCaster rays;
    PatchMesh mesh;
    PatchBlocks blocks;
    BlockVisibility known;
};

std::array<float, 4> randomNumbers(std::uint32_t index, std::uint32_t key) {
    const auto bits = philox({index, 0, 0, 0}, key);
    return {uniformFloat(bits[0]), uniformFloat(bits[1]), uniformFloat(bits[2]), uniformFloat(bits[3])};
}

Scene roomWithBox(const GridScene::Map& map) {
    return GridScene()
        .box({0, 0, 0}, {1, 1, 1}, 1, true, map)
        .box({0.35, 0.3, 0.4}, {0.65, 0.6, 0.7}, 1, false, map)
        .scene();
}

Scene example(const std::string& name) { return readScene(std::filesystem::path(LAMBERT_DATA) / name).scene; }

/// Draws lines between pairs of patches and holds what is known of their blocks against them.
void expectTrue(const Case& c, std::uint32_t lines) {
    const auto n = static_cast<std::uint32_t>(c.mesh.size());
    std::uint32_t known = 0;
    for (std::uint32_t k = 0; k < lines; ++k) {
        const auto u = randomNumbers(k, 1);
        const auto from = static_cast<std::uint32_t>(u[0] * static_cast<float>(n));
        const auto to = static_cast<std::uint32_t>(u[1] * static_cast<float>(n));
        const auto free = c.isFree(from, to, randomNumbers(k, 2));
        if (!free) continue;
        const std::uint32_t a = c.blocks.blockOf(from), b = c.blocks.blockOf(to);
        const Blocking ofBlocks = c.known.between(a, b);
        EXPECT_EQ(ofBlocks, c.known.between(b, a));
        ConvexPolygon polygon = c.polygon(from);
        const Plane plane = Plane::through(polygon.corners[0], glm::dvec3(c.mesh.normal[from]));
        const Blocking ofPatch = c.known.between(polygon, plane, a, b);
        if (ofBlocks != Blocking::Unknown) {
            ASSERT_EQ(ofPatch, ofBlocks);
        }
        known += ofPatch == Blocking::Unknown ? 0 : 1;
        if (ofPatch == Blocking::Clear) {
            ASSERT_TRUE(*free) << from << " " << to;
        } else if (ofPatch == Blocking::Hidden) {
            ASSERT_FALSE(*free) << from << " " << to;
        }
    }
    EXPECT_GT(known, lines / 20); // or this would prove nothing
}

TEST(BlockVisibility, IsTrueOfEveryLineInARoomWithABox) {
    for (const GridScene::Map& map : {GridScene::Map(same), GridScene::Map(sheared), GridScene::Map(turned)})
        expectTrue(Case(roomWithBox(map), 2000), 100'000);
}

TEST(BlockVisibility, IsTrueOfEveryLineInOurRooms) {
    for (const char* name : {"cornell_box.obj", "table_room.obj", "block_of_rooms.obj", "corridor.gltf"}) {
        SCOPED_TRACE(name);
        expectTrue(Case(example(name), 5000), 100'000);
    }
}

// In a convex room everything is clear, however it is turned; rooms behind walls are hidden.
TEST(BlockVisibility, FindsMostOfWhatIsToBeFound) {
    const Case empty(GridScene().box({0, 0, 0}, {3, 2, 1}, 1, true, turned).scene(), 1000);
    for (std::uint32_t a = 0; a < empty.blocks.blocks().size(); ++a)
        for (std::uint32_t b = 0; b < empty.blocks.blocks().size(); ++b)
            EXPECT_EQ(empty.known.between(a, b), Blocking::Clear) << a << " " << b;
    const Case rooms(example("block_of_rooms.obj"), 5000);
    std::uint32_t unknown = 0;
    const auto count = static_cast<std::uint32_t>(rooms.blocks.blocks().size());
    for (std::uint32_t a = 0; a < count; ++a)
        for (std::uint32_t b = 0; b < count; ++b) unknown += rooms.known.between(a, b) == Blocking::Unknown ? 1 : 0;
    EXPECT_LT(unknown, count * count / 4);
}

// A leaf with holes hides nothing for certain, and nothing behind it is clear; one without hides.
TEST(BlockVisibility, HolesLeaveItOpen) {
    const std::array<std::array<glm::vec3, 4>, 3> quads{{{{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}},
                                                         {{{0, 0, 2}, {0, 1, 2}, {1, 1, 2}, {1, 0, 2}}},
                                                         {{{-9, -9, 1}, {9, -9, 1}, {9, 9, 1}, {-9, 9, 1}}}}};
    const std::array<Material, 3> materials{greyMaterial("a", 0.5F), greyMaterial("b", 0.5F),
                                            greyMaterial("leaf", 0.5F)};
    Scene scene = quadScene(quads, materials);
    const auto ofFirstTwo = [&] {
        const Case c(scene, 3000);
        return c.known.between(c.blocks.blockOf(c.patchOf(0)), c.blocks.blockOf(c.patchOf(1)));
    };
    EXPECT_EQ(ofFirstTwo(), Blocking::Hidden);
    openLeftHalf(scene, scene.polygons[2]);
    EXPECT_EQ(ofFirstTwo(), Blocking::Unknown);
}

} // namespace
} // namespace lambert
