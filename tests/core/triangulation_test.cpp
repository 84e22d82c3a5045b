#include "core/triangulation.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <random>
#include <set>

namespace lambert {
namespace {

using Points = std::vector<glm::dvec2>;
using Lines = std::vector<std::array<std::uint32_t, 2>>;
using Triangles = std::vector<std::array<std::uint32_t, 3>>;

double signedArea(const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& c) {
    return 0.5 * ((b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x));
}

double borderArea(const Points& points, std::size_t borderCount) {
    double area = 0.0;
    for (std::size_t i = 0; i < borderCount; ++i) area += signedArea({0, 0}, points[i], points[(i + 1) % borderCount]);
    return area;
}

std::set<std::pair<std::uint32_t, std::uint32_t>> edgesOf(const Triangles& triangles) {
    std::set<std::pair<std::uint32_t, std::uint32_t>> edges;
    for (const auto& t : triangles)
        for (std::size_t k = 0; k < 3; ++k) edges.insert(std::minmax(t[k], t[(k + 1) % 3]));
    return edges;
}

/// What must hold for every result: counter-clockwise, all points used, as many triangles as Euler demands,
/// the area of the border, and all constraints among the edges.
void expectCovers(const Points& points, std::size_t borderCount, const Lines& constraints = {}) {
    const auto triangles = triangulatePolygon(points, borderCount, constraints);
    ASSERT_TRUE(triangles.has_value());
    double area = 0.0;
    std::set<std::uint32_t> used;
    for (const auto& t : *triangles) {
        const double one = signedArea(points[t[0]], points[t[1]], points[t[2]]);
        EXPECT_GT(one, 0.0);
        area += one;
        used.insert(t.begin(), t.end());
    }
    const double expected = borderArea(points, borderCount);
    EXPECT_NEAR(area, expected, 1e-12 * expected); // some roundings of double per triangle
    EXPECT_EQ(used.size(), points.size());
    EXPECT_EQ(triangles->size(), 2 * points.size() - borderCount - 2);
    const auto edges = edgesOf(*triangles);
    for (const auto& [a, b] : constraints) EXPECT_TRUE(edges.contains(std::minmax(a, b))) << a << "–" << b;
    for (std::uint32_t i = 0; i < borderCount; ++i)
        EXPECT_TRUE(edges.contains(std::minmax(i, static_cast<std::uint32_t>((i + 1) % borderCount)))) << i;
}

const Points kSquare{{0, 0}, {4, 0}, {4, 4}, {0, 4}};

Points squareWith(const Points& inside) {
    Points points = kSquare;
    points.insert(points.end(), inside.begin(), inside.end());
    return points;
}

TEST(TriangulatePolygon, CoversATriangle) { expectCovers({{0, 0}, {1, 0}, {0, 1}}, 3); }

TEST(TriangulatePolygon, CoversASquare) { expectCovers(kSquare, 4); }

TEST(TriangulatePolygon, CoversAConcavePolygon) {
    expectCovers({{0, 0}, {2, 0}, {2, 1}, {1, 1}, {1, 2}, {0, 2}}, 6);
    expectCovers({{0, 0}, {5, 0}, {5, 3}, {4, 3}, {4, 1}, {1, 1}, {1, 3}, {0, 3}}, 8); // U
}

TEST(TriangulatePolygon, KeepsPointsOnStraightBorders) {
    expectCovers({{0, 0}, {1, 0}, {2, 0}, {3, 0}, {4, 0}, {4, 4}, {3, 4}, {0, 4}, {0, 1}}, 9);
}

TEST(TriangulatePolygon, KeepsPointsOnStraightBordersOfATurnedPolygon) {
    // Rounding puts the points on either side of the line.
    for (int turn = 1; turn < 12; ++turn) {
        const double angle = 0.3 * turn;
        Points points;
        for (int side = 0; side < 4; ++side)
            for (int i = 0; i < 10; ++i) {
                const double s = 0.1 * i - 0.5;
                const glm::dvec2 p[4]{{s, -0.5}, {0.5, s}, {-s, 0.5}, {-0.5, -s}};
                points.emplace_back(std::cos(angle) * p[side].x - std::sin(angle) * p[side].y,
                                    std::sin(angle) * p[side].x + std::cos(angle) * p[side].y);
            }
        const auto triangles = triangulatePolygon(points, points.size());
        ASSERT_TRUE(triangles.has_value());
        double area = 0.0;
        for (const auto& t : *triangles) area += signedArea(points[t[0]], points[t[1]], points[t[2]]);
        EXPECT_NEAR(area, 1.0, 1e-12);
    }
}

TEST(TriangulatePolygon, UsesPointsInside) { expectCovers(squareWith({{1, 1}, {3, 1}, {2, 2.5}}), 4); }

TEST(TriangulatePolygon, KeepsLinesInside) {
    const Points points = squareWith({{1, 1}, {3, 1.1}, {2, 1.2}});
    expectCovers(points, 4, {{4, 5}});         // passes close under the third
    expectCovers(points, 4, {{0, 4}, {5, 2}}); // from the border
}

TEST(TriangulatePolygon, KeepsALineFromBorderToBorder) {
    expectCovers({{0, 0}, {1, 0}, {4, 0}, {4, 4}, {3, 4}, {0, 4}}, 6, {{1, 4}});
    expectCovers(kSquare, 4, {{0, 2}});
    expectCovers(kSquare, 4, {{1, 3}});
}

TEST(TriangulatePolygon, CoversTheInsideOfClosedLinesToo) {
    const Points points = squareWith({{1, 1}, {3, 1}, {3, 3}, {1, 3}, {2, 2}});
    expectCovers(points, 4, {{4, 5}, {5, 6}, {6, 7}, {7, 4}});                 // a footprint
    expectCovers(points, 4, {{4, 5}, {5, 8}, {8, 4}, {6, 8}, {8, 7}, {7, 6}}); // two that meet in a point
}

TEST(TriangulatePolygon, CoversAFootprintThatTouchesTheBorder) {
    Points points{{0, 0}, {1, 0}, {3, 0}, {4, 0}, {4, 4}, {0, 4}, {1, 2}, {3, 2}};
    expectCovers(points, 6, {{1, 6}, {6, 7}, {7, 2}});
    expectCovers(points, 6, {{1, 2}, {1, 6}, {6, 7}, {7, 2}}); // a line along the border changes nothing
}

TEST(TriangulatePolygon, DividesALineThatPassesThroughAPoint) {
    const Points points = squareWith({{1, 1}, {2, 2}, {3, 3}});
    const auto triangles = triangulatePolygon(points, 4, Lines{{0, 2}});
    ASSERT_TRUE(triangles.has_value());
    const auto edges = edgesOf(*triangles);
    for (const auto& edge : {std::pair(0U, 4U), std::pair(4U, 5U), std::pair(5U, 6U), std::pair(2U, 6U)})
        EXPECT_TRUE(edges.contains(edge)) << edge.first << "–" << edge.second;
}

TEST(TriangulatePolygon, RefusesLinesThatCross) {
    EXPECT_FALSE(triangulatePolygon(kSquare, 4, Lines{{0, 2}, {1, 3}}).has_value());
    EXPECT_FALSE(
        triangulatePolygon(squareWith({{1, 1}, {3, 3}, {1, 3}, {3, 1}}), 4, Lines{{4, 5}, {6, 7}}).has_value());
}

TEST(TriangulatePolygon, RefusesALineAcrossTheBorder) {
    // From arm to arm of a U.
    const Points points{{0, 0}, {5, 0}, {5, 3}, {4, 3}, {4, 1}, {1, 1}, {1, 3}, {0, 3}, {0.5, 2}, {4.5, 2}};
    EXPECT_FALSE(triangulatePolygon(points, 8, Lines{{8, 9}}).has_value());
}

TEST(TriangulatePolygon, RefusesABorderThatCrossesItself) {
    EXPECT_FALSE(triangulatePolygon(Points{{0, 0}, {4, 4}, {4, 0}, {0, 4}}, 4).has_value());
}

TEST(TriangulatePolygon, RefusesCoincidingPoints) {
    EXPECT_FALSE(triangulatePolygon(Points{{0, 0}, {4, 0}, {4, 0}, {4, 4}, {0, 4}}, 5).has_value());
    EXPECT_FALSE(triangulatePolygon(squareWith({{1, 1}, {2, 2}, {1, 1}}), 4).has_value());
    EXPECT_FALSE(triangulatePolygon(squareWith({{4, 4}}), 4).has_value());
}

double coveredArea(const Points& points) {
    const auto triangles = triangulatePolygon(points, points.size());
    if (!triangles) return -1.0;
    double area = 0.0;
    for (const auto& t : *triangles) {
        const double part = signedArea(points[t[0]], points[t[1]], points[t[2]]);
        EXPECT_GT(part, 0.0);
        area += part;
    }
    return area;
}

// Small integers: the areas are exact.
TEST(TriangulatePolygon, LeavesOutAHoleAtABridge) {
    EXPECT_EQ(coveredArea({{0, 0}, {4, 0}, {4, 4}, {0, 4}, {0, 0}, {1, 1}, {1, 3}, {3, 3}, {3, 1}, {1, 1}}), 12.0);
    // Two holes: the second bridge begins at the first hole.
    const Points twoHoles{{0, 0}, {8, 0}, {8, 4}, {0, 4}, {0, 0}, {1, 1}, {1, 3}, {3, 3},
                          {3, 1}, {5, 1}, {5, 3}, {7, 3}, {7, 1}, {5, 1}, {3, 1}, {1, 1}};
    EXPECT_EQ(coveredArea(twoHoles), 24.0);
    // The bridge passes through a corner of the hole.
    EXPECT_EQ(coveredArea({{0, 0}, {4, 0}, {4, 4}, {0, 4}, {0, 0}, {3, 3}, {3, 1}, {1, 1}, {1, 3}, {3, 3}}), 12.0);
}

TEST(TriangulatePolygon, CoversBothPartsOfABorderThatTouchesItself) {
    // Two squares that share a corner; then a corner on an edge.
    EXPECT_EQ(coveredArea({{0, 0}, {2, 0}, {2, 2}, {4, 2}, {4, 4}, {2, 4}, {2, 2}, {0, 2}}), 8.0);
    EXPECT_EQ(coveredArea({{0, 0}, {4, 0}, {4, 4}, {3, 4}, {2, 0}, {1, 4}, {0, 4}}), 12.0);
    // A spike out and back has no area.
    EXPECT_EQ(coveredArea({{0, 0}, {2, 0}, {2, 2}, {3, 3}, {2, 2}, {0, 2}}), 4.0);
}

TEST(TriangulatePolygon, RefusesABorderThatCoversSomethingTwiceOrClockwise) {
    EXPECT_EQ(coveredArea({{0, 0}, {4, 0}, {4, 4}, {0, 4}, {0, 0}, {1, 1}, {3, 1}, {3, 3}, {1, 3}, {1, 1}}), -1.0);
    EXPECT_EQ(coveredArea({{0, 0}, {0, 4}, {4, 4}, {4, 0}}), -1.0);
    // Two squares that share a corner, one of them clockwise.
    EXPECT_EQ(coveredArea({{0, 0}, {4, 0}, {4, 4}, {4, 6}, {6, 6}, {6, 4}, {4, 4}, {0, 4}}), -1.0);
}

TEST(TriangulatePolygon, RefusesWhatHasNoArea) {
    EXPECT_FALSE(triangulatePolygon(Points{{0, 0}, {1, 0}, {2, 0}}, 3).has_value());
    EXPECT_FALSE(triangulatePolygon(Points{}, 0).has_value());
}

TEST(TriangulatePolygon, CoversRandomStarsWithPointsInside) {
    for (std::uint32_t seed = 1; seed <= 100; ++seed) {
        SCOPED_TRACE(testing::Message() << "seed " << seed);
        std::mt19937 random(seed);
        std::uniform_real_distribution<double> uniform(0.0, 1.0);
        const std::size_t count = 3 + random() % 60;
        Points points;
        for (std::size_t i = 0; i < count; ++i) {
            const double angle = 2.0 * std::numbers::pi * static_cast<double>(i) / static_cast<double>(count);
            const double radius = 1.0 + uniform(random);
            points.emplace_back(radius * std::cos(angle), radius * std::sin(angle));
        }
        // The triangle of three border points of radius 1 or more holds a disc of radius 1/2.
        for (int i = 0; i < 50; ++i) {
            const double angle = 2.0 * std::numbers::pi * uniform(random);
            points.push_back(0.49 * uniform(random) * glm::dvec2(std::cos(angle), std::sin(angle)));
        }
        expectCovers(points, count);
    }
}

TEST(TriangulatePolygon, IsTheSameAtAnyScale) {
    const Points points = squareWith({{1, 1}, {3, 1.1}, {2, 2.5}});
    const auto expected = triangulatePolygon(points, 4, Lines{{4, 6}});
    for (const double scale : {0x1p-30, 0x1p30}) { // powers of two, so that nothing is rounded
        Points scaled = points;
        for (glm::dvec2& p : scaled) p *= scale;
        EXPECT_EQ(triangulatePolygon(scaled, 4, Lines{{4, 6}}), expected);
    }
}

double areaOf(const Points& points, const Triangles& triangles) {
    double area = 0.0;
    for (const auto& [a, b, c] : triangles) {
        EXPECT_GT(signedArea(points[a], points[b], points[c]), 0.0);
        area += signedArea(points[a], points[b], points[c]);
    }
    return area;
}

const Points kFrame = {{0, 0}, {4, 0}, {4, 4}, {0, 4}, {1, 1}, {1, 3}, {3, 3}, {3, 1}};

TEST(TriangulateLoops, LeavesOutHolesWhicheverWayTheyTurn) {
    Points turned = kFrame;
    std::reverse(turned.begin() + 4, turned.end());
    for (const Points& points : {kFrame, turned}) {
        const auto triangles = triangulateLoops(points, std::array<std::size_t, 2>{4, 4});
        ASSERT_TRUE(triangles.has_value());
        EXPECT_EQ(triangles->size(), 8U); // vertices + 2 holes - 2
        EXPECT_EQ(areaOf(points, *triangles), 12.0);
    }
}

TEST(TriangulateLoops, ASeamIsNoEdge) {
    Points seam(kFrame);
    seam.push_back(kFrame[4]);
    seam.push_back(kFrame[3]);
    const auto triangles = triangulateLoops(seam, std::array<std::size_t, 1>{10});
    ASSERT_TRUE(triangles.has_value());
    EXPECT_EQ(areaOf(seam, *triangles), 12.0);
}

TEST(TriangulateLoops, HolesMayTouchTheBorderAndEachOther) {
    const Points points = {{0, 0}, {4, 0}, {4, 4}, {0, 4}, {0, 0}, {1, 2}, {2, 1}, {1, 2}, {2, 3}, {2, 2}};
    const auto triangles = triangulateLoops(points, std::array<std::size_t, 3>{4, 3, 3});
    ASSERT_TRUE(triangles.has_value());
    EXPECT_NEAR(areaOf(points, *triangles), 16.0 - 1.5 - 0.5, 1e-14);
}

TEST(TriangulateLoops, FindsNothingWhereLoopsCrossOrHaveNoArea) {
    const Points crossing = {{0, 0}, {4, 0}, {4, 4}, {0, 4}, {3, 1}, {5, 1}, {5, 2}};
    EXPECT_FALSE(triangulateLoops(crossing, std::array<std::size_t, 2>{4, 3}).has_value());
    const Points line = {{0, 0}, {1, 1}, {2, 2}};
    EXPECT_FALSE(triangulateLoops(line, std::array<std::size_t, 1>{3}).has_value());
    const Points thereAndBack = {{0, 0}, {1, 0}, {1, 1}, {1, 0}};
    EXPECT_FALSE(triangulateLoops(thereAndBack, std::array<std::size_t, 1>{4}).has_value());
}

} // namespace
} // namespace lambert
