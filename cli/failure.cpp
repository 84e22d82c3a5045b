#include "cli/failure.h"
#include "cli/terminal_text.h"

#include <new>

namespace lambert {

Failure currentFailure() {
    try {
        throw;
    } catch (const Error& error) {
        return {error.exitCode(), printable(error.what())};
    } catch (const std::bad_alloc&) {
        return {ExitCode::System, "not enough memory"};
    } catch (const std::exception& error) {
        return {ExitCode::System, printable(error.what())};
    }
}

} // namespace lambert
