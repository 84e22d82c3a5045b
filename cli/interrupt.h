#pragma once

#include "core/progress.h"

namespace lambert {

/// While it lives, Ctrl-C (SIGINT) and SIGTERM cancel a computation; a second signal ends the process at once.
class InterruptGuard {
public:
    explicit InterruptGuard(Progress& progress);
    ~InterruptGuard();
    InterruptGuard(const InterruptGuard&) = delete;
    InterruptGuard& operator=(const InterruptGuard&) = delete;
};

} // namespace lambert
