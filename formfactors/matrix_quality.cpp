#include "formfactors/matrix_quality.h"

#include "core/parallel.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace lambert {

namespace {

constexpr std::size_t kMostCompared = 4'000; ///< patches up to which all pairs are compared
constexpr std::size_t kSample = 256;         ///< rows above that

/// Compares rows i of a sample with columns i: the pairs that have an end in the sample.
void assessReciprocity(const FormFactorMatrix& matrix, std::span<const float> area, MatrixQuality& quality) {
    const std::size_t count = matrix.size();
    const std::size_t rows = count <= kMostCompared ? count : kSample;
    constexpr auto kNotInSample = std::numeric_limits<std::uint32_t>::max();
    std::vector<std::uint32_t> slot(count, kNotInSample);
    std::vector<std::size_t> sample(rows);
    for (std::size_t k = 0; k < rows; ++k) {
        sample[k] = k * count / rows;
        slot[sample[k]] = static_cast<std::uint32_t>(k);
    }
    std::vector<double> column(rows * count, 0.0); // A_j F_ji of every i in the sample
    parallelFor(count, 64, [&](std::size_t begin, std::size_t end, int) {
        for (std::size_t j = begin; j < end; ++j)
            matrix.visit(j, [&](std::uint32_t i, double factor) {
                if (slot[i] != kNotInSample) column[slot[i] * count + j] = static_cast<double>(area[j]) * factor;
            });
    });
    double squares = 0.0;
    double differences = 0.0;
    std::vector<double> row(count);
    for (std::size_t k = 0; k < rows; ++k) {
        const std::size_t i = sample[k];
        std::fill(row.begin(), row.end(), 0.0);
        matrix.visit(i, [&](std::uint32_t j, double factor) { row[j] = static_cast<double>(area[i]) * factor; });
        for (std::size_t j = 0; j < count; ++j) {
            const double mean = 0.5 * (row[j] + column[k * count + j]);
            const double difference = row[j] - column[k * count + j];
            if (mean == 0.0) continue;
            squares += mean * mean;
            differences += difference * difference;
            const auto smaller = static_cast<double>(std::min(area[i], area[j]));
            if (smaller > 0.0)
                quality.reciprocityWorst = std::max(quality.reciprocityWorst, std::abs(difference) / smaller);
        }
    }
    quality.comparedRows = rows;
    quality.reciprocityRms = squares > 0.0 ? std::sqrt(differences / squares) : 0.0;
}

} // namespace

MatrixQuality assessMatrix(const FormFactorMatrix& matrix, std::span<const float> area) {
    MatrixQuality quality;
    for (std::size_t i = 0; i < matrix.size(); ++i) {
        const auto error = static_cast<double>(matrix.error(i));
        quality.meanError += error / static_cast<double>(matrix.size());
        quality.largestError = std::max(quality.largestError, error);
    }
    const std::size_t count = matrix.size();
    std::vector<double> sum(count, 0.0);
    parallelFor(count, 64, [&](std::size_t begin, std::size_t end, int) {
        for (std::size_t i = begin; i < end; ++i)
            matrix.visit(i, [&](std::uint32_t, double factor) { sum[i] += factor; });
    });
    double squares = 0.0;
    double wholeArea = 0.0;
    for (std::size_t i = 0; i < count; ++i) {
        const double error = sum[i] + matrix.back(i) + matrix.out(i) - 1.0;
        squares += error * error;
        if (std::abs(error) > quality.closureWorst) {
            quality.closureWorst = std::abs(error);
            quality.worstRow = i;
        }
        const auto a = static_cast<double>(area[i]);
        wholeArea += a;
        quality.back += a * matrix.back(i);
        quality.out += a * matrix.out(i);
        if (matrix.back(i) > kCovered)
            quality.coveredArea += a;
        else
            quality.openBack += a * matrix.back(i);
    }
    if (count > 0) quality.closureRms = std::sqrt(squares / static_cast<double>(count));
    if (wholeArea > 0.0) {
        quality.back /= wholeArea;
        quality.out /= wholeArea;
        if (wholeArea > quality.coveredArea) quality.openBack /= wholeArea - quality.coveredArea;
    }
    quality.entries = matrix.entryCount();
    quality.bytes = matrix.bytes();
    assessReciprocity(matrix, area, quality);
    return quality;
}

std::vector<double> columnDeficit(const FormFactorMatrix& matrix, std::span<const float> area) {
    const std::size_t count = matrix.size();
    std::vector<double> received(count, 0.0); // Σ_i A_i F_ij
    for (std::size_t i = 0; i < count; ++i)
        matrix.visit(i, [&](std::uint32_t j, double factor) { received[j] += static_cast<double>(area[i]) * factor; });
    for (std::size_t j = 0; j < count; ++j)
        received[j] = static_cast<double>(area[j]) * (1.0 - matrix.back(j) - matrix.out(j)) - received[j];
    return received;
}

ColumnClosure columnClosure(const FormFactorMatrix& matrix, std::span<const float> area) {
    const std::size_t count = matrix.size();
    const std::vector<double> deficit = columnDeficit(matrix, area);
    ColumnClosure result;
    result.error.resize(count);
    double squares = 0.0;
    for (std::size_t j = 0; j < count; ++j) {
        const double error = std::abs(deficit[j]) / static_cast<double>(area[j]);
        result.error[j] = static_cast<float>(error);
        squares += error * error;
    }
    if (count > 0) result.rms = std::sqrt(squares / static_cast<double>(count));
    return result;
}

} // namespace lambert
