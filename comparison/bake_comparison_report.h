#pragma once

#include "comparison/compare_bakes.h"

#include <nlohmann/json_fwd.hpp>

#include <array>
#include <span>
#include <string>

namespace lambert {

/// One of the figures of FieldErrors, for tables and files.
struct FieldMeasure {
    const char* key;     //!< in JSON and CSV
    const char* name;    //!< as a heading
    const char* meaning; //!< a sentence
    double FieldErrors::*value;
};
std::span<const FieldMeasure> fieldMeasures();

/// The rows of every table: a name and the errors. The first is the mean of the channels.
struct NamedErrors {
    const char* name;
    const FieldErrors& errors;
};
std::array<NamedErrors, 4> namedErrors(const BakeComparison& comparison);

/// `overall` and `channels` with all figures, `same_patches`, `unmatched_area`.
nlohmann::ordered_json bakeComparisonJson(const BakeComparison& comparison);
std::string bakeComparisonCsv(const BakeComparison& comparison);  //!< a header, then a line per row
std::string bakeComparisonText(const BakeComparison& comparison); //!< a table of fixed width

} // namespace lambert
