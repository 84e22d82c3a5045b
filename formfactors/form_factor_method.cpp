#include "formfactors/form_factor_method.h"

#include "core/error.h"
#include "core/parallel.h"
#include "formfactors/matrix_journal.h"

#include <bit>
#include <utility>

namespace lambert {

void RowAccumulator::scale(double factor) {
    if (factor == 1.0) return;
    for (std::size_t i = 0; i < touched_.size(); ++i)
        for (std::uint64_t word = touched_[i]; word != 0; word &= word - 1)
            sums_[64 * i + static_cast<std::size_t>(std::countr_zero(word))] *= factor;
}

void RowAccumulator::take(FormFactorRow& row) {
    const auto drain = [this](std::uint32_t target) { return std::exchange(sums_[target], 0.0); };
    row.back = drain(back());
    row.out = drain(out());
    row.entries.clear();
    row.lines = std::exchange(lines_, 0);
    row.error = std::exchange(error_, 0.0F);
    for (std::size_t i = 0; i < touched_.size(); ++i) {
        for (std::uint64_t word = std::exchange(touched_[i], 0); word != 0; word &= word - 1) {
            const auto patch = static_cast<std::uint32_t>(64 * i + static_cast<std::size_t>(std::countr_zero(word)));
            if (patch < back()) row.entries.push_back({patch, drain(patch)});
        }
    }
}

void FormFactorMethod::pointRow(const glm::vec3&, const glm::vec3&, std::uint32_t, RowAccumulator&) const {
    throw UsageError("this method computes no form factors from points");
}

FormFactorMatrix computeMatrix(const FormFactorMethod& method, MatrixStorage storage, Progress& progress,
                               MatrixJournal* journal) {
    FormFactorMatrix matrix(method.patchCount(), storage);
    std::vector<bool> done(method.patchCount(), false);
    if (journal) done = journal->restore(matrix);
    std::vector<RowAccumulator> accumulators(static_cast<std::size_t>(threadCount()),
                                             RowAccumulator(method.patchCount()));
    progress.begin("form factors", method.patchCount());
    const auto compute = [&](std::size_t begin, std::size_t end, int worker) {
        RowAccumulator& accumulator = accumulators[static_cast<std::size_t>(worker)];
        FormFactorRow row;
        for (std::size_t patch = begin; patch < end; ++patch) {
            if (done[patch]) {
                progress.advance();
                continue;
            }
            method.row(static_cast<std::uint32_t>(patch), accumulator);
            accumulator.take(row);
            matrix.setRow(patch, row);
            if (journal) journal->add(matrix, patch);
            progress.advance(); // a row of closed forms may take seconds: none more once cancelled
        }
    };
    try {
        parallelFor(method.patchCount(), 8, compute);
    } catch (...) {
        if (journal) journal->flush(matrix);
        throw;
    }
    if (journal) journal->flush(matrix);
    progress.end();
    return matrix;
}

} // namespace lambert
