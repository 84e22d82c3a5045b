#include "meshing/hidden_patches.h"

#include "mesh_checks.h"
#include "meshing/prepare.h"
#include "sample_scenes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>

namespace lambert {
namespace {

using Quad = std::array<glm::vec3, 4>;

/// A closed room of 4 m with a box on its floor; the room's polygons are 0 to 5, its floor 5, the box's 6 to 11, its bottom 11.
Scene roomWithBox(float above) {
    Scene scene = emptyScene();
    addBox(scene, {0.0F, 0.0F, 0.0F}, {4.0F, 4.0F, 4.0F}, true);
    for (Polygon& polygon : scene.polygons) std::reverse(polygon.vertices.begin(), polygon.vertices.end());
    addBox(scene, {1.0F, 1.3F, above}, {2.0F, 2.5F, 1.0F + above}, true);
    return scene;
}

/// By polygon, the area of its hidden patches, m².
std::vector<double> hiddenAreas(const Scene& scene, std::size_t patches) {
    Progress progress;
    MeshOptions options;
    options.patches = patches;
    const PatchMesh mesh = buildPatchMesh(scene, options, progress);
    const RayCaster rays(scene);
    const std::vector<bool> hidden = findHiddenPatches(rays, mesh, patchOptics(scene, mesh));
    EXPECT_EQ(hidden.size(), mesh.size());
    std::vector<double> areas(scene.polygons.size(), 0.0);
    for (std::size_t i = 0; i < mesh.size(); ++i)
        if (hidden[i]) areas[mesh.polygon[i]] += exactArea(mesh, i);
    return areas;
}

TEST(FindHiddenPatches, FindsTheUndersideOfABoxAndTheFloorBeneathIt) {
    for (const float unit : {1e-3F, 1.0F, 1e3F}) {
        for (const Scene& scene :
             {prepareScene(scaled(roomWithBox(0.0F), unit)), prepareScene(scaled(turned(roomWithBox(0.0F)), unit))}) {
            const std::vector<double> areas = hiddenAreas(scene, 800);
            const double footprint = 1.2 * static_cast<double>(unit) * static_cast<double>(unit);
            for (std::size_t polygon = 0; polygon < areas.size(); ++polygon)
                EXPECT_NEAR(areas[polygon], polygon == 5 || polygon == 11 ? footprint : 0.0, 1e-5 * footprint) // floats
                    << polygon << ", unit " << unit;
        }
    }
}

TEST(FindHiddenPatches, FindsNothingUnderABoxThatHovers) {
    const std::vector<double> areas = hiddenAreas(prepareScene(roomWithBox(0.01F)), 800);
    EXPECT_EQ(*std::max_element(areas.begin(), areas.end()), 0.0);
}

TEST(FindHiddenPatches, FindsWhereBoxesStandOnEachOther) {
    Scene scene = roomWithBox(0.0F);
    addBox(scene, {1.2F, 1.5F, 1.0F}, {1.7F, 2.1F, 1.5F}, true);
    const std::vector<double> areas = hiddenAreas(prepareScene(scene), 800);
    EXPECT_NEAR(areas[10], 0.3, 1e-5); // the lower box's top, the upper one's bottom
    EXPECT_NEAR(areas[17], 0.3, 1e-5);
}

// From inside either of two boxes that touch, rays may meet the other one's front.
TEST(FindHiddenPatches, FindsWhereThreeBoxesTouchEachOther) {
    Scene scene = roomWithBox(0.0F);
    addBox(scene, {1.0F, 1.3F, 1.0F}, {1.4F, 2.5F, 1.8F}, true); // a seat's back, and an arm before it
    addBox(scene, {1.4F, 1.3F, 1.0F}, {2.0F, 1.5F, 1.4F}, true);
    const std::vector<double> areas = hiddenAreas(prepareScene(scene), 1500);
    EXPECT_NEAR(areas[10], 0.4 * 1.2 + 0.6 * 0.2, 1e-5); // the seat
    EXPECT_NEAR(areas[17], 0.4 * 1.2, 1e-5);             // the bottoms of the others
    EXPECT_NEAR(areas[23], 0.6 * 0.2, 1e-5);
    double sides = 0.0;
    for (std::size_t polygon = 12; polygon < 24; ++polygon)
        sides += polygon == 17 || polygon == 23 ? 0.0 : areas[polygon];
    EXPECT_NEAR(sides, 2.0 * 0.2 * 0.4, 1e-5);
}

TEST(FindHiddenPatches, KeepsBothSidesOfAPartition) {
    Scene scene = roomWithBox(0.0F);
    // Two faces back to back, differently cut.
    addPolygon(scene, Quad{{{3.0F, 1.0F, 1.0F}, {3.0F, 2.0F, 1.0F}, {3.0F, 2.0F, 2.0F}, {3.0F, 1.0F, 2.0F}}});
    for (const float y : {1.0F, 1.5F})
        addPolygon(scene, Quad{{{3.0F, y, 1.0F}, {3.0F, y, 2.0F}, {3.0F, y + 0.5F, 2.0F}, {3.0F, y + 0.5F, 1.0F}}});
    const std::vector<double> areas = hiddenAreas(prepareScene(scene), 800);
    for (std::size_t polygon = 12; polygon < 15; ++polygon) EXPECT_EQ(areas[polygon], 0.0) << polygon;
}

TEST(FindHiddenPatches, FindsWhatLiesInsideButNoLamp) {
    Scene scene = roomWithBox(0.5F);
    addBox(scene, {1.4F, 1.7F, 0.8F}, {1.6F, 1.9F, 1.0F}, true); // in the box
    std::vector<double> areas = hiddenAreas(prepareScene(scene), 800);
    for (std::size_t polygon = 0; polygon < areas.size(); ++polygon)
        EXPECT_NEAR(areas[polygon], polygon < 12 ? 0.0 : 0.04, 1e-5) << polygon;
    scene.materials[0].emittedRadiance = Rgb(1.0F); // light that is lost on backs is to be told of
    areas = hiddenAreas(prepareScene(scene), 800);
    EXPECT_EQ(*std::max_element(areas.begin(), areas.end()), 0.0);
}

} // namespace
} // namespace lambert
