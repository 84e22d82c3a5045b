#pragma once

#include <stdexcept>
#include <string>

namespace lambert {

/// What the program returns to the shell.
enum class ExitCode { Ok = 0, TargetMissed = 1, Usage = 2, Input = 3, System = 4, Interrupted = 130 };

/// Base of everything Lambert throws on purpose. `what()` is one line that a user can act on; it is
/// printed once, in `main`.
class Error : public std::runtime_error {
public:
    Error(ExitCode exitCode, const std::string& message) : std::runtime_error(message), exitCode_(exitCode) {}
    ExitCode exitCode() const { return exitCode_; }

private:
    ExitCode exitCode_;
};

/// An option or a combination of options that makes no sense.
struct UsageError : Error {
    explicit UsageError(const std::string& message) : Error(ExitCode::Usage, message) {}
};

/// A file whose content cannot be used: names the file, the place in it, what was found, what is allowed.
struct InputError : Error {
    explicit InputError(const std::string& message) : Error(ExitCode::Input, message) {}
};

/// Memory, disk or device.
struct SystemError : Error {
    explicit SystemError(const std::string& message) : Error(ExitCode::System, message) {}
};

/// The user asked to stop.
struct Cancelled : Error {
    Cancelled() : Error(ExitCode::Interrupted, "interrupted") {}
};

} // namespace lambert
