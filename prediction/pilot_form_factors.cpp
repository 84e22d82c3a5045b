#include "core/error.h"
#include "core/parallel.h"
#include "core/stopwatch.h"
#include "prediction/measured_costs.h"
#include "prediction/pilots.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace lambert {

namespace {

struct Pilot {
    std::size_t rows = 0;
    double seconds = 0.0;
    double entries = 0.0;   ///< mean per row
    double reflected = 0.0; ///< mean over the rows: what part of the light that leaves a patch leaves the next as well
};

double brightestChannel(const Rgb& rgb) { return static_cast<double>(std::max({rgb.x, rgb.y, rgb.z})); }

/// Rows of patches spread over the mesh, until they have taken long enough to be timed, or are all.
Pilot pilotRows(const MeshedScene& scene, const FormFactorMethod& method, Progress& progress) {
    const std::size_t count = method.patchCount();
    const auto batch = static_cast<std::size_t>(16 * threadCount());
    const auto patch = [count](std::size_t k) { return spreadIndex(k, count); };
    std::vector<RowAccumulator> accumulators(static_cast<std::size_t>(threadCount()), RowAccumulator(count));
    std::vector<FormFactorRow> rows(batch);
    Pilot pilot;
    const Stopwatch watch;
    do {
        parallelFor(batch, 1, [&](std::size_t begin, std::size_t end, int worker) {
            RowAccumulator& accumulator = accumulators[static_cast<std::size_t>(worker)];
            for (std::size_t k = begin; k < end; ++k) {
                method.row(static_cast<std::uint32_t>(patch(pilot.rows + k)), accumulator);
                accumulator.take(rows[k]);
            }
        });
        for (std::size_t k = 0; k < batch; ++k) {
            pilot.entries += static_cast<double>(rows[k].entries.size());
            pilot.reflected +=
                (1.0 - rows[k].back - rows[k].out) * brightestChannel(scene.optics.reflectance[patch(pilot.rows + k)]);
        }
        pilot.rows += batch;
        pilot.seconds = watch.seconds();
        progress.throwIfCancelled();
    } while (pilot.seconds < kPilotSeconds && pilot.rows < count);
    pilot.entries /= static_cast<double>(pilot.rows);
    pilot.reflected /= static_cast<double>(pilot.rows);
    return pilot;
}

/// How often a solver passes over the matrix. Jacobi's residual falls about by what is reflected from one bounce to the next.
double predictPasses(double reflected, const SolverOptions& options) {
    if (!(options.tolerance > 0.0)) return options.bounces;
    const double share = std::clamp(reflected, 0.01, 0.999);
    const double jacobi = std::max(1.0, std::log(options.tolerance) / std::log(share) + 1.0);
    switch (options.method) {
    case SolverMethod::Jacobi:
        return options.bounces > 0 ? std::min<double>(jacobi, options.bounces) : jacobi;
    case SolverMethod::GaussSeidel:
    case SolverMethod::Southwell:
        return jacobi / 2.0 + 1.0;
    case SolverMethod::ConjugateGradient:
        // As the theory has it but for the factor, which is measured.
        return 3.0 + 0.3 * std::log(2.0 / options.tolerance) / std::sqrt(1.0 - share);
    }
    return jacobi;
}

} // namespace

std::size_t spreadIndex(std::size_t k, std::size_t count) {
    const double at = 0.6180339887498949 * static_cast<double>(k);
    return static_cast<std::size_t>((at - std::floor(at)) * static_cast<double>(count));
}

void pilot(const MeshedScene& scene, const FormFactorLight& method, BakePrediction& result, Progress& progress) {
    const TransportOptions& transport = method.formFactors.transport;
    if (!method.formFactors.file.empty())
        throw UsageError("--dry-run: predicts nothing of a bake from a matrix file (--form-factors)");
    result.plan = planTransport(transport, scene.mesh, *scene.rays, progress);
    if (!hasRows(result.plan->options.method))
        throw UsageError(fmt::format("--dry-run: predicts nothing of {}", nameOf(result.plan->options.method)));
    const auto rows = makeMethod(*result.plan, scene.mesh, *scene.rays);
    const Pilot pilot = pilotRows(scene, *rows, progress);

    const auto patches = static_cast<double>(scene.mesh.size());
    const double secondsPerRow = pilot.seconds / static_cast<double>(pilot.rows);
    const double passes = predictPasses(pilot.reflected, method.solver);
    const double entries = patches * pilot.entries;
    const auto raysPerRow = static_cast<double>(rows->raysPerRow());
    result.secondsPerRay = raysPerRow > 0.0 ? secondsPerRow / raysPerRow : kUnknownSecondsPerRay / threadCount();
    result.seconds.solve = passes * entries * kSolveSeconds / threadCount();
    if (!transport.stored) { // computed in every pass
        result.seconds.solve += passes * patches * secondsPerRow;
        result.rays = static_cast<std::uint64_t>(passes * patches * raysPerRow);
        return;
    }
    result.rays = result.plan->rays;
    result.seconds.formFactors = secondsPerRow * patches;
    result.matrixBytes = static_cast<std::uint64_t>(entries * bytesPerFactor(*result.plan->options.storage) +
                                                    patches * (static_cast<double>(sizeof(FormFactorRow)) + kRowBytes));
}

} // namespace lambert
