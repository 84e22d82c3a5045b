#pragma once

#include "solver/heat_flow.h"

#include <filesystem>
#include <string>
#include <vector>

namespace lambert {

/// What is known of the groups' heat.
struct Temperatures {
    std::vector<ThermalSurface> surfaces; //!< one per group
    double environment = 0.0;             //!< kelvin
};

/// From a CSV with a line `group,kelvin,emissivity` for every group (`adiabatic` in place of the temperature, then the
/// emissivity may be missing) and perhaps a line `environment,kelvin`. # starts a comment, one header line is allowed, names
/// with commas stand in double quotes. Throws InputError with file and line, also for groups that are missing.
Temperatures readTemperatures(const std::filesystem::path& path, const std::vector<std::string>& groups);

} // namespace lambert
