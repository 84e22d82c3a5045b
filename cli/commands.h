#pragma once

#include "core/error.h"

#include <CLI/CLI.hpp>

#include <functional>

namespace lambert {

/// Each adds one subcommand to the program. When it was chosen, `run` is set to what it does.
using CommandRun = std::function<ExitCode()>;
void addBakeCommand(CLI::App& program, CommandRun& run);
void addFormFactorsCommand(CLI::App& program, CommandRun& run);
void addProbeCommand(CLI::App& program, CommandRun& run);
void addCompareCommand(CLI::App& program, CommandRun& run);
void addInfoCommand(CLI::App& program, CommandRun& run);
void addVerifyCommand(CLI::App& program, CommandRun& run);

/// The same below `compare`.
void addCompareVpl(CLI::App& compare, CommandRun& run);
void addCompareBakes(CLI::App& compare, CommandRun& run);

} // namespace lambert
