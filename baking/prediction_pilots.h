#pragma once

#include "baking/prediction.h"

namespace lambert {

/// What predictBake tries before it extrapolates, for each way to find the light. They set what they know of a result:
/// the rays, the seconds of form factors and solve, the matrix' bytes, the plan. Throw UsageError if there is no telling.

inline constexpr double kPilotSeconds = 0.4;          //!< the least that is timed
inline constexpr double kUnknownSecondsPerRay = 2e-7; //!< one thread, where nothing was traced

void pilotFormFactors(const MeshedScene& scene, const BakeOptions& options, BakePrediction& result, Progress& progress);
void pilotLines(const MeshedScene& scene, const BakeOptions& options, BakePrediction& result, Progress& progress);
void pilotInstantRadiosity(const MeshedScene& scene, const BakeOptions& options, BakePrediction& result,
                           Progress& progress);

/// The k-th of indices below `count` that are spread evenly however many of them there are: multiples of the golden ratio, modulo 1.
std::size_t spreadIndex(std::size_t k, std::size_t count);

} // namespace lambert
