#pragma once

#include "cli/commands.h"

namespace lambert {

/// `compare vpl`.
void addCompareVpl(CLI::App& compare, CommandRun& run);

} // namespace lambert
