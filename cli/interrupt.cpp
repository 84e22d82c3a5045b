#include "cli/interrupt.h"

#include <atomic>
#include <csignal>

namespace lambert {

namespace {

std::atomic<Progress*> target{nullptr};
static_assert(std::atomic<Progress*>::is_always_lock_free);

extern "C" void onSignal(int signal) {
    if (Progress* progress = target.load()) progress->cancel();
    std::signal(signal, SIG_DFL);
}

} // namespace

InterruptGuard::InterruptGuard(Progress& progress) {
    target = &progress;
    std::signal(SIGINT, onSignal);
    std::signal(SIGTERM, onSignal);
}

InterruptGuard::~InterruptGuard() {
    std::signal(SIGINT, SIG_DFL);
    std::signal(SIGTERM, SIG_DFL);
    target = nullptr;
}

} // namespace lambert
