#include "lighting/factor_diagnosis.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace lambert {

namespace {

/// What a method promises of the sum of a row's errors.
std::optional<double> statedError(const TransportPlan& plan) {
    if (plan.options.method == TransportMethod::ClosedForm) return plan.options.error;
    if (plan.options.method == TransportMethod::Auto) return plan.options.rowError;
    return std::nullopt;
}

/// "a, b or c".
std::string anyOf(const std::vector<std::string>& ways) {
    if (ways.size() == 1) return ways.front();
    return fmt::format("{} or {}", fmt::join(ways.begin(), ways.end() - 1, ", "), ways.back());
}

} // namespace

std::string causeAndRemedy(const std::optional<TransportPlan>& plan, bool bySolver) {
    std::string cause;
    std::vector<std::string> ways;
    if (!plan) {
        cause = "the matrix of the file is not reciprocal";
        ways.emplace_back("computing it anew");
    } else {
        const TransportOptions& o = plan->options;
        switch (o.method) {
        case TransportMethod::Auto:
        case TransportMethod::ClosedForm:
            cause = "patches lie partly inside objects, or their hidden parts are not resolved";
            ways.emplace_back("a smaller --form-factor-error");
            if (o.method == TransportMethod::Auto) ways.emplace_back("a higher --quality");
            break;
        case TransportMethod::Hemicube:
        case TransportMethod::Hemisphere:
            ways.emplace_back("--method auto");
            cause = fmt::format("{} of a patch, {} pixels wide, misjudge{} what is near or small",
                                o.perPatch == 1 ? "one view" : fmt::format("{} views", o.perPatch),
                                o.resolution.value_or(0), o.perPatch == 1 ? "s" : "");
            ways.push_back(fmt::format("--hemicubes {}", 4 * o.perPatch));
            break;
        case TransportMethod::LocalLines:
        case TransportMethod::GlobalLines:
            ways.emplace_back("--method auto");
            cause = fmt::format("{} lines {} are too few", o.lines.value_or(0),
                                o.method == TransportMethod::LocalLines ? "per patch" : "for so many patches");
            ways.emplace_back("more --lines");
            break;
        }
    }
    if (bySolver) ways.emplace_back("--solver stochastic");
    return fmt::format("{}; try {}", cause, anyOf(ways));
}

std::vector<std::string> repairWarnings(const std::optional<TransportPlan>& plan, const RepairReport& repair) {
    std::vector<std::string> warnings;
    const std::optional<double> stated = plan ? statedError(*plan) : std::nullopt;
    if (stated && repair.rowChange > *stated)
        warnings.push_back(fmt::format("repair had to change rows by {:.2g} in the mean, more than the {:.2g} of "
                                       "--form-factor-error: {}",
                                       repair.rowChange, *stated, causeAndRemedy(plan, false)));
    if (!repair.failed.empty())
        warnings.push_back(fmt::format("repair could not close {} rows (by {:.2g} at most, the first is {}): what they "
                                       "are seen by does not fill them; {}",
                                       repair.failed.size(), repair.remainingError, repair.failed.front() + 1,
                                       causeAndRemedy(plan, false)));
    return warnings;
}

} // namespace lambert
