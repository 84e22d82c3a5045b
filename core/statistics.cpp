#include "core/statistics.h"

#include <cmath>
#include <vector>

namespace lambert {

MeanDeviation meanDeviation(std::span<const double> values) {
    MeanDeviation result;
    const auto count = static_cast<double>(values.size());
    for (const double v : values) result.mean += v / count;
    if (values.size() < 2) return result;
    double squares = 0.0;
    for (const double v : values) squares += (v - result.mean) * (v - result.mean);
    result.deviation = std::sqrt(squares / (count - 1.0));
    return result;
}

double PowerLaw::at(double x) const { return coefficient * std::pow(x, exponent); }

std::optional<PowerLaw> fitPowerLaw(std::span<const double> x, std::span<const double> y) {
    const auto usable = [](double v) { return v > 0.0 && std::isfinite(v); };
    std::vector<double> u, v;
    for (std::size_t i = 0; i < x.size(); ++i) {
        if (!usable(x[i]) || !usable(y[i])) continue;
        u.push_back(std::log(x[i]));
        v.push_back(std::log(y[i]));
    }
    if (u.size() < 2) return std::nullopt;
    const double meanU = meanDeviation(u).mean;
    const double meanV = meanDeviation(v).mean;
    double squares = 0.0;
    double products = 0.0;
    for (std::size_t i = 0; i < u.size(); ++i) {
        squares += (u[i] - meanU) * (u[i] - meanU);
        products += (u[i] - meanU) * (v[i] - meanV);
    }
    if (!(squares > 1e-12)) return std::nullopt;
    PowerLaw law;
    law.exponent = products / squares;
    law.coefficient = std::exp(meanV - law.exponent * meanU);
    if (u.size() > 2) {
        double residuals = 0.0;
        for (std::size_t i = 0; i < u.size(); ++i) {
            const double residual = v[i] - meanV - law.exponent * (u[i] - meanU);
            residuals += residual * residual;
        }
        law.exponentError = std::sqrt(residuals / (static_cast<double>(u.size()) - 2.0) / squares);
    }
    return law;
}

std::optional<double> costToReach(double target, std::span<const double> cost, std::span<const double> error) {
    for (std::size_t i = 0; i < error.size(); ++i) {
        if (!(error[i] <= target)) continue;
        if (error[i] == target) return cost[i];
        if (i == 0) return std::nullopt;
        const auto law = fitPowerLaw(error.subspan(i - 1, 2), cost.subspan(i - 1, 2));
        return law ? law->at(target) : cost[i];
    }
    return std::nullopt;
}

} // namespace lambert
