#include "formfactors/group_factors.h"

#include "core/parallel.h"

#include <algorithm>
#include <cmath>

namespace lambert {

double GroupFactors::rowSum(std::size_t from) const {
    double sum = back[from] + out[from];
    for (std::size_t to = 0; to < groups; ++to) sum += exchangeArea(from, to);
    return mean(sum, from);
}

double GroupFactors::reciprocityError(std::size_t a, std::size_t b) const {
    const double both = exchangeArea(a, b) + exchangeArea(b, a);
    return both > 0.0 ? 2.0 * std::abs(exchangeArea(a, b) - exchangeArea(b, a)) / both : 0.0;
}

GroupReciprocity groupReciprocity(const GroupFactors& factors) {
    GroupReciprocity result;
    result.largest.assign(factors.groups, 0.0);
    double squares = 0.0;
    double differences = 0.0;
    for (std::size_t a = 0; a < factors.groups; ++a) {
        for (std::size_t b = 0; b < factors.groups; ++b) {
            const double mean = 0.5 * (factors.exchangeArea(a, b) + factors.exchangeArea(b, a));
            const double error = factors.reciprocityError(a, b);
            squares += mean * mean;
            differences += mean * mean * error * error;
            result.largest[a] = std::max(result.largest[a], error);
            if (error > factors.reciprocityError(result.a, result.b)) result.a = a, result.b = b;
        }
    }
    if (squares > 0.0) result.rms = std::sqrt(differences / squares);
    return result;
}

GroupFactors groupFactors(const FormFactorMatrix& matrix, std::span<const float> area,
                          std::span<const std::uint32_t> group, std::size_t groups) {
    GroupFactors result{groups, std::vector<double>(groups, 0.0), std::vector<double>(groups * groups, 0.0),
                        std::vector<double>(groups, 0.0), std::vector<double>(groups, 0.0)};
    // Row by row in parallel, the rows' sums in order: any number of threads gives the same bits.
    constexpr std::size_t kRows = 1024;
    const std::size_t targets = groups + 1; // the last one is for patches without group
    std::vector<double> sums(kRows * targets);
    for (std::size_t first = 0; first < matrix.size(); first += kRows) {
        const std::size_t rows = std::min(kRows, matrix.size() - first);
        std::fill(sums.begin(), sums.end(), 0.0);
        parallelFor(rows, 16, [&](std::size_t begin, std::size_t end, int) {
            for (std::size_t k = begin; k < end; ++k)
                matrix.visit(first + k, [&](std::uint32_t j, double factor) {
                    sums[k * targets + std::min<std::size_t>(group[j], groups)] += factor;
                });
        });
        for (std::size_t k = 0; k < rows; ++k) {
            const std::size_t i = first + k;
            if (group[i] == kNoGroup) continue;
            const std::size_t from = group[i];
            const auto a = static_cast<double>(area[i]);
            result.area[from] += a;
            result.back[from] += a * (matrix.back(i) + sums[k * targets + groups]);
            result.out[from] += a * matrix.out(i);
            for (std::size_t to = 0; to < groups; ++to)
                result.exchange[from * groups + to] += a * sums[k * targets + to];
        }
    }
    return result;
}

} // namespace lambert
