#pragma once

#include "comparison/compare_form_factors.h"
#include "comparison/page/plot.h"

#include <string>
#include <vector>

namespace lambert {

/// Errors against costs, and errors against the size of the factors; what nothing is known of is left out.
std::vector<CaptionedPlot> formFactorPlots(const FormFactorComparison& comparison);

} // namespace lambert
