#include "meshing/weld.h"

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include <limits>
#include <random>

namespace lambert {
namespace {

using Positions = std::vector<glm::vec3>;
using Indices = std::vector<std::uint32_t>;

Positions onAxis(std::initializer_list<float> coordinates) {
    Positions positions;
    for (const float x : coordinates) positions.emplace_back(x, 0.0F, 0.0F);
    return positions;
}

/// The definition, by comparing all with all.
Indices weldSlowly(const Positions& positions, float tolerance) {
    Indices result;
    for (std::uint32_t i = 0; i < positions.size(); ++i) {
        std::uint32_t representative = i;
        for (std::uint32_t k = 0; k < i && representative == i; ++k)
            if (result[k] == k && glm::distance(positions[k], positions[i]) <= tolerance) representative = k;
        result.push_back(representative);
    }
    return result;
}

TEST(WeldPositions, LeavesDistantPositionsAlone) {
    EXPECT_EQ(weldPositions(onAxis({0, 1, 2, -1}), 0.5F), (Indices{0, 1, 2, 3}));
    EXPECT_TRUE(weldPositions({}, 1.0F).empty());
}

TEST(WeldPositions, GivesTheFirstOfEqualPositions) {
    EXPECT_EQ(weldPositions(onAxis({3, 5, 3, 5, 3}), 1e-6F), (Indices{0, 1, 0, 1, 0}));
    EXPECT_EQ(weldPositions(onAxis({0.0F, -0.0F}), 1e-6F), (Indices{0, 0}));
}

TEST(WeldPositions, TakesWhatIsExactlyAtTheTolerance) {
    EXPECT_EQ(weldPositions(onAxis({0, 1}), 1.0F), (Indices{0, 0}));
    EXPECT_EQ(weldPositions(onAxis({0, 1.0001F}), 1.0F), (Indices{0, 1}));
}

TEST(WeldPositions, DoesNotGrowAlongAChain) {
    // Each is near the one before, but not near the first; every second one stands for itself.
    EXPECT_EQ(weldPositions(onAxis({0, 0.9F, 1.8F, 2.7F, 3.6F}), 1.0F), (Indices{0, 0, 2, 2, 4}));
}

TEST(WeldPositions, PrefersTheFirstRepresentativeToTheNearest) {
    EXPECT_EQ(weldPositions(onAxis({0, 1.5F, 0.9F}), 1.0F), (Indices{0, 1, 0}));
}

TEST(WeldPositions, WeldsAcrossZeroAndAcrossCellBorders) {
    EXPECT_EQ(weldPositions(onAxis({-0.4F, 0.4F}), 1.0F), (Indices{0, 0}));
    for (int cell = -3; cell <= 3; ++cell) {
        const float border = 4.0F * static_cast<float>(cell);
        EXPECT_EQ(weldPositions(onAxis({border - 0.4F, border + 0.4F}), 1.0F), (Indices{0, 0})) << border;
        EXPECT_EQ(weldPositions(onAxis({border, border + 1.0F, border - 1.0F}), 1.0F), (Indices{0, 0, 0})) << border;
    }
}

TEST(WeldPositions, LeavesPositionsThatAreNotFiniteAlone) {
    constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
    constexpr float kInfinity = std::numeric_limits<float>::infinity();
    EXPECT_EQ(weldPositions(onAxis({kNan, kNan, kInfinity, kInfinity, -kInfinity, 1}), 1.0F),
              (Indices{0, 1, 2, 3, 4, 5}));
}

TEST(WeldPositions, WeldsOnlyEqualPositionsFarFromTheOrigin) {
    // The spacing of floats there is more than the tolerance.
    EXPECT_EQ(weldPositions(onAxis({1e7F, 1e7F, 1e7F + 1.0F, -1e7F}), 1e-3F), (Indices{0, 0, 2, 3}));
}

TEST(WeldPositions, AgreesWithTheDefinitionOnRandomPositions) {
    for (std::uint32_t seed = 1; seed <= 20; ++seed) {
        SCOPED_TRACE(testing::Message() << "seed " << seed);
        std::mt19937 random(seed);
        std::uniform_real_distribution<float> uniform(-1.0F, 1.0F);
        Positions positions;
        for (int i = 0; i < 1000; ++i) positions.emplace_back(uniform(random), uniform(random), uniform(random));
        for (const float tolerance : {0.01F, 0.1F, 0.5F}) {
            const Indices welded = weldPositions(positions, tolerance);
            EXPECT_EQ(welded, weldSlowly(positions, tolerance)) << tolerance;

            Positions snapped;
            for (const std::uint32_t i : welded) snapped.push_back(positions[i]);
            EXPECT_EQ(weldPositions(snapped, tolerance), welded) << "a second time must change nothing";
        }
    }
}

} // namespace
} // namespace lambert
