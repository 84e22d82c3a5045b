#pragma once

#include "cli/arguments.h"
#include "cli/patch_groups.h"
#include "cli/temperatures_file.h"
#include "formfactors/group_factors.h"
#include "formfactors/matrix_quality.h"

#include <nlohmann/json.hpp>

#include <optional>
#include <string>

namespace lambert {

/// What became of the groups, for table, CSV and JSON.
struct GroupReport {
    PatchGroups groups;
    GroupFactors factors;
    std::optional<Temperatures> temperatures;
    std::optional<HeatFlow> heat;            //!< with temperatures
    std::optional<double> heatLostByFactors; //!< W, the sum of all flows by the factors before their repair
};

/// One row per group: area, factors, exchange areas; with temperatures the heat below. For a person.
std::string groupTable(const GroupReport& report);
/// The same as CSV: a comment, a header, one line per group.
std::string groupCsv(const GroupReport& report, const std::string& comment);
nlohmann::ordered_json groupJson(const GroupReport& report);

/// The keys of docs/formfactors.md that tell of a matrix.
nlohmann::ordered_json qualityJson(const MatrixQuality& quality);

} // namespace lambert
