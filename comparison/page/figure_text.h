#pragma once

#include "core/statistics.h"

#include <optional>
#include <string>

namespace lambert {

/// Numbers as tables and axes show them.

/// A share: "12.3 %", "0.0123 %", three significant digits; "–" if it is not finite.
std::string percentText(double value);
/// "23.8 ± 0.2 %": three digits of the mean, more where the deviation needs them; without it where it is 0.
std::string percentText(const MeanDeviation& value);
/// A round share: "5 %".
std::string percentLabel(double value);
/// A count or bytes: "1.23 k".
std::string countText(double value);
/// A round number: "0.2", "10^{-6}" (as gnuplot writes exponents) where that is shorter.
std::string numberLabel(double value);
/// The slope with its standard error: "−0.52 ± 0.01"; "–" if there is none.
std::string slopeText(const std::optional<PowerLaw>& law);

} // namespace lambert
