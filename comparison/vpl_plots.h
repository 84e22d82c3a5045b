#pragma once

#include "comparison/compare_vpl.h"
#include "comparison/page/plot.h"

#include <vector>

namespace lambert {

/// Errors of the methods, and their noise alone, against lights and against processor time.
std::vector<CaptionedPlot> vplPlots(const VplComparison& comparison);

} // namespace lambert
