#include "cli/bake_verdict.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace lambert {

namespace {

/// What the solver did not reach, or nothing.
std::string missedTarget(const LightMethod& method, const SolvedScene& solved) {
    if (const StochasticSolution* lines = solved.stochastic()) {
        if (lines->targetReached) return {};
        return fmt::format("--target-error: missed after all of {:.3g} rays: the standard error is {:.2g} %, with what "
                           "is not known of it {:.2g} %",
                           static_cast<double>(lines->rays), 100.0 * lines->relativeError,
                           100.0 * lines->upperRelativeError);
    }
    const auto* const factors = std::get_if<FormFactorLight>(&method);
    if (factors == nullptr || factors->solver.bounces > 0 || solved.largestResidual <= factors->solver.tolerance)
        return {};
    return fmt::format("residual {:.2g} is above --tolerance {:.2g}", solved.largestResidual,
                       factors->solver.tolerance);
}

} // namespace

BakeVerdict judge(const LightMethod& method, const SolvedScene& solved) {
    BakeVerdict verdict;
    std::string missed = missedTarget(method, solved);
    if (!missed.empty() || solved.energyCheck.missed()) verdict.exitCode = ExitCode::TargetMissed;
    if (!missed.empty()) verdict.warnings.push_back(std::move(missed));
    return verdict;
}

std::string imbalanceText(const SolvedScene& solved) {
    const double after = solved.solution.energy.imbalance();
    const FormFactorsUsed* const used = solved.formFactors();
    if (used == nullptr || !used->repair) return fmt::format("energy imbalance {:.2g}", after);
    return fmt::format("energy imbalance {:.2g} before repair, {:.2g} after", solved.energyCheck.judged, after);
}

double worseImbalance(const SolvedScene& solved) {
    const double after = solved.solution.energy.imbalance();
    const double before = solved.energyCheck.beforeRepair.value_or(0.0);
    return std::abs(before) > std::abs(after) ? before : after;
}

} // namespace lambert
