#pragma once

#include "core/state_checkpoint.h"
#include "core/stopwatch.h"
#include "solver/solution.h"

#include <span>
#include <string>
#include <utility>
#include <vector>

namespace lambert {

/// The state of an unfinished solve, see StateCheckpoint.
class SolverCheckpoint : public StateCheckpoint {
public:
    SolverCheckpoint(const CheckpointOptions& options, std::string identity)
        : StateCheckpoint(options, "solver", std::move(identity)) {}
};

/// How a solver begins, and what it leaves behind while it works.
struct SolverContext {
    /// #patches: irradiances E to begin from, as B = B_e + ρ E; empty: from B = B_e.
    std::span<const RgbSum> start{};
    SolverCheckpoint* checkpoint = nullptr; //!< or none

    template <typename State>
    bool restore(const State& state) const {
        return checkpoint != nullptr && checkpoint->restore(state);
    }
    template <typename State>
    void offer(const State& state) const {
        if (checkpoint != nullptr) checkpoint->offer(state);
    }
};

/// Seconds of a solve, with those of the earlier run that it goes on with.
class SolverClock {
public:
    explicit SolverClock(const std::vector<SolverStep>& history)
        : before_(history.empty() ? 0.0 : history.back().seconds) {}
    double seconds() const { return before_ + watch_.seconds(); }

private:
    double before_;
    Stopwatch watch_;
};

} // namespace lambert
