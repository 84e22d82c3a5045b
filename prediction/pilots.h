#pragma once

#include "prediction/prediction.h"

namespace lambert {

/// What predictBake tries before it extrapolates, for each way to find the light. They set what they know of a result:
/// the rays, the seconds of form factors and solve, the matrix' bytes, the plan. Throw UsageError if there is no telling.

inline constexpr double kPilotSeconds = 0.4;          //!< the least that is timed
inline constexpr double kUnknownSecondsPerRay = 2e-7; //!< one thread, where nothing was traced

void pilot(const MeshedScene& scene, const FormFactorLight& method, BakePrediction& result, Progress& progress);
/// Takes lights without area by the points and rays of `directLight`, or fewer.
void pilot(const MeshedScene& scene, const LineSolverOptions& method, const DirectLightOptions& directLight,
           BakePrediction& result, Progress& progress);
void pilot(const MeshedScene& scene, const InstantRadiosityOptions& method, BakePrediction& result, Progress& progress);

/// The k-th of indices below `count` that are spread evenly however many of them there are: multiples of the golden ratio, modulo 1.
std::size_t spreadIndex(std::size_t k, std::size_t count);

} // namespace lambert
