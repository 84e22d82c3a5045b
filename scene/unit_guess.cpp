#include "scene/unit_guess.h"

#include <array>

namespace lambert {

namespace {

constexpr std::array kUnits{LengthUnit{"centimetres", 0.01}, LengthUnit{"millimetres", 0.001},
                            LengthUnit{"inches", 0.0254}, LengthUnit{"feet", 0.3048}};
constexpr double kSmallestRoom = 1.5, kLargestRoom = 30.0; // metres

} // namespace

std::vector<LengthUnit> guessUnits(double longestSide) {
    std::vector<LengthUnit> fitting;
    if (!(longestSide > 100.0)) return fitting;
    for (const LengthUnit& unit : kUnits)
        if (const double metres = longestSide * unit.metres; metres >= kSmallestRoom && metres <= kLargestRoom)
            fitting.push_back(unit);
    return fitting;
}

bool isUnusualSize(double metres) { return metres < 0.01 || metres > 1000.0; }

} // namespace lambert
