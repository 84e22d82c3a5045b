#pragma once

#include "core/progress.h"

#include <string>

namespace lambert {

/// Throws SystemError, naming the package, if gnuplot is not installed. To be called before hours of work.
void requireGnuplot();

/// Runs a script in gnuplot, a child process that reads it from its standard input, and returns what it writes to standard
/// output. Nothing passes through a shell. Throws SystemError with gnuplot's first complaint, Cancelled.
std::string runGnuplot(const std::string& script, const Progress& progress);

} // namespace lambert
