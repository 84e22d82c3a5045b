#include "scene/unit_guess.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace lambert {
namespace {

std::vector<std::string> names(double longestSide) {
    std::vector<std::string> result;
    for (const LengthUnit& unit : guessUnits(longestSide)) result.emplace_back(unit.name);
    return result;
}

TEST(UnitGuess, RoomsInUsualUnitsAreRecognized) {
    EXPECT_EQ(names(5000.0), (std::vector<std::string>{"millimetres"}));
    EXPECT_EQ(names(555.0), (std::vector<std::string>{"centimetres", "inches"}));
    EXPECT_EQ(names(250.0), (std::vector<std::string>{"centimetres", "inches"}));
}

TEST(UnitGuess, MetresArePlausibleForRooms) {
    for (const double size : {0.0, 0.5, 2.0, 30.0, 100.0}) EXPECT_TRUE(names(size).empty()) << size;
}

TEST(UnitGuess, NothingIsGuessedWhereNothingFits) { EXPECT_TRUE(names(1e6).empty()); }

TEST(UnitGuess, SizesOfNoRoomAreUnusual) {
    for (const double size : {1e-6, 5000.0}) EXPECT_TRUE(isUnusualSize(size)) << size;
    for (const double size : {0.05, 2.0, 500.0}) EXPECT_FALSE(isUnusualSize(size)) << size;
}

} // namespace
} // namespace lambert
