#include "comparison/form_factor_errors.h"

#include "core/parallel.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace lambert {

namespace {

/// Calls `use(row, reference's row, worker)` for all rows in parallel, the reference's as a dense array of #patches values.
template <typename Use>
void forEachRow(const FormFactorMatrix& reference, const Use& use) {
    std::vector<std::vector<double>> dense(static_cast<std::size_t>(threadCount()),
                                           std::vector<double>(reference.size(), 0.0));
    parallelFor(reference.size(), 16, [&](std::size_t begin, std::size_t end, int worker) {
        std::vector<double>& row = dense[static_cast<std::size_t>(worker)];
        for (std::size_t i = begin; i < end; ++i) {
            reference.visit(i, [&](std::uint32_t j, double factor) { row[j] = factor; });
            use(i, row, worker);
            reference.visit(i, [&](std::uint32_t j, double) { row[j] = 0.0; });
        }
    });
}

/// Scratch rows, one per thread.
std::vector<std::vector<double>> scratchRows(std::size_t size) {
    return std::vector<std::vector<double>>(static_cast<std::size_t>(threadCount()), std::vector<double>(size, 0.0));
}

void fill(std::vector<double>& row, const FormFactorMatrix& matrix, std::size_t i) {
    std::fill(row.begin(), row.end(), 0.0);
    matrix.visit(i, [&](std::uint32_t j, double factor) { row[j] = factor; });
}

/// What one row adds to the sums over pairs.
struct RowSums {
    double squares = 0.0, maximum = 0.0, absolute = 0.0;
    double relative = 0.0, relativeSquares = 0.0;
    std::size_t pairs = 0; ///< above the threshold
};

RowSums rowSums(const std::vector<double>& found, const std::vector<double>& reference, double threshold) {
    RowSums sums;
    for (std::size_t j = 0; j < reference.size(); ++j) {
        const double difference = std::abs(found[j] - reference[j]);
        sums.squares += difference * difference;
        sums.absolute += difference;
        sums.maximum = std::max(sums.maximum, difference);
        if (reference[j] < threshold || !(reference[j] > 0.0)) continue;
        const double relative = found[j] / reference[j] - 1.0;
        sums.relative += relative;
        sums.relativeSquares += relative * relative;
        ++sums.pairs;
    }
    return sums;
}

} // namespace

FormFactorErrors formFactorErrors(const FormFactorMatrix& found, const FormFactorMatrix& reference,
                                  std::span<const float> area, double threshold) {
    const std::size_t count = reference.size();
    std::vector<std::vector<double>> scratch = scratchRows(count);
    std::vector<RowSums> rows(count);
    forEachRow(reference, [&](std::size_t i, const std::vector<double>& expected, int worker) {
        std::vector<double>& row = scratch[static_cast<std::size_t>(worker)];
        fill(row, found, i);
        rows[i] = rowSums(row, expected, threshold);
    });
    FormFactorErrors result;
    result.misdirectedBy.reserve(count);
    RowSums all;
    double wholeArea = 0.0;
    for (std::size_t i = 0; i < count; ++i) {
        const double misdirected = 0.5 * (rows[i].absolute + std::abs(found.back(i) - reference.back(i)) +
                                          std::abs(found.out(i) - reference.out(i)));
        result.misdirectedBy.push_back(static_cast<float>(misdirected));
        result.misdirected += static_cast<double>(area[i]) * misdirected;
        wholeArea += static_cast<double>(area[i]);
        result.maximum = std::max(result.maximum, rows[i].maximum);
        all.squares += rows[i].squares;
        all.relative += rows[i].relative;
        all.relativeSquares += rows[i].relativeSquares;
        all.pairs += rows[i].pairs;
    }
    if (wholeArea > 0.0) result.misdirected /= wholeArea;
    if (count > 1) result.rms = std::sqrt(all.squares / static_cast<double>(count) / static_cast<double>(count - 1));
    if (all.pairs > 0) {
        result.relativeRms = std::sqrt(all.relativeSquares / static_cast<double>(all.pairs));
        result.bias = all.relative / static_cast<double>(all.pairs);
    }
    return result;
}

std::optional<double> systematicError(std::span<const FormFactorMatrix> found, const FormFactorMatrix& reference,
                                      double threshold) {
    if (found.size() < 2) return std::nullopt;
    const auto matrices = static_cast<double>(found.size());
    struct Sums {
        double single = 0.0, mean = 0.0;
        std::size_t pairs = 0;
    };
    std::vector<Sums> rows(reference.size());
    std::vector<std::vector<double>> sums = scratchRows(reference.size()), squares = sums;
    forEachRow(reference, [&](std::size_t i, const std::vector<double>& expected, int worker) {
        std::vector<double>& sum = sums[static_cast<std::size_t>(worker)];
        std::vector<double>& square = squares[static_cast<std::size_t>(worker)];
        std::fill(sum.begin(), sum.end(), 0.0);
        std::fill(square.begin(), square.end(), 0.0);
        for (const FormFactorMatrix& matrix : found) {
            matrix.visit(i, [&](std::uint32_t j, double factor) {
                sum[j] += factor;
                square[j] += factor * factor;
            });
        }
        for (std::size_t j = 0; j < expected.size(); ++j) {
            if (expected[j] < threshold || !(expected[j] > 0.0)) continue;
            const double mean = sum[j] / matrices / expected[j];
            rows[i].mean += (mean - 1.0) * (mean - 1.0);
            rows[i].single += square[j] / matrices / (expected[j] * expected[j]) - 2.0 * mean + 1.0;
            ++rows[i].pairs;
        }
    });
    Sums all;
    for (const Sums& row : rows) {
        all.single += row.single;
        all.mean += row.mean;
        all.pairs += row.pairs;
    }
    if (all.pairs == 0) return std::nullopt;
    const double square = (matrices * all.mean - all.single) / (matrices - 1.0) / static_cast<double>(all.pairs);
    return std::sqrt(std::max(0.0, square));
}

std::vector<FactorSizeError> errorsBySize(std::span<const FormFactorMatrix> found, const FormFactorMatrix& reference) {
    // Half decades from 10^-7 to 1; smaller factors are no one's concern.
    constexpr int kBins = 14;
    constexpr std::size_t kFewestPairs = 10;
    struct Bins {
        double squares[kBins] = {};
        std::size_t pairs[kBins] = {};
    };
    std::vector<Bins> rows(reference.size());
    std::vector<std::vector<double>> scratch = scratchRows(reference.size());
    forEachRow(reference, [&](std::size_t i, const std::vector<double>& expected, int worker) {
        std::vector<double>& row = scratch[static_cast<std::size_t>(worker)];
        for (const FormFactorMatrix& matrix : found) {
            fill(row, matrix, i);
            for (std::size_t j = 0; j < expected.size(); ++j) {
                if (!(expected[j] > 0.0)) continue;
                const int bin = kBins + static_cast<int>(std::floor(2.0 * std::log10(expected[j])));
                if (bin < 0 || bin >= kBins) continue;
                const double relative = row[j] / expected[j] - 1.0;
                rows[i].squares[bin] += relative * relative;
                ++rows[i].pairs[bin];
            }
        }
    });
    std::vector<FactorSizeError> result;
    for (int bin = 0; bin < kBins; ++bin) {
        double squares = 0.0;
        std::size_t samples = 0;
        for (const Bins& row : rows) {
            squares += row.squares[bin];
            samples += row.pairs[bin];
        }
        const std::size_t pairs = found.empty() ? 0 : samples / found.size();
        if (pairs < kFewestPairs) continue;
        result.push_back({std::pow(10.0, 0.5 * (bin - kBins)), std::pow(10.0, 0.5 * (bin + 1 - kBins)), pairs,
                          std::sqrt(squares / static_cast<double>(samples))});
    }
    return result;
}

double radiosityError(const PatchMesh& mesh, const PatchOptics& optics, const std::vector<RgbSum>& found,
                      const std::vector<RgbSum>& reference) {
    double errors = 0.0;
    double light = 0.0;
    for (std::size_t i = 0; i < mesh.size(); ++i) {
        const auto area = static_cast<double>(mesh.area[i]);
        const RgbSum error = found[i] - reference[i];
        const RgbSum reflected = reference[i] - RgbSum(optics.emittedRadiosity[i]);
        errors += area * glm::dot(error, error);
        light += area * glm::dot(reflected, reflected);
    }
    return light > 0.0 ? std::sqrt(errors / light) : 0.0;
}

} // namespace lambert
