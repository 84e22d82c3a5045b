#pragma once

#include "solver/solution.h"

#include <cstdint>
#include <vector>

namespace lambert {

/// What a stochastic solver knows beyond the solution.
struct StochasticSolution : RadiositySolution {
    std::vector<Rgb> standardError; //!< #patches, of the irradiance
    /// sqrt(Σ A |standard error|²) / sqrt(Σ A |E|²) over patches and channels; also the `residual` and those of `history`.
    double relativeError = 0.0;
    double upperRelativeError = 0.0; //!< which the actual relative error exceeds at most once in twenty times
    bool targetReached = true;       //!< false: the rays were used up before the target error was reached
    std::uint64_t rays = 0;          //!< or lines
    int subRuns = 0;
    double unshot = 0.0;         //!< share of the emitted power that shooting did not pass on, mean of the sub-runs
    double imbalanceError = 0.0; //!< standard error of energy.imbalance()
};

} // namespace lambert
