#pragma once

#include "core/progress.h"

#include <string>
#include <vector>

namespace lambert {

/// A number that is known exactly, and what Lambert makes of it.
struct AnalyticResult {
    std::string name;
    double expected = 0.0;
    double found = 0.0;
    double tolerance = 0.0; //!< absolute
    bool passed() const;
};

/// Furnace box, cube6, opposed and perpendicular squares, closure, energy balance. Throws Cancelled.
std::vector<AnalyticResult> runAnalyticCases(Progress& progress);

} // namespace lambert
