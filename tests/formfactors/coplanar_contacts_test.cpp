#include "formfactors/coplanar_contacts.h"

#include "meshing/prepare.h"
#include "scene/example_scenes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace lambert {
namespace {

constexpr double kTolerance = 1e-6;

/// A square of side `side` at height 0, facing up or down.
Occluder sheet(double x, double y, double side, bool up) {
    Occluder o;
    o.corners = {{x, y, 0}, {x + side, y, 0}, {x + side, y + side, 0}, {x, y + side, 0}};
    if (!up) std::reverse(o.corners.begin(), o.corners.end());
    o.plane = Plane::through({0, 0, 0}, {0, 0, up ? 1 : -1});
    return o;
}

TEST(CoplanarContacts, WhatASolidStandsOnLosesItsFront) {
    std::vector<Occluder> list{sheet(0, 0, 2, true), sheet(0.5, 0.5, 1, false)};
    list[1].solid = true;
    const auto contacts = findCoplanarContacts(list, kTolerance);
    for (std::size_t k = 0; k < 2; ++k) {
        ASSERT_EQ(contacts[k].size(), 1U);
        EXPECT_EQ(contacts[k][0].occluder, 1U - k);
        EXPECT_EQ(contacts[k][0].hides, CoveredSide::Front);
    }
}

TEST(CoplanarContacts, SheetsBackToBackLoseTheirBacks) {
    const auto contacts = findCoplanarContacts({sheet(0, 0, 2, true), sheet(0.5, 0.5, 1, false)}, kTolerance);
    ASSERT_EQ(contacts[0].size(), 1U);
    EXPECT_EQ(contacts[0][0].hides, CoveredSide::Back);
    EXPECT_EQ(contacts[1].at(0).hides, CoveredSide::Back);
}

TEST(CoplanarContacts, OfSheetsThatFaceTheSameWayTheFirstRemains) {
    const auto contacts = findCoplanarContacts({sheet(0, 0, 2, true), sheet(0.5, 0.5, 1, true)}, kTolerance);
    EXPECT_TRUE(contacts[0].empty());
    ASSERT_EQ(contacts[1].size(), 1U);
    EXPECT_EQ(contacts[1][0].hides, CoveredSide::Both);
}

TEST(CoplanarContacts, NeighboursAndOtherPlanesDoNotTouch) {
    std::vector<Occluder> list{sheet(0, 0, 1, true), sheet(1, 0, 1, false), sheet(0, 0, 1, false)};
    for (glm::dvec3& p : list[2].corners) p.z = 1e-3;
    list[2].plane.offset = -1e-3;
    for (const auto& contacts : findCoplanarContacts(list, kTolerance)) EXPECT_TRUE(contacts.empty());
}

TEST(CoplanarContacts, PiecesOfADividedPolygonMakeItUp) {
    const Occluder floor = sheet(0, 0, 2, true), box = sheet(0.5, 1.5, 1, false);
    std::vector<ConvexPolygon> outside;
    ConvexPolygon covered;
    divideByCover(ConvexPolygon(floor.corners), box, kTolerance, outside, covered);
    const auto area = [](const ConvexPolygon& p) {
        glm::dvec3 sum(0.0);
        for (std::size_t k = 0; k < p.size; ++k) sum += glm::cross(p.corners[k], p.next(k));
        return 0.5 * glm::length(sum);
    };
    EXPECT_NEAR(area(covered), 0.5, 1e-12);
    double rest = 0.0;
    for (const ConvexPolygon& p : outside) rest += area(p);
    EXPECT_NEAR(rest, 3.5, 1e-12);
}

} // namespace
} // namespace lambert
