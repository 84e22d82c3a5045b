#include "formfactors/identities.h"

#include "core/parallel.h"

#include <cmath>
#include <cstdint>

namespace lambert {

namespace {

/// The columns of a matrix as compressed rows.
struct Columns {
    std::vector<std::size_t> begin;   ///< #patches + 1
    std::vector<std::uint32_t> patch; ///< #entries, ascending within a column
    std::vector<double> value;

    explicit Columns(const FormFactorMatrix& matrix) : begin(matrix.size() + 1, 0) {
        const std::size_t count = matrix.size();
        for (std::size_t i = 0; i < count; ++i) matrix.visit(i, [&](std::uint32_t j, double) { ++begin[j + 1]; });
        for (std::size_t j = 0; j < count; ++j) begin[j + 1] += begin[j];
        patch.resize(begin.back());
        value.resize(begin.back());
        std::vector<std::size_t> end(begin.begin(), begin.end() - 1);
        for (std::size_t i = 0; i < count; ++i) {
            matrix.visit(i, [&](std::uint32_t j, double factor) {
                patch[end[j]] = static_cast<std::uint32_t>(i);
                value[end[j]++] = factor;
            });
        }
    }
};

/// Squares of a patch's exchange areas with the others, and of their differences between row and column.
struct Squares {
    double means = 0.0, differences = 0.0;
};

double areaWeightedRms(const std::vector<float>& values, std::span<const float> area) {
    double squares = 0.0;
    double sum = 0.0;
    for (std::size_t i = 0; i < values.size(); ++i) {
        const auto a = static_cast<double>(area[i]);
        squares += a * static_cast<double>(values[i]) * static_cast<double>(values[i]);
        sum += a;
    }
    return sum > 0.0 ? std::sqrt(squares / sum) : 0.0;
}

} // namespace

MatrixIdentities matrixIdentities(const FormFactorMatrix& matrix, std::span<const float> area) {
    const std::size_t count = matrix.size();
    const Columns columns(matrix);
    MatrixIdentities result;
    result.rowClosure.resize(count);
    result.columnClosure.resize(count);
    std::vector<Squares> squares(count);
    std::vector<std::vector<double>> differences(static_cast<std::size_t>(threadCount()), std::vector<double>(count)),
        sums = differences;
    parallelFor(count, 16, [&](std::size_t first, std::size_t last, int worker) {
        std::vector<double>& difference = differences[static_cast<std::size_t>(worker)];
        std::vector<double>& sum = sums[static_cast<std::size_t>(worker)];
        for (std::size_t i = first; i < last; ++i) {
            const auto here = static_cast<double>(area[i]);
            const double remainder = matrix.back(i) + matrix.out(i) - 1.0;
            double row = remainder;
            double column = remainder;
            matrix.visit(i, [&](std::uint32_t j, double factor) {
                row += factor;
                sum[j] = difference[j] = here * factor;
            });
            for (std::size_t k = columns.begin[i]; k < columns.begin[i + 1]; ++k) {
                const double exchange = static_cast<double>(area[columns.patch[k]]) * columns.value[k];
                column += exchange / here;
                sum[columns.patch[k]] += exchange;
                difference[columns.patch[k]] -= exchange;
            }
            result.rowClosure[i] = static_cast<float>(std::abs(row));
            result.columnClosure[i] = static_cast<float>(std::abs(column));
            for (std::size_t j = 0; j < count; ++j) {
                squares[i].means += 0.25 * sum[j] * sum[j];
                squares[i].differences += difference[j] * difference[j];
                sum[j] = difference[j] = 0.0;
            }
        }
    });
    Squares all;
    for (const Squares& s : squares) {
        all.means += s.means;
        all.differences += s.differences;
    }
    result.reciprocity = all.means > 0.0 ? std::sqrt(all.differences / all.means) : 0.0;
    result.rowClosureRms = areaWeightedRms(result.rowClosure, area);
    result.columnClosureRms = areaWeightedRms(result.columnClosure, area);
    return result;
}

} // namespace lambert
