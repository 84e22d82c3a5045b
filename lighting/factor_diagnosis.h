#pragma once

#include "formfactors/repair.h"
#include "formfactors/transport.h"

#include <optional>
#include <string>
#include <vector>

namespace lambert {

/// Why form factors are off, most likely, and what helps: "cause: try this or that". `plan`: none: they are from a file;
/// `bySolver`: a solver that needs none is a way out.
std::string causeAndRemedy(const std::optional<TransportPlan>& plan, bool bySolver);

/// What to tell of a repair that had to do more than the factors' error let expect, one line each. `plan` as above.
std::vector<std::string> repairWarnings(const std::optional<TransportPlan>& plan, const RepairReport& repair);

} // namespace lambert
