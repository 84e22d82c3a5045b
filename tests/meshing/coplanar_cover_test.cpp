#include "meshing/coplanar_cover.h"

#include "mesh_checks.h"
#include "meshing/coplanar_order.h"
#include "meshing/prepare.h"
#include "sample_scenes.h"
#include "scene/coplanar_pairs.h"
#include "scene/example_scenes.h"
#include "scene/surface.h"

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <memory>
#include <optional>
#include <random>
#include <string>
#include <utility>
#include <vector>

namespace lambert {
namespace {

using Corners3 = std::vector<glm::vec3>;

/// A polygon with vertices of its own in a material.
void add(Scene& scene, const Corners3& corners, std::uint32_t material) {
    addPolygon(scene, corners);
    scene.polygons.back().material = material;
    scene.polygons.back().node = material;
}

Corners3 rectangle(float x0, float y0, float x1, float y1, float z = 0.0F) {
    return {{x0, y0, z}, {x1, y0, z}, {x1, y1, z}, {x0, y1, z}};
}

enum Surface : std::uint32_t { kFloor, kRug, kLamp };

Scene surfaces(bool twoSided = false) {
    Scene scene;
    scene.materials = {greyMaterial("floor", 0.5F), greyMaterial("rug", 0.25F), greyMaterial("lamp", 0.0F, 1.0F)};
    for (Material& material : scene.materials) material.twoSided = twoSided;
    scene.nodes = {"floor", "rug", "lamp"};
    return scene;
}

/// What is seen of a material, on the front or on the back of polygons, m².
double shown(const Scene& scene, std::uint32_t material, bool back = false) {
    double area = 0.0;
    for (const Polygon& polygon : scene.polygons)
        if ((back ? polygon.backMaterial : polygon.material) == material) area += exactArea(scene, polygon);
    return area;
}

bool anyUndecided(const Scene& scene, float tolerance) {
    const auto pairs = coplanarPairs(scene, tolerance);
    return std::any_of(pairs.begin(), pairs.end(),
                       [&](const CoplanarPair& pair) { return CoplanarOrder::mustDecide(scene, pair); });
}

Scene triangulated(const Scene& scene) {
    Scene result = scene;
    result.polygons.clear();
    for (const Polygon& polygon : scene.polygons) {
        Polygon half = polygon;
        half.vertices[3] = kNone;
        result.polygons.push_back(half);
        if (!polygon.isQuad()) continue;
        half.vertices = {polygon.vertices[2], polygon.vertices[3], polygon.vertices[0], kNone};
        result.polygons.push_back(half);
    }
    return result;
}

/// The scene in all the ways in which nothing about it changes, with its length unit.
void inAllVariants(const Scene& scene, const std::function<void(const Scene&, double)>& check) {
    for (const bool triangles : {false, true})
        for (const bool turnedToo : {false, true})
            for (const float unit : {1.0F, 1e-3F, 1e3F}) {
                SCOPED_TRACE(std::string(triangles ? "triangles" : "quads") + (turnedToo ? ", turned" : "") +
                             ", unit " + std::to_string(unit));
                Scene variant = triangles ? triangulated(scene) : scene;
                if (turnedToo) variant = turned(variant);
                check(scaled(variant, unit), static_cast<double>(unit));
            }
}

/// That what is shown are these areas (of a scene of some m²), and that nothing else lies there.
void expectShown(const Scene& scene, const std::array<double, 3>& areas) {
    inAllVariants(scene, [&](const Scene& variant, double unit) {
        PrepareReport report;
        const Scene prepared = prepareScene(variant, {}, &report);
        EXPECT_EQ(report.cover.undecidedPolygons, 0U);
        EXPECT_FALSE(anyUndecided(prepared, 2.0F * weldTolerance(variant)));
        // Vertices move by 2e-6 of the diagonal (some metres) at most, along edges of some metres.
        for (std::uint32_t m = 0; m < 3; ++m)
            EXPECT_NEAR(shown(prepared, m) / (unit * unit), areas[m], 1e-4) << variant.materials[m].name;
    });
}

TEST(CoverCoplanar, ALampCoversTheCeilingInWhosePlaneItLies) {
    Scene later = surfaces();
    add(later, rectangle(0, 0, 4, 4), kFloor);
    add(later, rectangle(1, 1, 2.2F, 2.1F), kLamp);
    expectShown(later, {16.0 - 1.32, 0.0, 1.32});
    Scene earlier = surfaces();
    add(earlier, rectangle(1, 1, 2.2F, 2.1F), kLamp);
    add(earlier, rectangle(0, 0, 4, 4), kFloor);
    expectShown(earlier, {16.0 - 1.32, 0.0, 1.32});
}

TEST(CoverCoplanar, ALampThatCoversAllIsAllThatIsLeft) {
    Scene scene = surfaces();
    add(scene, rectangle(0, 0, 4, 4), kLamp);
    add(scene, rectangle(1, 1, 2, 2), kFloor);
    expectShown(scene, {0.0, 0.0, 16.0});
    PrepareReport report;
    EXPECT_EQ(prepareScene(scene, {}, &report).polygons.size(), 1U);
    EXPECT_EQ(report.cover.coveredPolygons, 1U);
}

TEST(CoverCoplanar, TwoLampsEmitOnceWhereTheyOverlap) {
    Scene scene = surfaces();
    add(scene, rectangle(1, 1, 2.2F, 2.1F), kLamp);
    add(scene, rectangle(1.7F, 1.5F, 3, 3), kLamp);
    add(scene, rectangle(0, 0, 4, 4), kFloor);
    const double lamps = 1.32 + 1.95 - 0.5 * 0.6;
    expectShown(scene, {16.0 - lamps, 0.0, lamps});
    PrepareReport report;
    (void)prepareScene(scene, {}, &report);
    ASSERT_EQ(report.cover.overlaps.size(), 2U);
    EXPECT_EQ(report.cover.overlaps[0].lowerMaterial, kFloor);
    EXPECT_NEAR(report.cover.overlaps[0].area, lamps, 1e-5); // rounding of the corners
    EXPECT_EQ(report.cover.overlaps[1].lowerMaterial, kLamp);
    EXPECT_NEAR(report.cover.overlaps[1].area, 0.3, 1e-5);
}

TEST(CoverCoplanar, ARugCoversTheFloorAcrossItsTilesInAnyOrder) {
    for (const bool first : {false, true}) {
        SCOPED_TRACE(first);
        Scene scene = surfaces();
        if (first) add(scene, rectangle(0.7F, 0.3F, 2.9F, 1.8F), kRug);
        for (int x = 0; x < 4; ++x)
            for (int y = 0; y < 4; ++y) add(scene, rectangle(float(x), float(y), float(x + 1), float(y + 1)), kFloor);
        if (!first) add(scene, rectangle(0.7F, 0.3F, 2.9F, 1.8F), kRug);
        expectShown(scene, {16.0 - 3.3, 3.3, 0.0});
        // It would be hidden otherwise although it fills the tiles on which it lies.
        scene.positions[first ? 0 : 64] = {1, 0, 0};
        scene.positions[first ? 1 : 65] = {3, 0, 0};
        scene.positions[first ? 2 : 66] = {3, 2, 0};
        scene.positions[first ? 3 : 67] = {1, 2, 0};
        expectShown(scene, {12.0, 4.0, 0.0});
    }
}

TEST(CoverCoplanar, OfTwoThatOverlapInPartTheLaterLiesOnTop) {
    for (const std::uint32_t first : {kFloor, kRug}) {
        Scene scene = surfaces();
        const std::uint32_t second = first == kFloor ? kRug : kFloor;
        add(scene, rectangle(0, 0, 2, 2), first);
        add(scene, rectangle(1, 1, 3, 3), second);
        std::array<double, 3> areas{};
        areas[first] = 3.0;
        areas[second] = 4.0;
        expectShown(scene, areas);
    }
}

TEST(CoverCoplanar, OfTwoOnTheSameVerticesTheEmitterOrTheLaterShows) {
    Scene scene = surfaces();
    add(scene, rectangle(0, 0, 2, 1), kLamp);
    add(scene, rectangle(0, 0, 2, 1), kFloor);
    add(scene, rectangle(0, 0, 2, 1), kRug);
    expectShown(scene, {0.0, 0.0, 2.0});
    scene.polygons.erase(scene.polygons.begin());
    expectShown(scene, {0.0, 2.0, 0.0});
}

TEST(CoverCoplanar, TheFloorShowsThroughTheHoleOfARug) {
    Scene scene = surfaces();
    add(scene, rectangle(0, 0, 4, 4), kFloor);
    // Of four trapezoids around a turned hole.
    const Corners3 outer = rectangle(0.5F, 0.5F, 3.5F, 3.5F);
    const Corners3 inner{{2, 1, 0}, {3, 2, 0}, {2, 3, 0}, {1, 2, 0}};
    for (std::size_t k = 0; k < 4; ++k) {
        add(scene, {outer[k], outer[(k + 1) % 4], inner[k]}, kRug);
        add(scene, {inner[k], outer[(k + 1) % 4], inner[(k + 1) % 4]}, kRug);
    }
    expectShown(scene, {16.0 - 7.0, 7.0, 0.0});
}

TEST(CoverCoplanar, WhatOnlyTouchesOrFacesTheOtherWayIsLeftAlone) {
    Scene scene = surfaces();
    add(scene, rectangle(0, 0, 2, 2), kFloor);
    add(scene, rectangle(2, 0, 4, 2), kRug);            // an edge in common
    add(scene, rectangle(1, 2, 3, 4), kFloor);          // a part of an edge
    add(scene, rectangle(2, -1, 3, 0.000001F), kFloor); // over the edge by less than the tolerance
    Corners3 under = rectangle(0.5F, 0.5F, 1.5F, 1.5F);
    std::reverse(under.begin(), under.end());
    add(scene, under, kRug);
    add(scene, {{0, 0, 0}, {2, 0, 0}, {1, 0, 1}}, kLamp); // stands on an edge
    inAllVariants(scene, [](const Scene& variant, double) {
        PrepareReport report;
        const Scene prepared = prepareScene(variant, {}, &report);
        EXPECT_TRUE(report.cover.overlaps.empty());
        EXPECT_EQ(report.cover.cutPolygons + report.cover.coveredPolygons, 0U);
        EXPECT_EQ(prepared.polygons.size(), 6U);
    });
}

TEST(CoverCoplanar, FacesAreInOnePlaneWithinTheTolerance) {
    Scene scene = surfaces();
    add(scene, rectangle(0, 0, 4, 4), kFloor);
    add(scene, {{1, 1, 0}, {2, 1, 4e-6F}, {2, 2, 8e-6F}, {1, 2, 4e-6F}}, kRug);
    expectShown(scene, {15.0, 1.0, 0.0});
    for (glm::vec3& p : scene.positions)
        if (p.z > 0.0F) p.z = 1e-4F; // beyond 2e-6 of the diagonal
    PrepareReport report;
    (void)prepareScene(scene, {}, &report);
    EXPECT_TRUE(report.cover.overlaps.empty());
}

TEST(CoverCoplanar, FromBehindTheLowestIsSeen) {
    Scene scene = surfaces(true);
    add(scene, rectangle(0, 0, 4, 4), kFloor);
    add(scene, rectangle(1, 1, 2, 3), kRug);
    inAllVariants(scene, [](const Scene& variant, double unit) {
        const Scene prepared = prepareScene(variant);
        EXPECT_NEAR(shown(prepared, kRug) / (unit * unit), 2.0, 1e-4); // as in expectShown
        EXPECT_NEAR(shown(prepared, kFloor, true) / (unit * unit), 16.0, 1e-4);
        EXPECT_EQ(shown(prepared, kRug, true), 0.0);
    });
    scene.materials[kFloor].twoSided = false;
    const Scene prepared = prepareScene(scene);
    EXPECT_EQ(shown(prepared, kRug, true), 0.0) << "the black back of the floor lies under the rug";
}

TEST(CoverCoplanar, ATwoSidedLampShinesToBothSidesWhicheverWayItFaces) {
    for (const bool reversed : {false, true}) {
        Scene scene = surfaces(true);
        Corners3 lamp = rectangle(1, 1, 2, 2);
        if (reversed) std::reverse(lamp.begin(), lamp.end());
        add(scene, lamp, kLamp);
        add(scene, rectangle(0, 0, 4, 4), kFloor);
        const Scene prepared = prepareScene(scene);
        EXPECT_NEAR(shown(prepared, kLamp), 1.0, 1e-4);
        EXPECT_NEAR(shown(prepared, kLamp, true), 1.0, 1e-4);
        EXPECT_NEAR(shown(prepared, kFloor), 15.0, 1e-4);
        EXPECT_FALSE(anyUndecided(prepared, 2.0F * weldTolerance(scene)));
    }
}

/// The uv at a point of the plane z = 0, of whichever polygon of the material lies there.
std::optional<glm::vec2> uvAtPoint(const Scene& scene, std::uint32_t material, glm::dvec2 point) {
    const auto at = [&](const Polygon& polygon, int k) { return glm::dvec2(corner(scene, polygon, k)); };
    const auto cross = [](glm::dvec2 a, glm::dvec2 b) { return a.x * b.y - a.y * b.x; };
    for (const Polygon& polygon : scene.polygons) {
        if (polygon.material != material) continue;
        for (const std::array<int, 3>& t : {std::array{0, 1, polygon.isQuad() ? 3 : 2}, std::array{2, 3, 1}}) {
            if (t[0] == 2 && !polygon.isQuad()) continue;
            const glm::dvec2 a = at(polygon, t[0]);
            const double twice = cross(at(polygon, t[1]) - a, at(polygon, t[2]) - a);
            const double u = cross(point - a, at(polygon, t[2]) - a) / twice;
            const double v = cross(at(polygon, t[1]) - a, point - a) / twice;
            if (u < 0.0 || v < 0.0 || u + v > 1.0) continue;
            const auto& uv = scene.surfaces[polygon.surface].uv;
            const auto corner = [&](int k) { return glm::dvec2(uv[static_cast<std::size_t>(k)]); };
            return glm::vec2((1.0 - u - v) * corner(t[0]) + u * corner(t[1]) + v * corner(t[2]));
        }
    }
    return std::nullopt;
}

TEST(CoverCoplanar, TextureCoordinatesStayWhereTheyAre) {
    Scene scene = surfaces();
    scene.textures.push_back(std::make_shared<Texture>("grey", 1, 1, std::vector<glm::vec4>(1, glm::vec4(0.5F))));
    scene.materials[kFloor].reflectanceTexture.texture = 0;
    add(scene, {{0, 0, 0}, {4, 0, 0}, {3, 3, 0}, {0, 4, 0}}, kFloor);
    SurfaceCorners surface;
    surface.uv = {{{0, 0}, {1, 0}, {2, 3}, {0, 1}}}; // not affine over the quad
    scene.surfaces.push_back(surface);
    scene.polygons[0].surface = 0;
    add(scene, rectangle(1, 1, 2, 2.5F), kRug);
    const Scene prepared = prepareScene(scene);
    std::mt19937 random(5);
    std::uniform_real_distribution<double> place(0.0, 4.0);
    int compared = 0;
    for (int k = 0; k < 1000; ++k) {
        const glm::dvec2 point(place(random), place(random));
        const auto before = uvAtPoint(scene, kFloor, point);
        const auto now = uvAtPoint(prepared, kFloor, point);
        const bool onRug = point.x > 1.0 && point.x < 2.0 && point.y > 1.0 && point.y < 2.5;
        ASSERT_EQ(now.has_value(), before.has_value() && !onRug) << point.x << ' ' << point.y;
        if (!now) continue;
        EXPECT_LT(glm::distance(*before, *now), 1e-5F); // rounding of vertices and coordinates
        ++compared;
    }
    EXPECT_GT(compared, 300);
}

/// How many polygons that face up cover a point of the plane z = 0, and the material of the last.
std::pair<int, std::uint32_t> coverAt(const Scene& scene, glm::dvec2 point) {
    int count = 0;
    std::uint32_t material = kNone;
    for (const Polygon& polygon : scene.polygons) {
        bool inside = true;
        for (int k = 0; k < polygon.size(); ++k) {
            const glm::dvec2 a(corner(scene, polygon, k));
            const glm::dvec2 edge = glm::dvec2(corner(scene, polygon, (k + 1) % polygon.size())) - a;
            inside = inside && edge.x * (point.y - a.y) - edge.y * (point.x - a.x) > 0.0;
        }
        if (!inside) continue;
        ++count;
        material = polygon.material;
    }
    return {count, material};
}

TEST(CoverCoplanar, EveryPlaceUnderRandomPolygonsShowsOneOfThem) {
    for (std::uint32_t seed = 1; seed <= 6; ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        std::mt19937 random(seed);
        std::uniform_real_distribution<float> place(0.0F, 4.0F);
        Scene scene;
        scene.nodes = {"node"};
        // On a lattice, too, so that edges overlap, vertices lie on edges and several lines cross in a point.
        const bool onLattice = seed % 2 == 0;
        const auto coordinate = [&] { return onLattice ? std::round(place(random)) : place(random); };
        while (scene.polygons.size() < 20) {
            Corners3 corners;
            for (int k = 0; k < 3; ++k) {
                const float x = coordinate();
                corners.emplace_back(x, coordinate(), 0.0F);
            }
            const float twice = glm::cross(corners[1] - corners[0], corners[2] - corners[0]).z;
            if (std::abs(twice) < 0.1F) continue;
            if (twice < 0.0F) std::swap(corners[1], corners[2]);
            const auto material = static_cast<std::uint32_t>(scene.materials.size());
            // All emit, so that none would be hidden otherwise and only the order decides.
            scene.materials.push_back(greyMaterial(std::to_string(material), 0.5F, 1.0F));
            addPolygon(scene, corners);
            scene.polygons.back().material = material;
        }
        PrepareReport report;
        const Scene prepared = prepareScene(scene, {}, &report);
        EXPECT_EQ(report.cover.undecidedPolygons, 0U);
        std::uniform_real_distribution<double> point(0.0, 4.0);
        for (int k = 0; k < 2000; ++k) {
            const glm::dvec2 p(point(random), point(random));
            const auto [before, highest] = coverAt(scene, p);
            const auto [now, material] = coverAt(prepared, p);
            ASSERT_EQ(now, before > 0 ? 1 : 0) << p.x << ' ' << p.y;
            if (before == 1) {
                EXPECT_EQ(material, highest);
            }
        }
    }
}

TEST(CoverCoplanar, LeavesNoGapsInARoom) {
    std::array<Material, 6> walls;
    for (Material& wall : walls) wall = greyMaterial("wall", 0.7F);
    for (const bool turnedToo : {false, true}) {
        Scene scene = boxScene({4, 4, 3}, walls);
        const auto rug = static_cast<std::uint32_t>(scene.materials.size());
        scene.materials.push_back(greyMaterial("rug", 0.1F));
        scene.materials.push_back(greyMaterial("lamp", 0.0F, 5.0F));
        addQuad(scene, {{{1.3F, 0, 0}, {3.1F, 0, 0}, {3.1F, 3.3F, 0}, {1.3F, 3.3F, 0}}}, rug); // up to a wall
        addQuad(scene, {{{1, 1, 3}, {1, 2.1F, 3}, {2.2F, 2.1F, 3}, {2.2F, 1, 3}}}, rug + 1);
        scene = prepareScene(turnedToo ? turned(scene) : scene);
        const PatchMesh mesh = meshWithLength(scene, 0.5);
        expectSoundMesh(scene, mesh);
        expectNoTVertex(scene, mesh);
        expectClosed(mesh);
    }
}

} // namespace
} // namespace lambert
