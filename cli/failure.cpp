#include "cli/failure.h"
#include "cli/terminal_text.h"

#include <new>

namespace lambert {

Failure currentFailure() {
    try {
        throw;
    } catch (const Error& error) {
        return {error.exitCode(), oneLine(error.what())};
    } catch (const std::bad_alloc&) {
        return {ExitCode::System, "not enough memory"};
    } catch (const std::exception& error) {
        return {ExitCode::System, oneLine(error.what())};
    }
}

} // namespace lambert
