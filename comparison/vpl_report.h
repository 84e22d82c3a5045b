#pragma once

#include "comparison/compare_pictures.h"

#include <nlohmann/json_fwd.hpp>

#include <string>

namespace lambert {

/// The keys `reference` and `methods` of results.json; see docs/compare_vpl.md.
nlohmann::ordered_json vplComparisonJson(const VplComparison& comparison, const VplPictures& pictures);

/// One line per method, effort and seed, under a line of names.
std::string vplComparisonCsv(const VplComparison& comparison, std::uint64_t firstSeed);

/// For a terminal: errors by effort, and the anatomy.
std::string vplComparisonText(const VplComparison& comparison);

/// The slopes of a method's noise over lights and over seconds.
std::optional<PowerLaw> samplingLaw(const VplMethodResult& method, bool overSeconds);

} // namespace lambert
