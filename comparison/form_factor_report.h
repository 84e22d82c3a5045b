#pragma once

#include "comparison/compare_form_factors.h"

#include <nlohmann/json_fwd.hpp>

#include <string>

namespace lambert {

/// The keys `reference`, `threshold`, `seeds` and `methods` of results.json; see docs/compare.md.
nlohmann::ordered_json comparisonJson(const FormFactorComparison& comparison);

/// One line per method, effort and seed, under a line of names.
std::string comparisonCsv(const FormFactorComparison& comparison, std::uint64_t firstSeed);

/// For a terminal: one line per method and effort, means over the seeds.
std::string comparisonText(const FormFactorComparison& comparison);

/// "1.23 %" or, above 100 %, "12.3": three significant digits at most.
std::string percentText(double value);
/// 1234 as "1.23 k" and so on; for counts and bytes.
std::string countText(double value);
/// The slope with its standard error: "−0.52 ± 0.01"; "–" if there is none.
std::string slopeText(const std::optional<PowerLaw>& law);

} // namespace lambert
