#include "core/stopwatch.h"
#include "prediction/pilots.h"

#include <algorithm>
#include <cmath>

namespace lambert {

namespace {

constexpr double kRelaxationSlope = 0.6; // the error falls as rays to the minus this
constexpr double kWalkSlope = 0.5;       // the same of random walks
constexpr double kUnknownError = 1.05;   // by which a target error is undershot, for what is not known of the error
constexpr double kFirstPilotRays = 20'000.0, kMostPilotRays = 1e9, kPilotRaysPerPatch = 4.0;
constexpr std::uint32_t kPilotPoints = 16; // of a patch, to lights without area

/// A solve of a few rays: what it took, and what came of it.
struct LinePilot {
    double units = 0.0; ///< rays or walks, as asked for
    double seconds = 0.0;
    double rays = 0.0;
    double error = 0.0;
};

LinePilot solvePilot(const SolverProblem& problem, const MeshedScene& scene, LineSolverOptions options, double units,
                     Progress& progress) {
    options.rays = static_cast<std::uint64_t>(units);
    options.targetError.reset();
    const Stopwatch watch;
    const StochasticSolution solution = solveByLines(problem, scene.mesh, *scene.rays, options, progress);
    return {units, watch.seconds(), static_cast<double>(solution.rays), solution.relativeError};
}

} // namespace

/// Solves with more and more rays until that takes long enough to be timed, and beyond what passes over the patches take.
void pilot(const MeshedScene& scene, const LineSolverOptions& o, const DirectLightOptions& directLight,
           BakePrediction& result, Progress& progress) {
    DirectLightOptions few = directLight;
    few.points = std::min(few.points, kPilotPoints);
    few.skyRays = std::min(few.skyRays, kPilotPoints);
    const SolverProblem problem({scene.mesh, scene.optics},
                                DirectLight(*scene.rays, few).irradiance(scene.mesh, lightsOf(*scene.scene), progress));
    LinePilot before, last = solvePilot(problem, scene, o, kFirstPilotRays, progress);
    do {
        before = last;
        last = solvePilot(problem, scene, o, 4.0 * last.units, progress);
    } while ((last.seconds < kPilotSeconds || last.units < kPilotRaysPerPatch * static_cast<double>(problem.size())) &&
             last.units < kMostPilotRays);
    auto units = static_cast<double>(o.rays.value_or(o.kMostRays));
    if (o.targetError || !o.rays) {
        const double slope = o.solver == LineSolver::RandomWalk ? kWalkSlope : kRelaxationSlope;
        const double excess = kUnknownError * last.error / o.targetError.value_or(o.kTargetError);
        units = std::min(units, last.units * std::pow(excess, 1.0 / slope));
    }
    const double rays = units * last.rays / last.units;
    // Of a difference, as passes over the patches take the same time for few rays as for many.
    if (last.rays > before.rays)
        result.secondsPerRay = std::max(last.seconds - before.seconds, 0.1 * last.seconds) / (last.rays - before.rays);
    result.seconds.solve =
        std::max(last.seconds + (rays - last.rays) * result.secondsPerRay, rays * result.secondsPerRay);
    result.rays = static_cast<std::uint64_t>(rays);
}

} // namespace lambert
