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

} // namespace lambert
