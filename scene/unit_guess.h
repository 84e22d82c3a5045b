#pragma once

#include <vector>

namespace lambert {

struct LengthUnit {
    const char* name;
    double metres;
};

/// The units in which a scene whose longest side has this many units would be between a small and a large room (1.5 to 30 m);
/// best guess first. Empty where metres are plausible (up to 100) and where nothing fits.
std::vector<LengthUnit> guessUnits(double longestSide);

/// Whether a scene of this size in metres is no room, whatever it is: less than 1 cm, or more than 1 km.
bool isUnusualSize(double metres);

} // namespace lambert
