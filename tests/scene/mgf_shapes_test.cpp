#include "scene/mgf/shapes.h"

#include "scene/scene.h"

#include <glm/geometric.hpp>
#include <glm/gtc/constants.hpp>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <map>

namespace lambert {
namespace {

constexpr double kPi = glm::pi<double>();

glm::dvec3 areaVector(const Facets& facets, const std::array<std::uint32_t, 4>& face) {
    const auto& p = facets.points;
    const glm::dvec3 first = 0.5 * glm::cross(p[face[1]] - p[face[0]], p[face[2]] - p[face[0]]);
    if (face[3] == kNone) return first;
    return first + 0.5 * glm::cross(p[face[2]] - p[face[0]], p[face[3]] - p[face[0]]);
}

double area(const Facets& facets) {
    double sum = 0.0;
    for (const auto& face : facets.faces) sum += glm::length(areaVector(facets, face));
    return sum;
}

/// Positive if the fronts of a closed surface look outwards.
double volume(const Facets& facets) {
    double sum = 0.0;
    for (const auto& face : facets.faces) sum += glm::dot(facets.points[face[0]], areaVector(facets, face)) / 3.0;
    return sum;
}

/// Directed edges that no other face runs through the other way.
std::size_t unmatchedEdges(const Facets& facets) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;
    for (const auto& face : facets.faces) {
        const std::size_t size = face[3] == kNone ? 3 : 4;
        for (std::size_t k = 0; k < size; ++k) {
            ++edges[{face[k], face[(k + 1) % size]}];
            --edges[{face[(k + 1) % size], face[k]}];
        }
    }
    std::size_t count = 0;
    for (const auto& [edge, balance] : edges) count += balance != 0;
    return count;
}

double offPlane(const Facets& facets) {
    double largest = 0.0;
    for (const auto& face : facets.faces) {
        if (face[3] == kNone) continue;
        const glm::dvec3 normal = glm::normalize(areaVector(facets, face));
        largest = std::max(largest, std::abs(glm::dot(facets.points[face[3]] - facets.points[face[0]], normal)));
    }
    return largest;
}

const glm::dvec3 kCentre(0.3, -0.2, 1.1);
const glm::dvec3 kAxis = glm::normalize(glm::dvec3(1, -2, 0.5));

struct Shape {
    const char* name;
    std::function<Facets(int)> make;
    double area;
};

std::vector<Shape> shapes() {
    const auto cone = [](double r, double s, double height) {
        return [=](int n) { return coneFacets(kCentre, r, kCentre + height * kAxis, s, n); };
    };
    return {{"sphere", [](int n) { return sphereFacets(kCentre, 0.7, n); }, 4 * kPi * 0.49},
            {"cylinder", cone(0.4, 0.4, 1.5), 2 * kPi * 0.4 * 1.5},
            {"frustum", cone(0.4, 0.1, 0.4), kPi * 0.5 * 0.5},
            {"cone", cone(0.0, 0.3, 0.4), kPi * 0.3 * 0.5},
            {"disc", [](int n) { return ringFacets(kCentre, kAxis, 0.0, 0.6, n); }, kPi * 0.36},
            {"ring", [](int n) { return ringFacets(kCentre, kAxis, 0.2, 0.6, n); }, kPi * 0.32},
            {"torus", [](int n) { return torusFacets(kCentre, kAxis, 0.3, 0.7, n); }, 4 * kPi * kPi * 0.5 * 0.2}};
}

TEST(MgfShapes, AreasConvergeFromBelowInSecondOrder) {
    for (const Shape& shape : shapes()) {
        const double coarse = shape.area - area(shape.make(32));
        const double fine = shape.area - area(shape.make(64));
        EXPECT_GT(fine, 0.0) << shape.name;
        EXPECT_LT(fine, 0.01 * shape.area) << shape.name;
        EXPECT_NEAR(coarse / fine, 4.0, 0.05) << shape.name; // the next term is of fourth order
    }
}

TEST(MgfShapes, QuadsArePlanarAndNothingIsWithoutArea) {
    for (const Shape& shape : shapes()) {
        for (const int segments : {4, 6, 24, 50}) {
            const Facets facets = shape.make(segments);
            EXPECT_LT(offPlane(facets), 1e-14) << shape.name << " " << segments;
            for (const auto& face : facets.faces) EXPECT_GT(glm::length(areaVector(facets, face)), 1e-6) << shape.name;
        }
    }
}

TEST(MgfShapes, SpheresAndToriAreClosedAndFaceOutwardsOrInwards) {
    const double ball = 4.0 / 3.0 * kPi * 0.343;
    const double ring = 2 * kPi * kPi * 0.5 * 0.04;
    for (const int segments : {4, 6, 24, 96}) {
        for (const double sign : {1.0, -1.0}) {
            const Facets sphere = sphereFacets(kCentre, sign * 0.7, segments);
            EXPECT_EQ(unmatchedEdges(sphere), 0U);
            EXPECT_GT(sign * volume(sphere), 0.0);
            const Facets torus = torusFacets(kCentre, kAxis, sign * 0.3, sign * 0.7, segments);
            EXPECT_EQ(unmatchedEdges(torus), 0U);
            EXPECT_GT(sign * volume(torus), 0.0);
            if (segments == 96) { // second order: about 10 / 96² of it is missing
                EXPECT_NEAR(sign * volume(sphere), ball, 3e-3 * ball);
                EXPECT_NEAR(sign * volume(torus), ring, 6e-3 * ring);
            }
        }
    }
    EXPECT_EQ(unmatchedEdges(torusFacets(kCentre, kAxis, 0.0, 0.7, 24)), 0U); // without a hole
}

TEST(MgfShapes, ConesFaceAwayFromTheirAxisAndRingsAlongTheirNormal) {
    for (const double sign : {1.0, -1.0}) {
        const Facets cone = coneFacets(kCentre, sign * 0.4, kCentre + kAxis, sign * 0.2, 24);
        for (const auto& face : cone.faces) {
            const glm::dvec3 out = cone.points[face[0]] - kCentre;
            EXPECT_GT(sign * glm::dot(areaVector(cone, face), out - glm::dot(out, kAxis) * kAxis), 0.0);
        }
    }
    for (const double inner : {0.0, 0.3}) {
        const Facets ring = ringFacets(kCentre, kAxis, inner, 0.5, 24);
        for (const auto& face : ring.faces) EXPECT_GT(glm::dot(areaVector(ring, face), kAxis), 0.0);
    }
}

TEST(MgfShapes, RimsOfOppositeAxesCoincide) {
    for (const glm::dvec3& axis : {glm::dvec3(0, 1, 0), glm::dvec3(1, 1, 1), glm::dvec3(0.6, 0.8, 0), kAxis}) {
        const glm::dvec3 unit = glm::normalize(axis);
        const Facets cylinder = coneFacets(kCentre, 0.5, kCentre + 3.0 * axis, 0.5, 10);
        for (const double sign : {1.0, -1.0}) {
            const Facets lid = ringFacets(kCentre, sign * unit, 0.1, 0.5, 10);
            for (std::size_t k = 0; k < 10; ++k) {
                double nearest = 1.0;
                for (std::size_t j = 0; j < 10; ++j)
                    nearest = std::min(nearest, glm::distance(cylinder.points[k], lid.points[j]));
                EXPECT_LT(nearest, 1e-14);
            }
        }
    }
}

} // namespace
} // namespace lambert
