#include "formfactors/repair.h"

#include "core/parallel.h"

#include <algorithm>
#include <cmath>

namespace lambert {

namespace {

/// Exchange areas X_ij = X_ji of all pairs of which one sees the other, as compressed rows.
struct ExchangeAreas {
    std::vector<std::size_t> begin;   ///< #patches + 1
    std::vector<std::uint32_t> patch; ///< #entries, ascending within a row
    std::vector<double> value;        ///< m²

    std::size_t size() const { return begin.size() - 1; }

    double rowSum(std::size_t i, const std::vector<double>& scale) const {
        double sum = 0.0;
        for (std::size_t k = begin[i]; k < begin[i + 1]; ++k) sum += value[k] * scale[patch[k]];
        return sum;
    }
};

/// The rows' patches and those that see them, every pair in both rows.
ExchangeAreas pattern(const FormFactorMatrix& matrix) {
    const std::size_t count = matrix.size();
    ExchangeAreas result;
    result.begin.assign(count + 1, 0);
    for (std::size_t i = 0; i < count; ++i) {
        matrix.visit(i, [&](std::uint32_t j, double) {
            ++result.begin[i + 1];
            ++result.begin[j + 1];
        });
    }
    for (std::size_t i = 0; i < count; ++i) result.begin[i + 1] += result.begin[i];
    std::vector<std::uint32_t> both(result.begin.back());
    std::vector<std::size_t> end(result.begin.begin(), result.begin.end() - 1);
    for (std::size_t i = 0; i < count; ++i) {
        matrix.visit(i, [&](std::uint32_t j, double) {
            both[end[i]++] = j;
            both[end[j]++] = static_cast<std::uint32_t>(i);
        });
    }
    std::size_t written = 0;
    for (std::size_t i = 0; i < count; ++i) {
        const auto first = both.begin() + static_cast<std::ptrdiff_t>(result.begin[i]);
        const auto last = both.begin() + static_cast<std::ptrdiff_t>(end[i]);
        std::sort(first, last);
        const auto unique = std::unique(first, last);
        result.begin[i] = written;
        result.patch.insert(result.patch.end(), first, unique);
        written = result.patch.size();
    }
    result.begin[count] = written;
    result.value.assign(written, 0.0);
    return result;
}

/// Weighted means of both rows' estimates. Pairs (i, j) are summed from row i and, mirrored, from row j.
ExchangeAreas merged(const FormFactorMatrix& matrix, std::span<const float> area, std::span<const double> weight,
                     RepairReport& report) {
    ExchangeAreas result = pattern(matrix);
    const auto place = [&](std::size_t row, std::uint32_t column) {
        const auto first = result.patch.begin() + static_cast<std::ptrdiff_t>(result.begin[row]);
        const auto last = result.patch.begin() + static_cast<std::ptrdiff_t>(result.begin[row + 1]);
        return static_cast<std::size_t>(std::lower_bound(first, last, column) - result.patch.begin());
    };
    std::vector<double> difference(result.value.size(), 0.0);
    for (std::size_t i = 0; i < matrix.size(); ++i) {
        matrix.visit(i, [&](std::uint32_t j, double factor) {
            const double exchange = static_cast<double>(area[i]) * factor;
            const double share = weight[i] / (weight[i] + weight[j]) * exchange;
            const std::size_t here = place(i, j);
            const std::size_t there = place(j, static_cast<std::uint32_t>(i));
            result.value[here] += share;
            if (here != there) result.value[there] += share;
            difference[here] += exchange;
            if (here != there) difference[there] -= exchange;
        });
    }
    double squares = 0.0;
    double differences = 0.0;
    for (std::size_t k = 0; k < result.value.size(); ++k) {
        squares += result.value[k] * result.value[k];
        differences += difference[k] * difference[k];
    }
    report.reciprocityError = squares > 0.0 ? std::sqrt(differences / squares) : 0.0;
    return result;
}

/// Σ_j |F_ij − the new factor|, both ascending by j.
double difference(const FormFactorMatrix& matrix, std::size_t i, const std::vector<FormFactor>& changed) {
    double sum = 0.0;
    auto next = changed.begin();
    matrix.visit(i, [&](std::uint32_t j, double factor) {
        while (next != changed.end() && next->patch < j) sum += (next++)->value;
        const bool both = next != changed.end() && next->patch == j;
        sum += std::abs(factor - (both ? (next++)->value : 0.0));
    });
    while (next != changed.end()) sum += (next++)->value;
    return sum;
}

} // namespace

RepairReport repair(FormFactorMatrix& matrix, std::span<const float> area, std::span<const double> weight,
                    const RepairOptions& options) {
    RepairReport report;
    const std::size_t count = matrix.size();
    const ExchangeAreas exchange = merged(matrix, area, weight, report);

    std::vector<double> target(count, 0.0); // A_i s_i
    for (std::size_t i = 0; i < count; ++i)
        if (weight[i] > 0.0)
            target[i] = static_cast<double>(area[i]) * std::max(0.0, 1.0 - matrix.back(i) - matrix.out(i));
    std::vector<double> scale(count, 1.0), sum(count, 0.0);
    const auto error = [&](std::size_t i) {
        return std::abs(scale[i] * sum[i] - target[i]) / static_cast<double>(area[i]);
    };
    const auto worst = [&] {
        parallelFor(count, 256, [&](std::size_t begin, std::size_t end, int) {
            for (std::size_t i = begin; i < end; ++i) sum[i] = exchange.rowSum(i, scale);
        });
        double result = 0.0;
        for (std::size_t i = 0; i < count; ++i) result = std::max(result, error(i));
        return result;
    };
    report.closureError = report.remainingError = worst();
    while (report.remainingError > options.tolerance && report.iterations < options.maxIterations) {
        for (std::size_t i = 0; i < count; ++i)
            if (sum[i] > 0.0) scale[i] = std::sqrt(scale[i] * target[i] / sum[i]);
        report.remainingError = worst();
        ++report.iterations;
    }

    double changed = 0.0;
    double wholeArea = 0.0;
    for (std::size_t i = 0; i < count; ++i) {
        FormFactorRow row;
        row.back = matrix.back(i);
        row.out = matrix.out(i);
        const auto a = static_cast<double>(area[i]);
        for (std::size_t k = exchange.begin[i]; k < exchange.begin[i + 1]; ++k) {
            const double correction = scale[i] * scale[exchange.patch[k]];
            if (exchange.value[k] > 0.0)
                report.largestCorrection = std::max(report.largestCorrection, std::abs(correction - 1.0));
            const double value = exchange.value[k] * correction / a;
            if (value > 0.0) row.entries.push_back({exchange.patch[k], value});
        }
        if (error(i) > options.tolerance) report.failed.push_back(i);
        changed += a * difference(matrix, i, row.entries);
        wholeArea += a;
        matrix.setRow(i, row);
    }
    if (wholeArea > 0.0) report.rowChange = changed / wholeArea;
    return report;
}

} // namespace lambert
