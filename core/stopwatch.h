#pragma once

#include <chrono>

namespace lambert {

/// Wall time since it was made.
class Stopwatch {
public:
    /// Seconds since the start.
    double seconds() const { return since(start_); }
    /// Seconds since the last call of lap(), or since the start.
    double lap() {
        const double elapsed = since(lap_);
        lap_ = Clock::now();
        return elapsed;
    }

private:
    using Clock = std::chrono::steady_clock;
    static double since(Clock::time_point from) { return std::chrono::duration<double>(Clock::now() - from).count(); }

    Clock::time_point start_ = Clock::now();
    Clock::time_point lap_ = start_;
};

} // namespace lambert
