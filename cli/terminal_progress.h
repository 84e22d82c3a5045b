#pragma once

#include "core/progress.h"

#include <atomic>
#include <chrono>
#include <mutex>
#include <string>

namespace lambert {

/// A progress line on stderr: stage, done, total, rate, time left. Silent where stderr is no terminal, or if `quiet`.
///
/// While it lives, Ctrl-C (SIGINT) and SIGTERM cancel the computation; a second signal ends the process at once.
class TerminalProgress : public Progress {
public:
    explicit TerminalProgress(bool quiet);
    ~TerminalProgress() override;

    /// What stands before the stage from now on, such as "[3/12] kitchen.glb"; to be called between stages.
    void setTitle(const std::string& title);

protected:
    void onBegin(std::string_view stage, std::uint64_t total) override;
    void onAdvance(std::uint64_t done, std::uint64_t total) override;
    void onEnd() override;

private:
    using Clock = std::chrono::steady_clock;
    void clearLine();

    bool visible_;
    std::mutex mutex_;
    std::string title_, stage_;
    Clock::time_point start_;
    std::atomic<Clock::duration::rep> nextUpdate_{0};
    bool lineShown_ = false;
};

} // namespace lambert
