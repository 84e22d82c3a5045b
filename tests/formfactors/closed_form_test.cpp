#include "formfactors/closed_form.h"

#include "polygon_factor.h"

#include <glm/geometric.hpp>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <numbers>
#include <sstream>

namespace lambert {
namespace {

using Points = std::vector<glm::dvec3>;

nlohmann::json reference() {
    std::ifstream file(LAMBERT_DATA "/reference/analytic.json");
    return nlohmann::json::parse(file);
}

/// "2,.5,1" as numbers.
std::array<double, 3> sizes(const std::string& key) {
    std::istringstream text(key);
    std::array<double, 3> result{};
    for (double& number : result) {
        std::string word;
        std::getline(text, word, ',');
        number = std::stod(word);
    }
    return result;
}

Points reversed(Points points) {
    std::reverse(points.begin(), points.end());
    return points;
}

/// In the plane at height z, facing up.
Points rectangle(double x0, double x1, double y0, double y1, double z) {
    return {{x0, y0, z}, {x1, y0, z}, {x1, y1, z}, {x0, y1, z}};
}

Points regular(int n, double radius, double z) {
    Points points;
    for (int k = 0; k < n; ++k) {
        const double angle = 2.0 * std::numbers::pi * k / n;
        points.emplace_back(radius * std::cos(angle), radius * std::sin(angle), z);
    }
    return points;
}

// The file's values have ten digits, the smallest of them three zeros behind the point.
constexpr double kReferenceDigits = 1e-8;

void expectRelative(double found, double expected, double tolerance, const std::string& what) {
    EXPECT_NEAR(found / expected, 1.0, tolerance) << what << ": found " << found << ", expected " << expected;
}

TEST(ClosedForm, ParallelRectanglesAreHowells) {
    for (const auto& [key, value] : reference()["parallel_equal_rect (a,b,c):F12"].items()) {
        const auto [a, b, c] = sizes(key);
        const Points lower = rectangle(0, a, 0, b, 0);
        const Points upper = reversed(rectangle(0, a, 0, b, c));
        expectRelative(polygonToPolygon(lower, upper), value, kReferenceDigits, key);
        expectRelative(polygonToPolygon(upper, lower), value, kReferenceDigits, key);
    }
}

TEST(ClosedForm, PerpendicularRectanglesWithACommonEdgeAreHowells) {
    for (const auto& [key, value] : reference()["perp_common_edge (w,h,l): F from w-rect to h-rect"].items()) {
        const auto [w, h, l] = sizes(key);
        const Points floor = rectangle(0, w, 0, l, 0);
        const Points wall{{0, 0, 0}, {0, l, 0}, {0, l, h}, {0, 0, h}};
        expectRelative(polygonToPolygon(floor, wall), value, kReferenceDigits, key);
        expectRelative(polygonToPolygon(wall, floor) * h / w, value, kReferenceDigits, key + " back");
    }
}

// Formula of Howell's C-41, to all digits of double.
TEST(ClosedForm, DisksAsPolygonsConvergeWithSecondOrder) {
    for (const auto& [key, value] : reference()["coaxial_disks (r1,r2,h):F12"].items()) {
        const auto [r1, r2, h] = sizes(key);
        const double exact = [&, r1 = r1, r2 = r2, h = h] {
            const double x = 1.0 + (h * h + r2 * r2) / (r1 * r1);
            return 0.5 * (x - std::sqrt(x * x - 4.0 * (r2 * r2) / (r1 * r1)));
        }();
        expectRelative(exact, value, kReferenceDigits, key);
        const auto error = [&, r1 = r1, r2 = r2, h = h](int n) {
            return std::abs(polygonToPolygon(regular(n, r1, 0.0), reversed(regular(n, r2, h))) - exact);
        };
        const double order = std::log2(error(32) / error(64));
        EXPECT_NEAR(order, 2.0, 0.1) << key; // the next term of the error is of fourth order: 1/64² of it, times a few
    }
}

TEST(ClosedForm, DiskToRingAsPolygonsConvergesWithSecondOrder) {
    const auto values = reference()["disk_to_ring h=1 r=1: ring(.5..1), ring(1..2)"];
    const std::array<std::array<double, 2>, 2> rings{{{0.5, 1.0}, {1.0, 2.0}}};
    for (std::size_t k = 0; k < 2; ++k) {
        const auto factor = [&](int n) {
            const Points disk = regular(n, 1.0, 0.0);
            return polygonToPolygon(disk, reversed(regular(n, rings[k][1], 1.0))) -
                   polygonToPolygon(disk, reversed(regular(n, rings[k][0], 1.0)));
        };
        const double exact = values[k];
        // The two circles' errors may cancel to a higher order.
        EXPECT_GT(std::log2((factor(32) - exact) / (factor(64) - exact)), 1.9);
        // Richardson: the error's second order removed, its fourth order of 128 sides is left.
        expectRelative((4.0 * factor(128) - factor(64)) / 3.0, exact, 1e-6, "ring");
    }
}

TEST(ClosedForm, PointToPolygonIsLamberts) {
    const std::map<std::string, Points> shapes{{"[0,1]^2 z=1", rectangle(0, 1, 0, 1, 1)},
                                               {"[-.5,.5]^2 z=1", rectangle(-.5, .5, -.5, .5, 1)},
                                               {"[-1,1]^2 z=1", rectangle(-1, 1, -1, 1, 1)},
                                               {"tri 001 101 011", {{0, 0, 1}, {1, 0, 1}, {0, 1, 1}}},
                                               {"tri 101 011 -1-12", {{1, 0, 1}, {0, 1, 1}, {-1, -1, 2}}},
                                               {"x=1 y[0,1] z[0,1]", {{1, 0, 0}, {1, 0, 1}, {1, 1, 1}, {1, 1, 0}}},
                                               {"x=1 y[-1,1] z[0,2]", {{1, -1, 0}, {1, -1, 2}, {1, 1, 2}, {1, 1, 0}}}};
    for (const auto& [key, value] : reference()["point_to_polygon (dA at origin, +z)"].items()) {
        ASSERT_TRUE(shapes.contains(key)) << key;
        Points polygon = shapes.at(key);
        // Listed in either sense: the one whose front faces the element is meant.
        if (glm::dot(polygonAreaVector(polygon), -polygon[0]) < 0.0) polygon = reversed(polygon);
        expectRelative(pointToPolygon(glm::dvec3(0.0), {0, 0, 1}, polygon), value, kReferenceDigits, key);
        EXPECT_EQ(pointToPolygon(glm::dvec3(0.0), {0, 0, 1}, reversed(polygon)), 0.0) << key << " from behind";
        EXPECT_EQ(pointToPolygon(glm::dvec3(0.0), {0, 0, -1}, polygon), 0.0) << key << " below the horizon";
    }
}

TEST(ClosedForm, PolygonToPolygonMatchesTheIndependentValues) {
    const std::map<std::string, std::array<Points, 2>> pairs{
        {"right triangle (0,0,0)(1,0,0)(0,1,0) to its copy at z=1, facing",
         {Points{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, Points{{0, 1, 1}, {1, 0, 1}, {0, 0, 1}}}},
        {"unit square z=0 facing +z, to triangle (0,0,1)(1,1,2)(1,0,1) facing it",
         {rectangle(0, 1, 0, 1, 0), Points{{0, 0, 1}, {1, 1, 2}, {1, 0, 1}}}},
        {"unit square z=0 to square x[2,3] y[0,1] z=1, facing",
         {rectangle(0, 1, 0, 1, 0), reversed(rectangle(2, 3, 0, 1, 1))}},
        {"regular hexagons of circumradius 1, parallel, coaxial, at distance 1",
         {regular(6, 1.0, 0.0), reversed(regular(6, 1.0, 1.0))}}};
    for (const auto& [key, value] : reference()["polygon_polygon"].items()) {
        ASSERT_TRUE(pairs.contains(key)) << key;
        const auto& [from, to] = pairs.at(key);
        expectRelative(polygonToPolygon(from, to), value, kReferenceDigits, key);
    }
}

/// Gauss average of point-to-polygon over a convex quad's bilinear map.
double byQuadrature(const Points& from, const Points& to, int panels) {
    constexpr std::array<double, 4> nodes{-.861136311594052575, -.339981043584856265, .339981043584856265,
                                          .861136311594052575};
    constexpr std::array<double, 4> weights{.347854845137453857, .652145154862546143, .652145154862546143,
                                            .347854845137453857};
    const glm::dvec3 normal = glm::normalize(polygonAreaVector(from));
    double sum = 0.0;
    for (int cell = 0; cell < panels * panels; ++cell) {
        for (int k = 0; k < 16; ++k) {
            const auto i = static_cast<std::size_t>(k % 4);
            const auto j = static_cast<std::size_t>(k / 4);
            const double u = (cell % panels + 0.5 + 0.5 * nodes[i]) / panels;
            const double v = (cell / panels + 0.5 + 0.5 * nodes[j]) / panels; // NOLINT: integer division is meant
            const glm::dvec3 lower = (1.0 - u) * from[0] + u * from[1];
            const glm::dvec3 upper = (1.0 - u) * from[3] + u * from[2];
            const glm::dvec3 du = (1.0 - v) * (from[1] - from[0]) + v * (from[2] - from[3]);
            const double jacobian = glm::dot(glm::cross(du, upper - lower), normal);
            sum += weights[i] * weights[j] / 4.0 * jacobian * pointToPolygon((1.0 - v) * lower + v * upper, normal, to);
        }
    }
    return sum / (panels * panels) / glm::length(polygonAreaVector(from));
}

TEST(ClosedForm, ContourIntegralMatchesTheAreaIntegral) {
    const Points base{{0, 0, 0}, {1.3, .1, 0}, {1.1, .9, 0}, {-.2, 1.2, 0}};
    const std::array<Points, 4> others{Points{{2, 0, .5}, {2.5, 1, 1.5}, {2.2, .9, 2.5}},        // beside and above
                                       Points{{-3, -2, 4}, {-3, 2, 4}, {3, 2, 5}, {3, -2, 5}},   // a large tilted roof
                                       Points{{40, 30, 25}, {39.4, 30.8, 25}, {39.8, 29.9, 26}}, // far away
                                       Points{{.3, .3, .2}, {.3, .6, .2}, {.6, .6, .25}, {.6, .3, .25}}}; // close above
    for (const Points& other : others) {
        const double expected = std::max(byQuadrature(base, other, 24), byQuadrature(base, reversed(other), 24));
        const double found = std::max(polygonToPolygon(base, other), polygonToPolygon(base, reversed(other)));
        expectRelative(found, expected, 1e-9, "pair"); // 96 points a side, features of .2: far below
    }
}

TEST(ClosedForm, PolygonsThatReachBehindEachOtherAreClipped) {
    // A wall that runs through the floor's plane counts with its upper half only, one beside it likewise.
    const Points floor = rectangle(0, 1, 0, 1, 0);
    const Points wall{{0, 0, -1}, {0, 1, -1}, {0, 1, 1}, {0, 0, 1}};
    expectRelative(polygonToPolygon(floor, wall),
                   reference()["perp_common_edge (w,h,l): F from w-rect to h-rect"]["1,1,1"], kReferenceDigits,
                   "half wall");
    // A floor that reaches behind the wall counts only before it.
    const Points wideFloor = rectangle(-5, 1, 0, 1, 0);
    expectRelative(exchangeArea(wideFloor, wall), exchangeArea(floor, wall), 1e-12, "half floor");
}

TEST(ClosedForm, ClosedBoxesSumToOne) {
    const double x = 4.0, y = 3.0, z = 2.5;
    const std::array<Points, 6> faces{Points{{0, 0, 0}, {0, y, 0}, {0, y, z}, {0, 0, z}},
                                      Points{{x, 0, 0}, {x, 0, z}, {x, y, z}, {x, y, 0}},
                                      Points{{0, 0, 0}, {0, 0, z}, {x, 0, z}, {x, 0, 0}},
                                      Points{{0, y, 0}, {x, y, 0}, {x, y, z}, {0, y, z}},
                                      rectangle(0, x, 0, y, 0),
                                      reversed(rectangle(0, x, 0, y, z))};
    for (const Points& from : faces) {
        double sum = 0.0;
        for (const Points& to : faces)
            if (&to != &from) sum += polygonToPolygon(from, to);
        EXPECT_NEAR(sum, 1.0, 1e-12); // touching edges: tanh-sinh to 1e-13
    }
}

TEST(ClosedForm, ConcavePolygonsAreTheSumOfTheirParts) {
    // An L, its parts, and a wall that cuts through the L's plane of sight.
    const Points ell{{0, 0, 0}, {2, 0, 0}, {2, 1, 0}, {1, 1, 0}, {1, 2, 0}, {0, 2, 0}};
    const Points one = rectangle(0, 2, 0, 1, 0), two = rectangle(0, 1, 1, 2, 0);
    const Points tilted{{-1, 3, 1}, {3, -1, 1}, {2, 2, 3}};
    for (const Points& other : {tilted, reversed(tilted), reversed(rectangle(0, 2, 0, 2, .5))}) {
        EXPECT_NEAR(exchangeArea(ell, other), exchangeArea(one, other) + exchangeArea(two, other), 1e-12);
        EXPECT_NEAR(exchangeArea(other, ell), exchangeArea(ell, other), 1e-12);
    }
}

TEST(ClosedForm, DoesNotDependOnScaleOrPlace) {
    const Points a = rectangle(0, 1, 0, 1, 0);
    const Points b{{.2, .1, .5}, {.1, .9, .8}, {1.4, .5, 1.0}};
    const double expected = polygonToPolygon(a, b);
    ASSERT_GT(expected, 0.01);
    for (const double scale : {1e-8, 1e-3, 1e8}) {
        Points scaledA = a, scaledB = b;
        for (glm::dvec3& p : scaledA) p = scale * (p + glm::dvec3(10, -20, 30));
        for (glm::dvec3& p : scaledB) p = scale * (p + glm::dvec3(10, -20, 30));
        // Thirty sizes away from the origin costs a digit and a half.
        expectRelative(polygonToPolygon(scaledA, scaledB), expected, 1e-11, std::to_string(scale));
    }
}

TEST(ClosedForm, CloseGapsAreNoTrouble) {
    // Parallel unit squares a millionth apart: F = 1 − (2/π)·h·(ln(4/h²)... )→ 1 − 4 h ln(1/h)/π·(1 + o(1)).
    const double h = 1e-6;
    const double loss = 1.0 - polygonToPolygon(rectangle(0, 1, 0, 1, 0), reversed(rectangle(0, 1, 0, 1, h)));
    EXPECT_GT(loss, 0.0);
    EXPECT_LT(loss, 1e-4);
    // Coplanar and back to back: nothing.
    EXPECT_EQ(polygonToPolygon(rectangle(0, 1, 0, 1, 0), rectangle(2, 3, 0, 1, 0)), 0.0);
    EXPECT_EQ(polygonToPolygon(rectangle(0, 1, 0, 1, 0), rectangle(0, 1, 0, 1, 1)), 0.0);
}

TEST(ClosedForm, PointSeesHalfOfItsHorizonWall) {
    // An infinite wall beside an element fills half of what it sees; this one is 1000 sizes large: 1/1000 is missing.
    const double size = 1e3;
    const Points wall{{.001, -size, 0}, {.001, -size, size}, {.001, size, size}, {.001, size, 0}};
    const double found = std::max(pointToPolygon(glm::dvec3(0.0), {0, 0, 1}, wall),
                                  pointToPolygon(glm::dvec3(0.0), {0, 0, 1}, reversed(wall)));
    EXPECT_NEAR(found, 0.5, 1e-5);
}

} // namespace
} // namespace lambert
