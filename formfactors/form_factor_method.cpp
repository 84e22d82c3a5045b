#include "formfactors/form_factor_method.h"

#include "core/parallel.h"

#include <algorithm>

namespace lambert {

void RowAccumulator::take(FormFactorRow& row) {
    std::sort(touched_.begin(), touched_.end());
    row.entries.clear();
    row.entries.reserve(touched_.size());
    for (const std::uint32_t patch : touched_) {
        row.entries.push_back({patch, static_cast<float>(sums_[patch])});
        sums_[patch] = 0.0;
    }
    row.back = back_;
    row.out = out_;
    touched_.clear();
    back_ = out_ = 0.0;
}

FormFactorMatrix computeMatrix(const FormFactorMethod& method, Progress& progress) {
    FormFactorMatrix matrix;
    matrix.rows.resize(method.patchCount());
    std::vector<RowAccumulator> accumulators(static_cast<std::size_t>(threadCount()),
                                             RowAccumulator(method.patchCount()));
    progress.begin("form factors", method.patchCount());
    parallelFor(method.patchCount(), 8, [&](std::size_t begin, std::size_t end, int worker) {
        RowAccumulator& accumulator = accumulators[static_cast<std::size_t>(worker)];
        for (std::size_t patch = begin; patch < end; ++patch) {
            method.row(static_cast<std::uint32_t>(patch), accumulator);
            accumulator.take(matrix.rows[patch]);
        }
        progress.advance(end - begin);
    });
    progress.end();
    return matrix;
}

} // namespace lambert
