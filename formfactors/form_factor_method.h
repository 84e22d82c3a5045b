#pragma once

#include "core/progress.h"
#include "formfactors/form_factor_matrix.h"

#include <cstdint>
#include <vector>

namespace lambert {

/// Sums the row of one patch; one per thread, reused from row to row.
class RowAccumulator {
public:
    explicit RowAccumulator(std::size_t patchCount) : sums_(patchCount, 0.0) {}

    void add(std::uint32_t patch, double value) {
        if (sums_[patch] == 0.0) touched_.push_back(patch);
        sums_[patch] += value;
    }
    void addBack(double value) { back_ += value; }
    void addOut(double value) { out_ += value; }

    /// Moves the sums into `row`, ascending by patch, and starts afresh.
    void take(FormFactorRow& row);

private:
    std::vector<double> sums_; ///< #patches, 0 where nothing was added
    std::vector<std::uint32_t> touched_;
    double back_ = 0.0, out_ = 0.0;
};

/// A way to compute the form factors from one patch to all others. Thread-safe.
class FormFactorMethod {
public:
    virtual ~FormFactorMethod() = default;
    /// Adds the row of `patch` to an empty `accumulator`. The same arguments give the same bits.
    virtual void row(std::uint32_t patch, RowAccumulator& accumulator) const = 0;
    virtual std::size_t patchCount() const = 0;
    virtual std::uint64_t raysPerRow() const = 0;
};

/// All rows, computed in parallel. Throws Cancelled.
FormFactorMatrix computeMatrix(const FormFactorMethod& method, Progress& progress);

} // namespace lambert
