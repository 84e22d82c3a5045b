#include "meshing/contacts.h"

#include "mesh_checks.h"
#include "meshing/prepare.h"
#include "sample_scenes.h"

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace lambert {
namespace {

using Quad = std::array<glm::vec3, 4>;

const Quad kFloor{{{0, 0, 0}, {4, 0, 0}, {4, 4, 0}, {0, 4, 0}}};

/// The floor is polygon 0; boxes without bottom stand on it.
Scene floorWithBoxes(std::initializer_list<std::array<glm::vec3, 2>> boxes) {
    Scene scene = emptyScene();
    addPolygon(scene, kFloor);
    for (const auto& [lower, upper] : boxes) addBox(scene, lower, upper, false);
    return prepareScene(scene);
}

std::vector<PlanarContact> contactsOf(const Scene& scene) {
    return findContacts(scene, BoxIndex(boxesOf(scene.positions)));
}

std::size_t lineCount(const Scene& scene, const PlanarContact& contact, double length) {
    std::vector<glm::vec3> positions = scene.positions;
    const EdgeDivision division(scene, BoxIndex(boxesOf(scene.positions)), length, positions);
    return contactLines(contact, scene, division).size();
}

TEST(FindContacts, FindsTheFootprintOfABox) {
    const Scene scene = floorWithBoxes({{{{1, 1, 0}, {2, 2, 1}}}});
    const auto contacts = contactsOf(scene);
    ASSERT_EQ(contacts.size(), 1U);
    EXPECT_EQ(contacts[0].polygon, 0U);
    EXPECT_EQ(contacts[0].vertices.size(), 4U);
    EXPECT_EQ(lineCount(scene, contacts[0], 10.0), 4U);
    EXPECT_EQ(lineCount(scene, contacts[0], 0.25), 16U);
}

TEST(FindContacts, FindsNothingWhereNothingTouches) {
    EXPECT_TRUE(contactsOf(floorWithBoxes({{{{1, 1, 0.01F}, {2, 2, 1}}}})).empty());
    EXPECT_TRUE(contactsOf(emptyScene()).empty());
}

TEST(FindContacts, FindsALineFromBorderToBorder) {
    // A wall across the floor, flush with its borders: no vertex of it is inside.
    Scene scene = emptyScene();
    addPolygon(scene, kFloor);
    addPolygon(scene, Quad{{{1, 0, 0}, {1, 4, 0}, {1, 4, 2}, {1, 0, 2}}});
    scene = prepareScene(scene);
    const auto contacts = contactsOf(scene);
    ASSERT_EQ(contacts.size(), 1U);
    EXPECT_TRUE(contacts[0].vertices.empty());
    EXPECT_EQ(lineCount(scene, contacts[0], 10.0), 1U);
    MeshReport report;
    expectNoTVertex(scene, meshWithLength(scene, 0.7, &report));
    EXPECT_EQ(report.contactPolygons, 1U);
}

TEST(FindContacts, CountsNoLineAlongTheBorder) {
    const Scene scene = floorWithBoxes({{{{0, 1, 0}, {1, 2, 1}}}}); // against the edge x = 0
    const auto contacts = contactsOf(scene);
    ASSERT_FALSE(contacts.empty());
    EXPECT_EQ(contacts[0].polygon, 0U);
    EXPECT_EQ(lineCount(scene, contacts[0], 10.0), 3U);
}

/// Area of the floor's patches whose centroid lies in a rectangle.
double floorAreaWithin(const PatchMesh& mesh, glm::vec2 lower, glm::vec2 upper) {
    double area = 0.0;
    for (std::size_t patch = 0; patch < mesh.size(); ++patch) {
        const glm::vec3& c = mesh.centroid[patch];
        if (mesh.polygon[patch] == 0 && c.x > lower.x && c.y > lower.y && c.x < upper.x && c.y < upper.y)
            area += exactArea(mesh, patch);
    }
    return area;
}

TEST(BuildPatchMesh, LeavesNoPatchHalfUnderABox) {
    const glm::vec2 lower(1.03F, 0.71F), upper(2.17F, 3.32F);
    const Scene scene = floorWithBoxes({{{{lower.x, lower.y, 0}, {upper.x, upper.y, 1}}}});
    for (const double length : {5.0, 1.0, 0.3, 0.1}) {
        const PatchMesh mesh = meshWithLength(scene, length);
        expectSoundMesh(scene, mesh);
        expectNoTVertex(scene, mesh);
        const auto size = glm::dvec2(upper) - glm::dvec2(lower);
        EXPECT_NEAR(floorAreaWithin(mesh, lower, upper), size.x * size.y, 1e-5) << length; // floats of 4 m
    }
}

TEST(BuildPatchMesh, LeavesContactsAsideIfAsked) {
    const Scene scene = floorWithBoxes({{{{1, 1, 0}, {2, 2, 1}}}});
    Progress progress;
    MeshOptions options;
    options.patchLength = 0.8;
    options.splitContacts = false;
    MeshReport report;
    const PatchMesh mesh = buildPatchMesh(scene, options, progress, &report);
    EXPECT_EQ(report.contactPolygons, 0U);
    EXPECT_EQ(std::count(mesh.polygon.begin(), mesh.polygon.end(), 0U), 25);
    expectSoundMesh(scene, mesh);
}

TEST(BuildPatchMesh, DividesUnderBoxesThatShareAnEdgeOrACorner) {
    const Scene beside = floorWithBoxes({{{{1, 1, 0}, {2, 2, 1}}}, {{{2, 1.5F, 0}, {3, 2.5F, 1}}}});
    const Scene corner = floorWithBoxes({{{{1, 1, 0}, {2, 2, 1}}}, {{{2, 2, 0}, {3, 3, 1}}}});
    const Scene within = floorWithBoxes({{{{1, 1, 0}, {3, 3, 1}}}, {{{1.5F, 1.5F, 0}, {2, 2, 0.5F}}}});
    for (const Scene& scene : {beside, corner, within}) {
        for (const double length : {5.0, 0.3}) {
            MeshReport report;
            const PatchMesh mesh = meshWithLength(scene, length, &report);
            expectSoundMesh(scene, mesh);
            expectNoTVertex(scene, mesh);
            EXPECT_GE(report.contactPolygons, 1U);
            EXPECT_EQ(report.ignoredContactPolygons, 0U);
        }
    }
}

TEST(BuildPatchMesh, DividesWhereTheOutlinesOfBoxesCross) {
    const Scene scene = floorWithBoxes({{{{1, 1, 0}, {2, 2, 1}}}, {{{1.5F, 1.5F, 0}, {2.5F, 2.5F, 1}}}});
    for (const double length : {5.0, 0.3}) {
        MeshReport report;
        const PatchMesh mesh = meshWithLength(scene, length, &report);
        expectSoundMesh(scene, mesh);
        EXPECT_EQ(report.ignoredContactPolygons, 0U);
        EXPECT_EQ(report.undividedPolygons, 0U);
        EXPECT_NEAR(floorAreaWithin(mesh, {1, 1}, {2, 2}), 1.0, 1e-5); // floats of 4 m
        EXPECT_NEAR(floorAreaWithin(mesh, {1.5F, 1.5F}, {2.5F, 2.5F}), 1.0, 1e-5);
    }
}

TEST(BuildPatchMesh, DividesUnderABoxThatStandsAcrossTiles) {
    // 4 × 4 tiles of 1 m; the box covers parts of nine of them.
    Scene scene = emptyScene();
    for (int y = 0; y < 4; ++y)
        for (int x = 0; x < 4; ++x) {
            const auto fx = static_cast<float>(x);
            const auto fy = static_cast<float>(y);
            addPolygon(scene, Quad{{{fx, fy, 0}, {fx + 1, fy, 0}, {fx + 1, fy + 1, 0}, {fx, fy + 1, 0}}});
        }
    addBox(scene, {0.6F, 0.7F, 0}, {2.3F, 2.9F, 1}, false);
    scene = prepareScene(scene);
    for (const double length : {5.0, 0.3, 0.1}) {
        MeshReport report;
        const PatchMesh mesh = meshWithLength(scene, length, &report);
        expectSoundMesh(scene, mesh);
        expectNoTVertex(scene, mesh);
        double below = 0.0;
        for (std::size_t i = 0; i < mesh.size(); ++i) {
            const glm::vec3 c = mesh.centroid[i];
            if (mesh.polygon[i] < 16 && c.x > 0.6F && c.x < 2.3F && c.y > 0.7F && c.y < 2.9F)
                below += static_cast<double>(mesh.area[i]);
        }
        EXPECT_NEAR(below, 1.7 * 2.2, 1e-5) << length; // no patch lies half under the box; floats of 4 m
        EXPECT_EQ(report.contactPolygons, 8U);         // the ninth is covered whole
    }
}

TEST(BuildPatchMesh, LosesNothingWhereABoxStandsHalfOutside) {
    const Scene scene = floorWithBoxes({{{{3, 1, 0}, {5, 2, 1}}}, {{{-1, -1, 0}, {5, 0.5F, 1}}}});
    for (const double length : {5.0, 0.3}) {
        const PatchMesh mesh = meshWithLength(scene, length);
        expectSoundMesh(scene, mesh);
    }
}

/// The shape of a patch: smallest corner angle in degrees, and longest over shortest edge.
struct Shape {
    double angle, aspect;
};
Shape shapeOf(const PatchMesh& mesh, std::size_t patch) {
    double smallest = 180.0;
    const int count = mesh.cornerCount(patch);
    for (int k = 0; k < count; ++k) {
        const glm::dvec3 here(mesh.position(patch, k));
        const auto a = glm::normalize(glm::dvec3(mesh.position(patch, (k + 1) % count)) - here);
        const auto b = glm::normalize(glm::dvec3(mesh.position(patch, (k + count - 1) % count)) - here);
        smallest = std::min(smallest, std::acos(glm::clamp(glm::dot(a, b), -1.0, 1.0)) * 180.0 / std::numbers::pi);
    }
    return {smallest, longestEdge(mesh, patch) / shortestEdge(mesh, patch)};
}

TEST(BuildPatchMesh, MakesWellShapedPatchesAroundContacts) {
    const std::vector<std::pair<std::string, Scene>> scenes{{"room_with_turned_box", roomWithTurnedBox()},
                                                            {"cornell_box", dataScene("cornell_box.obj")}};
    for (const auto& [name, scene] : scenes) {
        for (const std::size_t patches : {2000U, 5000U, 20000U}) {
            Progress progress;
            MeshOptions options;
            options.patches = patches;
            const PatchMesh mesh = buildPatchMesh(scene, options, progress);
            Shape worst{180.0, 1.0};
            for (std::size_t patch = 0; patch < mesh.size(); ++patch) {
                const Shape shape = shapeOf(mesh, patch);
                worst = {std::min(worst.angle, shape.angle), std::max(worst.aspect, shape.aspect)};
            }
            const std::string key = name + "_" + std::to_string(patches);
            RecordProperty(key + "_smallest_angle", std::to_string(worst.angle));
            RecordProperty(key + "_largest_aspect", std::to_string(worst.aspect));
            // Inner vertices stay half a spacing away from lines, whose vertices are up to one spacing apart;
            // only at a corner of a footprint, or where two nearly touch, is there less room.
            EXPECT_GT(worst.angle, 10.0) << key;
            EXPECT_LT(worst.aspect, 5.0) << key;
        }
    }
}

} // namespace
} // namespace lambert
