#pragma once

#include "core/error.h"

#include <string>

namespace lambert {

/// How the program tells of an exception.
struct Failure {
    ExitCode code;
    std::string message; //!< one line
};

/// The exception at hand; to be called in a catch block.
Failure currentFailure();

} // namespace lambert
