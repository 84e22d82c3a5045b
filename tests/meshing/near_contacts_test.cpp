#include "meshing/near_contacts.h"

#include "mesh_checks.h"
#include "meshing/patch_optics.h"
#include "meshing/plane_frame.h"
#include "meshing/prepare.h"
#include "sample_scenes.h"
#include "scene/rays/ray_caster.h"

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <random>

namespace lambert {
namespace {

using Quad = std::array<glm::vec3, 4>;

constexpr float kHeight = 10.0F;

/// Adds a horizontal quad that faces up and down and, if asked, emits.
void addSheet(Scene& scene, glm::vec2 lower, glm::vec2 upper, float z, bool lamp) {
    addPolygon(scene,
               Quad{{{lower.x, lower.y, z}, {upper.x, lower.y, z}, {upper.x, upper.y, z}, {lower.x, upper.y, z}}});
    scene.polygons.back().material = lamp ? 1 : 2;
}

constexpr std::uint32_t kCeiling = 4;

/// A closed room of 10 m with reflectance .6.
Scene room() {
    Scene scene = emptyScene();
    addBox(scene, {0.0F, 0.0F, 0.0F}, {kHeight, kHeight, kHeight}, true);
    for (Polygon& polygon : scene.polygons) std::reverse(polygon.vertices.begin(), polygon.vertices.end());
    scene.materials[0].reflectance = Rgb(0.6F);
    Material lamp = scene.materials[0], sheet = scene.materials[0];
    lamp.reflectance = Rgb(0.0F);
    lamp.emittedRadiance = Rgb(1000.0F);
    lamp.twoSided = sheet.twoSided = true;
    scene.materials.push_back(lamp);
    scene.materials.push_back(sheet);
    return scene;
}

Scene roomWithLamp(float gap) {
    Scene scene = room();
    addSheet(scene, {4.4F, 4.4F}, {5.4F, 5.4F}, kHeight - gap, true);
    return scene;
}

PatchMesh meshOf(const Scene& scene, std::optional<std::size_t> patches = std::nullopt) {
    Progress progress;
    MeshOptions options;
    options.patches = patches;
    return buildPatchMesh(scene, options, progress);
}

/// The area of a polygon's front patches that reach from one side of a rectangle's outline to the other by more than
/// `rounding` metres. The rectangle is given in the frame of its lower corner, in metres.
double areaAcross(const PatchMesh& mesh, const std::vector<std::uint32_t>& polygons, const Quad& rectangle,
                  double rounding) {
    const glm::dvec3 origin(rectangle[0]);
    const glm::dvec3 x(rectangle[1] - rectangle[0]), y(rectangle[3] - rectangle[0]);
    double across = 0.0;
    for (std::size_t patch = 0; patch < mesh.frontCount; ++patch) {
        if (std::find(polygons.begin(), polygons.end(), mesh.polygon[patch]) == polygons.end()) continue;
        double deepest = -1e30, farthest = -1e30;
        for (int k = 0; k <= mesh.cornerCount(patch); ++k) {
            const glm::dvec3 p(k < mesh.cornerCount(patch) ? mesh.position(patch, k) : mesh.centroid[patch]);
            const double s = glm::dot(p - origin, x) / glm::dot(x, x), t = glm::dot(p - origin, y) / glm::dot(y, y);
            const double depth = std::min({s, 1.0 - s, t, 1.0 - t}) * glm::length(x);
            deepest = std::max(deepest, depth);
            farthest = std::max(farthest, -depth);
        }
        if (deepest > rounding && farthest > rounding) across += exactArea(mesh, patch);
    }
    return across;
}

TEST(NearContacts, NoPatchReachesAcrossTheOutlineOfALampBelowTheCeiling) {
    for (const float gap : {1e-4F, 1e-3F, 1e-2F, 0.1F}) {
        for (const bool turn : {false, true}) {
            for (const float unit : {1.0F, 1e-3F}) {
                SCOPED_TRACE(testing::Message() << "gap " << gap << (turn ? ", turned" : "") << ", unit " << unit);
                Scene scene = scaled(roomWithLamp(gap), unit);
                if (turn) scene = turned(scene);
                scene = prepareScene(scene);
                const PatchMesh mesh = meshOf(scene, 1500);
                expectSoundMesh(scene, mesh);
                expectNoTVertex(scene, mesh);
                EXPECT_NEAR(static_cast<double>(mesh.size()), 1500.0, 0.1 * 1500.0);
                const Polygon& lamp = scene.polygons[6];
                Quad outline;
                for (int k = 0; k < 4; ++k) outline[static_cast<std::size_t>(k)] = corner(scene, lamp, k);
                const double rounding = 5.0 * static_cast<double>(weldTolerance(scene)); // points are one within 4
                EXPECT_EQ(areaAcross(mesh, {kCeiling}, outline, rounding), 0.0);
            }
        }
    }
}

/// Mean irradiance of the room's surfaces: random walks that go on from a random point of the patch they met, as if its light
/// were even. What differs from the scene's own light is the mesh's error.
double meanIrradiance(const Scene& scene, const PatchMesh& mesh, std::size_t walks, std::uint64_t seed) {
    const RayCaster rays(scene);
    const PatchOptics optics = patchOptics(scene, mesh);
    std::mt19937_64 random(seed);
    const auto uniform = [&] { return static_cast<float>(random() >> 40) * 0x1p-24F; };
    std::vector<double> upTo;
    double power = 0.0, area = 0.0;
    for (std::size_t i = 0; i < mesh.size(); ++i) {
        upTo.push_back(power += static_cast<double>(mesh.area[i] * optics.emittedRadiosity[i].x));
        if (mesh.material[i] == 0) area += static_cast<double>(mesh.area[i]);
    }
    std::size_t arrivals = 0;
    for (std::size_t walk = 0; walk < walks; ++walk) {
        const double target = power * static_cast<double>(uniform());
        auto patch = static_cast<std::size_t>(std::lower_bound(upTo.begin(), upTo.end(), target) - upTo.begin());
        while (true) {
            std::array<glm::vec3, 3> p{mesh.position(patch, 0), mesh.position(patch, 1), mesh.position(patch, 2)};
            if (mesh.isQuad(patch)) {
                const glm::vec3 last = mesh.position(patch, 3);
                const float one = glm::length(glm::cross(p[1] - p[0], p[2] - p[0]));
                const float two = glm::length(glm::cross(p[2] - p[0], last - p[0]));
                if (uniform() * (one + two) > one) p = {p[0], p[2], last};
            }
            const float root = std::sqrt(uniform()), along = uniform();
            const glm::vec3 from = p[0] + root * (1.0F - along) * (p[1] - p[0]) + root * along * (p[2] - p[0]);
            const glm::vec3 n = mesh.normal[patch];
            const glm::vec3 x =
                glm::normalize(glm::cross(n, std::abs(n.x) < 0.6F ? glm::vec3(1, 0, 0) : glm::vec3(0, 1, 0)));
            const float radius = std::sqrt(uniform()), angle = 2.0F * std::numbers::pi_v<float> * uniform();
            const glm::vec3 direction = radius * (std::cos(angle) * x + std::sin(angle) * glm::cross(n, x)) +
                                        std::sqrt(std::max(0.0F, 1.0F - radius * radius)) * n;
            const auto hit = rays.closest({from + rays.originOffset(0.0F) * n, direction});
            if (!hit) break;
            std::uint32_t met = mesh.lookup.patchAt(hit->polygon, hit->u, hit->v);
            if (!hit->front) met = mesh.lookup.backPatch(hit->polygon, met);
            if (met == kNone) break;
            arrivals += mesh.material[met] == 0 ? 1 : 0;
            if (uniform() >= optics.reflectance[met].x) break;
            patch = met;
        }
    }
    return power * static_cast<double>(arrivals) / static_cast<double>(walks) / area;
}

TEST(NearContacts, LightAboveALampStaysThere) {
    // Independent random walks without any mesh: ± .004.
    constexpr std::array<std::pair<float, double>, 3> kRight{{{1e-4F, 18.29}, {1e-2F, 18.53}, {0.1F, 20.32}}};
    for (const auto& [gap, right] : kRight) {
        const Scene scene = prepareScene(roomWithLamp(gap));
        constexpr std::uint64_t kSeed = 5;
        // The standard error of so many walks is .055; a mesh that does not follow the outline is off by 2.06, 1.8 and .5.
        EXPECT_NEAR(meanIrradiance(scene, meshOf(scene), 100000, kSeed), right, 0.01 * right)
            << gap << ", seed " << kSeed;
    }
}

TEST(NearContacts, OutlinesGoOnAcrossTilesAndPiecesOfALamp) {
    // Tiles of 2.5 m below the ceiling; the lamp lies across four of them, in two pieces.
    Scene scene = room();
    for (int j = 0; j < 4; ++j)
        for (int i = 0; i < 4; ++i) {
            const float x = 2.5F * static_cast<float>(i), y = 2.5F * static_cast<float>(j);
            addSheet(scene, {x, y}, {x + 2.5F, y + 2.5F}, 9.0F, false);
        }
    addSheet(scene, {4.4F, 4.4F}, {5.4F, 5.4F}, 8.99F, true);
    addSheet(scene, {5.4F, 4.4F}, {5.9F, 5.4F}, 8.99F, true);
    for (const Scene& one : {prepareScene(scene), prepareScene(turned(scene))}) {
        const PatchMesh mesh = meshOf(one, 1500);
        expectSoundMesh(one, mesh);
        expectNoTVertex(one, mesh);
        std::vector<std::uint32_t> tiles;
        for (std::uint32_t i = 0; i < one.polygons.size(); ++i)
            if (one.polygons[i].material == 2) tiles.push_back(i);
        ASSERT_EQ(tiles.size(), 16U);
        Quad outline;
        for (int k = 0; k < 4; ++k) {
            const Polygon& piece = one.polygons[k == 0 || k == 3 ? 22 : 23];
            outline[static_cast<std::size_t>(k)] = corner(one, piece, k);
        }
        EXPECT_EQ(areaAcross(mesh, tiles, outline, 5.0 * static_cast<double>(weldTolerance(one))), 0.0);
        EXPECT_FALSE(NearContactFinder(one, 0.4).find(1000.0).vertices.empty()); // where lines pass from tile to tile
    }
}

TEST(NearContacts, ASceneWithoutAnyKeepsItsPatches) {
    Scene scene = room();
    addBox(scene, {2.0F, 2.0F, 0.0F}, {4.0F, 3.0F, 1.0F}, true); // stands on the floor
    addBox(scene, {6.0F, 6.0F, 3.0F}, {7.0F, 7.0F, 4.0F}, true); // far from everything
    const NearContacts near = NearContactFinder(prepareScene(scene), 0.4).find(1000.0);
    EXPECT_TRUE(near.contacts.empty());
    EXPECT_TRUE(near.vertices.empty());
}

TEST(NearContacts, WhatReachesDownToTheSurfaceIsNoOutline) {
    // The front of a box that stands .05 m out of the wall x = 0: its sides close the gap.
    Scene frame = room();
    addBox(frame, {0.0F, 3.0F, 3.0F}, {0.05F, 4.0F, 4.0F}, true);
    EXPECT_TRUE(NearContactFinder(prepareScene(frame), 0.4).find(1000.0).contacts.empty());
    Scene cupboard = room();
    addBox(cupboard, {0.05F, 3.0F, 3.0F}, {0.6F, 4.0F, 4.0F}, true);
    EXPECT_EQ(NearContactFinder(prepareScene(cupboard), 0.4).find(1000.0).contacts.size(), 2U); // the wall and the back
}

TEST(NearContacts, SmallThingsDoNotUseUpThePatches) {
    Scene scene = roomWithLamp(0.01F);
    for (int j = 0; j < 15; ++j)
        for (int i = 0; i < 15; ++i) { // legs that end 1 mm above the floor
            const glm::vec3 lower(0.3F + 0.6F * static_cast<float>(i), 0.3F + 0.6F * static_cast<float>(j), 0.001F);
            addBox(scene, lower, lower + glm::vec3(0.05F, 0.05F, 0.5F), true);
        }
    scene = prepareScene(scene);
    const double wanted = static_cast<double>(defaultPatches(scene));
    const PatchMesh mesh = meshOf(scene);
    EXPECT_NEAR(static_cast<double>(mesh.size()), wanted, 0.15 * wanted);
    // The lamp comes first: its ceiling is followed all the same.
    const NearContacts near = NearContactFinder(scene, 0.4).find(500.0);
    EXPECT_TRUE(std::any_of(near.contacts.begin(), near.contacts.end(),
                            [&](const NearContact& contact) { return scene.polygons[contact.polygon].material == 1; }));
}

/// 20 × 20 tiles of .3 m, each of `parts`² pieces with vertices of their own, with as many over them that lie across.
Scene roomWithTiles(float gap, int parts) {
    Scene scene = room();
    for (int j = 0; j < 20 * parts; ++j)
        for (int i = 0; i < 20 * parts; ++i) {
            const float size = 0.3F / static_cast<float>(parts);
            const glm::vec2 lower(1.0F + 1.1F * size * static_cast<float>(i),
                                  1.0F + 1.1F * size * static_cast<float>(j));
            addSheet(scene, lower, lower + size, 5.0F, false);
            addSheet(scene, lower + 0.5F * size, lower + 1.5F * size, 5.0F + gap, (i + j) % 7 == 0);
        }
    return scene;
}

TEST(NearContacts, ManySmallPolygonsAddNoMoreThanTheBudget) {
    for (const auto& [gap, parts] : {std::pair(0.01F, 1), {0.001F, 1}, {0.01F, 2}}) {
        for (const std::optional<std::size_t> wanted : {std::optional<std::size_t>(), {4000}, {20000}}) {
            SCOPED_TRACE(testing::Message()
                         << "gap " << gap << ", parts " << parts << ", wanted " << wanted.value_or(0));
            const Scene scene = prepareScene(roomWithTiles(gap, parts));
            Progress progress;
            MeshOptions options;
            options.patches = wanted;
            MeshReport report;
            const PatchMesh mesh = buildPatchMesh(scene, options, progress, &report);
            expectSoundMesh(scene, mesh);
            EXPECT_GT(report.nearContactPatches, 0U);
            EXPECT_LE(report.nearContactPatches, report.nearContactBudget);
            EXPECT_LE(4 * report.nearContactBudget, wanted.value_or(defaultPatches(scene)));
            // Nothing stands on anything: without contacts the scene is as it would be without those that are near.
            options.patches.reset();
            options.patchLength = report.patchLength;
            options.splitContacts = false;
            const std::size_t without = buildPatchMesh(scene, options, progress).size();
            EXPECT_EQ(static_cast<std::int64_t>(mesh.size()) - static_cast<std::int64_t>(without),
                      static_cast<std::int64_t>(report.nearContactPatches));
        }
    }
}

/// A ball of 10 cm, 2 cm below the ceiling, of 24 × 12 pieces about an axis that is neither upright nor level.
Scene roomWithBall() {
    Scene scene = room();
    constexpr int kAround = 24, kDown = 12;
    const glm::vec3 x(0.8F, 0.0F, -0.6F), y(0.0F, 1.0F, 0.0F), z(0.6F, 0.0F, 0.8F);
    const auto at = [&](int i, int j) {
        const float a = 2.0F * std::numbers::pi_v<float> * static_cast<float>(i % kAround) / kAround;
        const float b = std::numbers::pi_v<float> * static_cast<float>(j) / kDown;
        const float round = j % kDown == 0 ? 0.0F : std::sin(b);
        return glm::vec3(4.9F, 4.9F, kHeight - 0.07F) +
               0.05F * (round * (std::cos(a) * x + std::sin(a) * y) + std::cos(b) * z);
    };
    for (int j = 0; j < kDown; ++j)
        for (int i = 0; i < kAround; ++i) {
            if (j > 0) addPolygon(scene, std::array<glm::vec3, 3>{at(i, j), at(i, j + 1), at(i + 1, j)});
            if (j > 0) scene.polygons.back().material = 1;
            if (j + 1 < kDown)
                addPolygon(scene, std::array<glm::vec3, 3>{at(i + 1, j), at(i, j + 1), at(i + 1, j + 1)});
            scene.polygons.back().material = 1;
        }
    return scene;
}

TEST(NearContacts, TheRimOfABallHasNoGaps) {
    const HoveringOutlines found = findHoveringOutlines(prepareScene(roomWithBall()), 0.35);
    ASSERT_EQ(found.outlines.size(), 1U);
    EXPECT_EQ(found.outlines[0].below, kCeiling);
    EXPECT_TRUE(found.outlines[0].hovering.empty()) << "its pieces are smaller than the gap";
    std::vector<glm::dvec3> ends;
    for (const OutlineEdge& edge : found.outlines[0].edges) ends.insert(ends.end(), {edge.from, edge.to});
    for (const glm::dvec3& end : ends) EXPECT_EQ(std::count(ends.begin(), ends.end(), end), 2);
}

TEST(NearContacts, TheBrighterLampComesFirst) {
    Scene scene = roomWithLamp(0.01F);
    scene.materials.push_back(scene.materials[1]);
    scene.materials.back().emittedRadiance = Rgb(10000.0F);
    addSheet(scene, {1.0F, 1.0F}, {1.5F, 1.5F}, kHeight - 0.01F, true);
    scene.polygons.back().material = 3;
    scene = prepareScene(scene);
    const NearContacts near = NearContactFinder(scene, 0.4).find(30.0); // for one of the two
    ASSERT_EQ(near.contacts.size(), 1U);
    ASSERT_EQ(near.contacts[0].polygon, kCeiling);
    const PlaneFrame frame = planeFrame(scene, scene.polygons[kCeiling]);
    for (const glm::dvec2& point : near.contacts[0].lines.points)
        EXPECT_LT(glm::distance(frame.lift(point), glm::vec3(1.25F, 1.25F, kHeight)), 1.0F);
}

} // namespace
} // namespace lambert
