#include "scene/scene_builder.h"

#include "core/error.h"
#include "reader_checks.h"

#include <glm/vec2.hpp>

#include <cmath>
#include <limits>
#include <numeric>

namespace lambert {
namespace {

class SceneBuilderTest : public testing::Test {
protected:
    void add(const std::vector<glm::dvec3>& points) {
        std::vector<std::uint32_t> vertices;
        for (const glm::dvec3& p : points) vertices.push_back(builder.addPosition(p));
        builder.addPolygon(vertices, 0, 0);
    }
    void addTriangle() { add({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}); }

    SceneBuilder builder{"file", {}};
};

TEST_F(SceneBuilderTest, KeepsAPlanarConvexQuadWithItsVertexOrder) {
    add({{0, 0, 0}, {2, 0, 0}, {2, 3, 0}, {0, 3, 0}});
    const ReadResult result = builder.finish();
    ASSERT_EQ(result.scene.polygons.size(), 1U);
    EXPECT_EQ(result.scene.polygons[0].vertices, (std::array<std::uint32_t, 4>{0, 1, 2, 3}));
    EXPECT_EQ(result.report.splitPolygons, 0U);
}

TEST_F(SceneBuilderTest, SplitsAQuadOffPlaneAlongItsShorterDiagonal) {
    add({{0, 0, 0}, {2, 0, 0}, {3, 1, 0.01}, {0, 1, 0}}); // 1-3 is shorter than 0-2
    const ReadResult result = builder.finish();
    ASSERT_EQ(result.scene.polygons.size(), 2U);
    EXPECT_EQ(result.scene.polygons[0].vertices, (std::array<std::uint32_t, 4>{1, 2, 3, kNone}));
    EXPECT_EQ(result.scene.polygons[1].vertices, (std::array<std::uint32_t, 4>{1, 3, 0, kNone}));
    EXPECT_EQ(result.report.splitPolygons, 1U);
    EXPECT_EQ(result.report.inputPolygons, 1U);
}

TEST_F(SceneBuilderTest, QuadsSplitAboveOneHundredThousandthOfTheirDiagonal) {
    // Lifting one vertex by h moves all four h/4 off the mean plane; the diagonal is sqrt(2).
    add({{0, 0, 0}, {1, 0, 0}, {1, 1, 0.9 * 4e-5 * std::sqrt(2.0)}, {0, 1, 0}});
    add({{0, 0, 0}, {1, 0, 0}, {1, 1, 1.1 * 4e-5 * std::sqrt(2.0)}, {0, 1, 0}});
    EXPECT_EQ(builder.finish().report.splitPolygons, 1U);
}

TEST_F(SceneBuilderTest, SplitsAConcaveQuadWithoutChangingItsArea) {
    add({{0, 0, 0}, {4, 0, 0}, {1, 1, 0}, {0, 4, 0}});
    const ReadResult result = builder.finish();
    EXPECT_EQ(result.scene.polygons.size(), 2U);
    EXPECT_NEAR(totalArea(result.scene), 4.0, 1e-6);
    for (const Polygon& polygon : result.scene.polygons) EXPECT_GT(areaVector(result.scene, polygon).z, 0.0F);
}

TEST_F(SceneBuilderTest, SplitsAQuadWithAStraightCorner) {
    add({{1, 0, 0}, {2, 0, 0}, {1, 2, 0}, {0, 0, 0}});
    const ReadResult result = builder.finish();
    EXPECT_EQ(result.scene.polygons.size(), 2U);
    EXPECT_NEAR(totalArea(result.scene), 2.0, 1e-6);
}

TEST_F(SceneBuilderTest, SplitsAConcavePolygonInAnyPlaneWithoutChangingAreaOrFront) {
    // A plus sign of five unit squares, in a plane that is aligned with nothing.
    const std::vector<glm::dvec2> plus = {{1, 0}, {2, 0}, {2, 1}, {3, 1}, {3, 2}, {2, 2},
                                          {2, 3}, {1, 3}, {1, 2}, {0, 2}, {0, 1}, {1, 1}};
    const glm::dvec3 u = glm::normalize(glm::dvec3(1, 2, 3));
    const glm::dvec3 v = glm::normalize(glm::cross(glm::dvec3(-3, 1, 2), u));
    std::vector<glm::dvec3> points;
    for (const glm::dvec2& p : plus) points.push_back(p.x * u + p.y * v);
    add(points);
    const ReadResult result = builder.finish();
    EXPECT_EQ(result.scene.polygons.size(), 10U);
    EXPECT_EQ(result.report.splitPolygons, 1U);
    EXPECT_NEAR(totalArea(result.scene), 5.0, 1e-5); // single precision
    for (const Polygon& polygon : result.scene.polygons)
        EXPECT_GT(glm::dot(glm::dvec3(areaVector(result.scene, polygon)), glm::cross(u, v)), 0.0);
}

TEST_F(SceneBuilderTest, KeepsTheAreaOfPolygonsThatTouchThemselves) {
    // A square hole at a bridge, and two squares with a common corner, in a plane that is aligned with nothing.
    const glm::dvec3 u = glm::normalize(glm::dvec3(1, 2, 3));
    const glm::dvec3 v = glm::normalize(glm::cross(glm::dvec3(-3, 1, 2), u));
    const std::vector<std::vector<glm::dvec2>> polygons = {
        {{0, 0}, {4, 0}, {4, 4}, {0, 4}, {0, 0}, {1, 1}, {1, 3}, {3, 3}, {3, 1}, {1, 1}},
        {{0, 0}, {2, 0}, {2, 2}, {4, 2}, {4, 4}, {2, 4}, {2, 2}, {0, 2}}};
    for (const std::vector<glm::dvec2>& polygon : polygons) {
        std::vector<glm::dvec3> points;
        for (const glm::dvec2& p : polygon) points.push_back(p.x * u + p.y * v);
        add(points);
    }
    const ReadResult result = builder.finish();
    EXPECT_NEAR(totalArea(result.scene), 12.0 + 8.0, 1e-5); // single precision
    EXPECT_TRUE(result.report.warnings.empty());
}

TEST_F(SceneBuilderTest, SplitsASelfCrossingPolygonIntoAFanWithAWarning) {
    add({{0, 0, 0}, {2, 2, 0}, {2, 0, 0}, {0, 2, 0}, {-1, 3, 0}});
    const ReadResult result = builder.finish();
    EXPECT_GT(result.scene.polygons.size(), 0U);
    EXPECT_TRUE(hasWarning(result, "file: 1 polygons touch or cross themselves"));
}

TEST_F(SceneBuilderTest, AQuadWithARepeatedVertexBecomesATriangle) {
    add({{0, 0, 0}, {1, 0, 0}, {1, 0, 0}, {0, 1, 0}});
    add({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 0}});
    const ReadResult result = builder.finish();
    ASSERT_EQ(result.scene.polygons.size(), 2U);
    EXPECT_FALSE(result.scene.polygons[0].isQuad());
    EXPECT_FALSE(result.scene.polygons[1].isQuad());
    EXPECT_EQ(result.report.degeneratePolygons, 0U);
}

TEST_F(SceneBuilderTest, CountsEachKindOfDroppedPolygon) {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    addTriangle();
    add({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}});                       // on a line
    add({{0, 0, 0}, {1, 0, 0}, {1, 0, 0}});                       // two vertices
    add({{0, 0, 0}, {1e-20, 0, 0}, {0, 1e-20, 0}});               // the area is not a normal number
    add({{0, 0, 0}, {1e15, 0, 0}, {0, 1e15, 0}});                 // squared area overflows
    add({{0, 0, 0}, {1, 0, 0}, {0, 0, 0}, {0, 1, 0}});            // there and back
    add({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}, {4, 0, 0}}); // five on a line
    add({{0, 0, 0}, {nan, 0, 0}, {0, 1, 0}});
    add({{0, 0, 0}, {1e300, 0, 0}, {0, 1, 0}}); // overflows to infinity
    const ReadResult result = builder.finish();
    EXPECT_EQ(result.scene.polygons.size(), 1U);
    EXPECT_EQ(result.report.inputPolygons, 9U);
    EXPECT_EQ(result.report.degeneratePolygons, 6U);
    EXPECT_EQ(result.report.nonFinitePolygons, 2U);
}

TEST_F(SceneBuilderTest, RefusesASceneFromWhichNothingIsLeft) {
    EXPECT_THROW(SceneBuilder("file", {}).finish(), InputError);
    add({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}});
    try {
        builder.finish();
        FAIL();
    } catch (const InputError& error) {
        EXPECT_STREQ(error.what(), "file: found no usable polygon among 1: 0 with a coordinate that is not finite, "
                                   "1 without area");
    }
}

TEST_F(SceneBuilderTest, ClampsMaterialsWithOneWarningEach) {
    builder.addMaterial({.name = "fine"});
    builder.addMaterial({.name = "odd", .reflectance = Rgb(1.5F, -1.0F, 0.5F), .emittedRadiance = Rgb(-1, 2, 0)});
    addTriangle();
    const ReadResult result = builder.finish();
    EXPECT_EQ(result.scene.materials[1].reflectance, Rgb(0.99F, 0.0F, 0.5F));
    EXPECT_EQ(result.scene.materials[1].emittedRadiance, Rgb(0, 2, 0));
    ASSERT_EQ(result.report.warnings.size(), 1U);
    EXPECT_TRUE(hasWarning(result, "file: material \"odd\""));
}

TEST_F(SceneBuilderTest, ClampsEmissionThatKernelsCannotSum) {
    builder.addMaterial({.name = "nova", .emittedRadiance = Rgb(3e38F)});
    addTriangle();
    const ReadResult result = builder.finish();
    EXPECT_EQ(result.scene.materials[0].emittedRadiance, Rgb(1e30F));
    EXPECT_TRUE(hasWarning(result, "file: material \"nova\""));
}

TEST_F(SceneBuilderTest, RefusesMorePolygonsThanAllowedAndNamesTheOption) {
    SceneBuilder small("file", {.mostPolygons = 2});
    for (const glm::dvec3& p : {glm::dvec3(0), glm::dvec3(1, 0, 0), glm::dvec3(0, 1, 0)}) small.addPosition(p);
    constexpr std::array<std::uint32_t, 3> kTriangle{0, 1, 2};
    small.addPolygon(kTriangle, 0, 0);
    small.addPolygon(kTriangle, 0, 0);
    try {
        small.addPolygon(kTriangle, 0, 0);
        FAIL();
    } catch (const InputError& error) {
        EXPECT_STREQ(error.what(), "file: found more polygons than allowed (2); --most-polygons allows more");
    }
}

TEST_F(SceneBuilderTest, AllowsAMillionPolygonsAndOneForEachByteOfTheSceneFiles) {
    constexpr std::array<std::uint32_t, 3> kTriangle{0, 1, 2};
    for (const glm::dvec3& p : {glm::dvec3(0), glm::dvec3(1, 0, 0), glm::dvec3(0, 1, 0)}) builder.addPosition(p);
    builder.countBytes(3);
    const auto addAll = [&] {
        for (std::size_t k = 0; k < (1U << 20) + 3; ++k) builder.addPolygon(kTriangle, 0, 0);
    };
    EXPECT_NO_THROW(addAll());
    EXPECT_THROW(builder.addPolygon(kTriangle, 0, 0), InputError);
}

TEST_F(SceneBuilderTest, TwoSidedOptionAppliesToEveryMaterial) {
    SceneBuilder twoSided("file", {.twoSided = true});
    twoSided.addMaterial({});
    for (const glm::dvec3& p : {glm::dvec3(0), glm::dvec3(1, 0, 0), glm::dvec3(0, 1, 0)}) twoSided.addPosition(p);
    twoSided.addPolygon(std::array<std::uint32_t, 3>{0, 1, 2}, 0, 0);
    EXPECT_TRUE(twoSided.finish().scene.materials[0].twoSided);
}

TEST_F(SceneBuilderTest, TreatsScaledPolygonsAlike) {
    for (const double scale : {1e-10, 1e-8, 1.0, 1e8}) {
        SceneBuilder scaled("file", {});
        for (const glm::dvec3& p : {glm::dvec3(0, 0, 0), glm::dvec3(1, 0, 0), glm::dvec3(1, 1, 0), glm::dvec3(0, 1, 0),
                                    glm::dvec3(-1, 0.5, 0)})
            scaled.addPosition(p * scale);
        scaled.addPolygon(std::array<std::uint32_t, 4>{0, 1, 2, 3}, 0, 0);
        scaled.addPolygon(std::array<std::uint32_t, 5>{0, 1, 2, 3, 4}, 0, 0);
        const ReadResult result = scaled.finish();
        EXPECT_EQ(result.scene.polygons.size(), 4U) << scale;
        EXPECT_NEAR(totalArea(result.scene) / (scale * scale), 2.5, 1e-5) << scale; // single precision
    }
}

// A patch of a scene that is accepted must itself be, or a baked scene could not be read.
TEST_F(SceneBuilderTest, AcceptsAPatchOfTheSmallestSceneAndRefusesSmallerScenes) {
    const auto addCorner = [](SceneBuilder& to, double size, double x) {
        const auto a = to.addPosition({x, 0, 0});
        const std::array triangle{a, to.addPosition({x + size, 0, 0}), to.addPosition({x, size, 0})};
        to.addPolygon(triangle, 0, 0);
    };
    addCorner(builder, 1e-10, 0.0);
    addCorner(builder, 1e-15, 0.0);
    EXPECT_EQ(builder.finish().scene.polygons.size(), 2U);

    SceneBuilder tooSmall("file", {});
    tooSmall.addMaterial({});
    addCorner(tooSmall, 5e-11, 1.0); // the corners are one in single precision
    EXPECT_NE(tooSmall.finish().report.neededOrigin, glm::dvec3(0.0)); // to be read again, about itself
    SceneBuilder alsoTooSmall("file", {});
    alsoTooSmall.addMaterial({});
    addCorner(alsoTooSmall, 5e-11, 0.0);
    try {
        alsoTooSmall.finish();
        ADD_FAILURE() << "no error";
    } catch (const InputError& error) {
        EXPECT_NE(std::string(error.what()).find("found a scene of 7.07e-11 m, expected at least 1e-10 m"),
                  std::string::npos)
            << error.what();
    }
}

} // namespace
} // namespace lambert
