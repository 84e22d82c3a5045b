#include "meshing/pair_triangles.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace lambert {
namespace {

using Indices = std::vector<std::uint32_t>;
using Origins = std::vector<FaceOrigin>;
using Faces = std::vector<Corners>;
using Positions = std::vector<glm::vec3>;

/// Two triangles with the diagonal 0–2 that make a parallelogram with corners of `degrees` and the rest to
/// 180.
Positions parallelogram(double degrees) {
    const double angle = degrees * std::numbers::pi / 180.0;
    const auto x = static_cast<float>(std::cos(angle));
    const auto y = static_cast<float>(std::sin(angle));
    return {{0, 0, 0}, {1, 0, 0}, {1 + x, y, 0}, {x, y, 0}};
}
const Faces kHalves{{0, 1, 2, kNone}, {0, 2, 3, kNone}};

std::size_t facesLeft(const Positions& positions, Faces faces = kHalves, const Indices& group = {0, 0},
                      const std::vector<std::pair<std::uint32_t, std::uint32_t>>& fixed = {}) {
    pairTriangles(faces, group, positions, fixed);
    return faces.size();
}

TEST(PairTriangles, JoinsTheHalvesOfASquare) {
    Faces faces = kHalves;
    EXPECT_EQ(pairTriangles(faces, Indices{0, 0}, parallelogram(90)), (Origins{{0, 1}}));
    ASSERT_EQ(faces.size(), 1U);
    // Counter-clockwise, whichever corner is first.
    std::rotate(faces[0].begin(), std::find(faces[0].begin(), faces[0].end(), 0U), faces[0].end());
    EXPECT_EQ(faces[0], (Corners{0, 1, 2, 3}));
}

TEST(PairTriangles, JoinsOnlyToCornersBetween45And135Degrees) {
    EXPECT_EQ(facesLeft(parallelogram(45.1)), 1U);
    EXPECT_EQ(facesLeft(parallelogram(44.9)), 2U);
    EXPECT_EQ(facesLeft(parallelogram(134.9)), 1U);
    EXPECT_EQ(facesLeft(parallelogram(135.1)), 2U);
}

TEST(PairTriangles, DoesNotMakeConcaveQuads) {
    EXPECT_EQ(facesLeft({{0, 0, 0}, {1, 0, 0}, {0.3F, 0.3F, 0}, {0, 1, 0}}), 2U);
    EXPECT_EQ(facesLeft({{0, 0, 0}, {1, 0, 0}, {0.5F, 0.5F, 0}, {0, 1, 0}}), 2U) << "a corner of 180 degrees";
}

TEST(PairTriangles, DoesNotBendAQuad) {
    for (const float scale : {1e-6F, 1.0F, 1e6F}) {
        Positions flat = parallelogram(90);
        flat[3].z = 1e-5F; // a quarter of it is each corner's distance from the mean plane
        Positions bent = parallelogram(90);
        bent[3].z = 1e-3F;
        for (glm::vec3& p : flat) p *= scale;
        for (glm::vec3& p : bent) p *= scale;
        EXPECT_EQ(facesLeft(flat), 1U) << scale;
        EXPECT_EQ(facesLeft(bent), 2U) << scale;
    }
}

TEST(PairTriangles, JoinsOnlyWithinAGroup) { EXPECT_EQ(facesLeft(parallelogram(90), kHalves, {0, 1}), 2U); }

TEST(PairTriangles, KeepsFixedEdges) {
    EXPECT_EQ(facesLeft(parallelogram(90), kHalves, {0, 0}, {{0, 2}}), 2U);
    EXPECT_EQ(facesLeft(parallelogram(90), kHalves, {0, 0}, {{0, 1}, {1, 3}}), 1U);
}

TEST(PairTriangles, DoesNotJoinNeighboursThatFaceOppositeSides) {
    EXPECT_EQ(facesLeft(parallelogram(90), {{0, 1, 2, kNone}, {0, 3, 2, kNone}}), 2U);
}

TEST(PairTriangles, LeavesAnEdgeOfThreeFacesAlone) {
    Positions positions = parallelogram(90);
    positions.emplace_back(0.5F, 0.5F, 1.0F);
    EXPECT_EQ(facesLeft(positions, {{0, 1, 2, kNone}, {0, 2, 3, kNone}, {0, 2, 4, kNone}}, {0, 0, 0}), 3U);
}

TEST(PairTriangles, PrefersTheBestPairAndKeepsTheOrder) {
    // A strip 0-1-2-3 over 5-4: the middle triangle could go either way, to the right it makes a square.
    const Positions positions{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {2, 1, 0}, {1, 1, 0}, {0.3F, 1, 0}};
    Faces faces{{0, 1, 5, kNone}, {1, 4, 5, kNone}, {1, 2, 4, kNone}, {2, 3, 4, kNone}};
    EXPECT_EQ(pairTriangles(faces, Indices{0, 0, 0, 0}, positions), (Origins{{0, 1}, {2, 3}}));
    EXPECT_NE(faces[0][3], kNone);
    EXPECT_NE(faces[1][3], kNone);

    Faces three{{0, 1, 5, kNone}, {1, 4, 5, kNone}, {1, 2, 4, kNone}};
    const Positions skewed{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {2, 1, 0}, {1, 1, 0}, {0, 1, 0}};
    EXPECT_EQ(pairTriangles(three, Indices{0, 0, 0}, skewed), (Origins{{0, 1}, {2, kNone}}));
    EXPECT_NE(three[0][3], kNone) << "the square";
    EXPECT_EQ(three[1], (Corners{1, 2, 4, kNone}));
}

TEST(PairTriangles, LeavesQuadsAsTheyAre) {
    Faces faces{{0, 1, 2, 3}, {0, 2, 3, kNone}};
    EXPECT_EQ(pairTriangles(faces, Indices{0, 0}, parallelogram(90)), (Origins{{0, kNone}, {1, kNone}}));
    EXPECT_EQ(faces[0], (Corners{0, 1, 2, 3}));
}

} // namespace
} // namespace lambert
