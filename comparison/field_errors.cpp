#include "comparison/field_errors.h"

#include "core/error.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

namespace lambert {

namespace {

/// The smallest value that so much of the weight does not exceed.
double percentile(std::vector<std::pair<double, double>> valuesAndWeights, double share) {
    std::sort(valuesAndWeights.begin(), valuesAndWeights.end());
    double total = 0.0;
    for (const auto& [value, weight] : valuesAndWeights) total += weight;
    double below = 0.0;
    for (const auto& [value, weight] : valuesAndWeights)
        if ((below += weight) >= share * total) return value;
    return valuesAndWeights.back().first;
}

/// 1 if both are 0, infinite if only `below` is.
double ratio(double above, double below) { return above == below ? 1.0 : above / below; }

} // namespace

FieldErrors fieldErrors(std::span<const double> weight, std::span<const double> reference,
                        std::span<const double> field) {
    if (weight.empty() || weight.size() != reference.size() || weight.size() != field.size())
        throw UsageError("fields that are compared must have the same length, which is not 0");
    FieldErrors errors;
    double total = 0.0, sum = 0.0;
    std::vector<std::pair<double, double>> absolute;
    absolute.reserve(weight.size());
    for (std::size_t i = 0; i < weight.size(); ++i) {
        const double difference = field[i] - reference[i];
        total += weight[i];
        sum += weight[i] * field[i];
        errors.mean += weight[i] * reference[i];
        errors.bias += weight[i] * difference;
        errors.meanAbsolute += weight[i] * std::abs(difference);
        errors.rms += weight[i] * difference * difference;
        errors.maximum = std::max(errors.maximum, std::abs(difference));
        absolute.emplace_back(std::abs(difference), weight[i]);
    }
    if (!(total > 0.0)) throw UsageError("fields that are compared must have some weight");
    errors.energyRatio = ratio(sum, errors.mean);
    errors.mean /= total;
    errors.bias /= total;
    errors.meanAbsolute /= total;
    errors.rms = std::sqrt(errors.rms / total);
    errors.relativeRms = errors.rms == 0.0 ? 0.0 : errors.rms / errors.mean;
    errors.percentile99 = percentile(std::move(absolute), 0.99);
    return errors;
}

} // namespace lambert
