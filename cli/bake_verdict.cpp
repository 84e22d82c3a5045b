#include "cli/bake_verdict.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace lambert {

namespace {

/// What the solver did not reach, or nothing.
std::string missedTarget(const BakeOptions& options, const BakedScene& baked) {
    if (baked.stochastic) {
        if (baked.stochastic->targetReached) return {};
        return fmt::format("--target-error: missed after all of {:.3g} rays: the standard error is {:.2g} %, with what "
                           "is not known of it {:.2g} %",
                           static_cast<double>(baked.stochastic->rays), 100.0 * baked.stochastic->relativeError,
                           100.0 * baked.stochastic->upperRelativeError);
    }
    if (baked.instantRadiosity) return {}; // it has none
    double residual = baked.solution.residual;
    for (const BakedLight& light : baked.lights) residual = std::max(residual, light.residual);
    if (residual <= options.solver.tolerance || options.solver.bounces > 0) return {};
    return fmt::format("residual {:.2g} is above --tolerance {:.2g}", residual, options.solver.tolerance);
}

} // namespace

BakeVerdict judge(const BakeOptions& options, const BakedScene& baked) {
    BakeVerdict verdict;
    std::string missed = missedTarget(options, baked);
    if (!missed.empty() || baked.energyCheck.missed()) verdict.exitCode = ExitCode::TargetMissed;
    if (!missed.empty()) verdict.warnings.push_back(std::move(missed));
    return verdict;
}

std::string imbalanceText(const BakedScene& baked) {
    const double after = baked.solution.energy.imbalance();
    if (!baked.repair) return fmt::format("energy imbalance {:.2g}", after);
    return fmt::format("energy imbalance {:.2g} before repair, {:.2g} after", baked.energyCheck.judged, after);
}

double worseImbalance(const BakedScene& baked) {
    const double after = baked.solution.energy.imbalance();
    const double before = baked.energyCheck.beforeRepair.value_or(0.0);
    return std::abs(before) > std::abs(after) ? before : after;
}

} // namespace lambert
