#include "meshing/edge_division.h"

#include "meshing/prepare.h"
#include "sample_scenes.h"

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <random>

namespace lambert {
namespace {

using Quad = std::array<glm::vec3, 4>;
using Indices = std::vector<std::uint32_t>;
constexpr double kUndivided = std::numeric_limits<double>::infinity();

struct Divided {
    explicit Divided(const Scene& input, double length)
        : scene(prepareScene(input)),
          positions(scene.positions),
          division(scene, BoxIndex(boxesOf(scene.positions)), length, positions) {}
    EdgeDivision::Side side(std::size_t polygon, int k) const { return division.side(scene.polygons[polygon], k); }

    Scene scene;
    std::vector<glm::vec3> positions;
    EdgeDivision division;
};

/// A wide quad on top of two narrow ones: the vertex between those lies on the wide one's edge.
Scene brickWall() {
    Scene scene = emptyScene();
    addPolygon(scene, Quad{{{0, 1, 0}, {3, 1, 0}, {3, 2, 0}, {0, 2, 0}}});
    addPolygon(scene, Quad{{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}});
    addPolygon(scene, Quad{{{1, 0, 0}, {3, 0, 0}, {3, 1, 0}, {1, 1, 0}}});
    return scene;
}

TEST(EdgeDivision, NeighboursShareTheVerticesOfAnEdge) {
    const Divided wall(brickWall(), 0.3);
    Indices below = wall.side(1, 2).vertices;
    const Indices rest = wall.side(2, 2).vertices;
    std::reverse(below.begin(), below.end());
    Indices expected = below;
    expected.insert(expected.end(), rest.rbegin() + 1, rest.rend());
    EXPECT_EQ(wall.side(0, 0).vertices, expected);
    EXPECT_EQ(wall.side(0, 0).segments, 2);
    EXPECT_EQ(wall.side(0, 2).segments, 1);
}

TEST(EdgeDivision, InsertsVerticesEvenIfNothingIsDivided) {
    const Divided wall(brickWall(), kUndivided);
    EXPECT_EQ(wall.side(0, 0).vertices.size(), 3U);
    EXPECT_EQ(wall.side(0, 2).vertices.size(), 2U);
    EXPECT_EQ(wall.positions.size(), wall.scene.positions.size());
}

TEST(EdgeDivision, CutsSegmentsIntoEqualPartsNoLongerThanTheLength) {
    const Divided wall(brickWall(), 0.3);
    for (std::size_t polygon = 0; polygon < 3; ++polygon)
        for (int k = 0; k < 4; ++k) {
            const Indices vertices = wall.side(polygon, k).vertices;
            for (std::size_t i = 0; i + 1 < vertices.size(); ++i)
                EXPECT_LE(glm::distance(wall.positions[vertices[i]], wall.positions[vertices[i + 1]]), 0.300001F);
        }
    EXPECT_EQ(wall.side(1, 0).vertices.size(), 5U); // 1 m in 4 parts
    EXPECT_EQ(wall.side(2, 0).vertices.size(), 8U); // 2 m in 7
}

TEST(EdgeDivision, DoesNotSpendAPartOnRounding) {
    const Divided square(flatScene(std::array<glm::vec2, 4>{{{0, 0}, {3, 0}, {3, 3}, {0, 3}}}), 0.1);
    for (int k = 0; k < 4; ++k) EXPECT_EQ(square.side(0, k).vertices.size(), 31U);
}

TEST(EdgeDivision, EvensOutSidesOfAQuadThatDifferLittle) {
    const Divided trapezoid(flatScene(std::array<glm::vec2, 4>{{{0, 0}, {2, 0}, {1.9F, 1}, {0.1F, 1}}}), 0.1);
    EXPECT_EQ(trapezoid.side(0, 0).vertices.size(), 21U);
    EXPECT_EQ(trapezoid.side(0, 2).vertices.size(), 21U);
    const Divided pointed(flatScene(std::array<glm::vec2, 4>{{{0, 0}, {2, 0}, {1.2F, 1}, {0.8F, 1}}}), 0.1);
    EXPECT_EQ(pointed.side(0, 0).vertices.size(), 21U);
    EXPECT_EQ(pointed.side(0, 2).vertices.size(), 5U);
}

TEST(EdgeDivision, FindsSegmentsByTheirEnds) {
    const Divided wall(brickWall(), 0.3);
    for (std::uint32_t vertex = 0; vertex < wall.scene.positions.size(); ++vertex) {
        for (const std::uint32_t segment : wall.division.segmentsAt(vertex)) {
            const auto [a, b] = wall.division.segment(segment);
            EXPECT_LT(a, b);
            EXPECT_TRUE(a == vertex || b == vertex);
            const Indices vertices = wall.division.segmentVertices(segment);
            EXPECT_EQ(vertices.front(), a);
            EXPECT_EQ(vertices.back(), b);
        }
    }
}

TEST(BoxIndex, FindsWhatLiesInABoxItsBorderIncluded) {
    SCOPED_TRACE("seed 5");
    std::mt19937 random(5);
    std::uniform_int_distribution<int> lattice(0, 9); // so that many lie on the border
    const auto randomPoint = [&] {
        const auto next = [&] { return static_cast<float>(lattice(random)); };
        const float x = next(), y = next();
        return glm::vec3(x, y, next());
    };
    std::vector<glm::vec3> positions;
    for (int i = 0; i < 500; ++i) positions.push_back(randomPoint());
    const BoxIndex index(boxesOf(positions));
    Indices found{99};
    for (int i = 0; i < 200; ++i) {
        const glm::vec3 lower = randomPoint();
        const glm::vec3 upper = lower + 0.5F * randomPoint();
        Indices expected;
        for (std::uint32_t k = 0; k < positions.size(); ++k) {
            const glm::vec3& p = positions[k];
            if (p.x >= lower.x && p.y >= lower.y && p.z >= lower.z && p.x <= upper.x && p.y <= upper.y &&
                p.z <= upper.z)
                expected.push_back(k);
        }
        index.meeting({lower, upper}, found);
        EXPECT_EQ(found, expected);
    }
    BoxIndex({}).meeting({glm::vec3(0.0F), glm::vec3(1.0F)}, found);
    EXPECT_TRUE(found.empty());
}

} // namespace
} // namespace lambert
