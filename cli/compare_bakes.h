#pragma once

#include "cli/commands.h"

namespace lambert {

/// `compare bakes`.
void addCompareBakes(CLI::App& compare, CommandRun& run);

} // namespace lambert
