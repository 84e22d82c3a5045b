#pragma once

#include "core/progress.h"
#include "formfactors/form_factor_matrix.h"

#include <glm/vec3.hpp>

#include <cstdint>
#include <vector>

namespace lambert {

/// Sums the row of one patch; one per thread, reused from row to row.
class RowAccumulator {
public:
    explicit RowAccumulator(std::size_t patchCount)
        : back_(static_cast<std::uint32_t>(patchCount)),
          sums_(patchCount + 2, 0.0),
          touched_((patchCount + 2 + 63) / 64, 0) {}

    /// Adds to a target: a patch, or one of the two below.
    void add(std::uint32_t target, double value) {
        sums_[target] += value;
        touched_[target / 64] |= std::uint64_t{1} << (target % 64);
    }
    /// Says that all sums are whole multiples of 1 / lines; see FormFactorRow::lines.
    void setLines(std::uint32_t lines) { lines_ = lines; }
    /// See FormFactorRow::error.
    void setError(double error) { error_ = static_cast<float>(error); }
    /// Multiplies all sums.
    void scale(double factor);
    std::uint32_t back() const { return back_; }    ///< target for what meets a black back face
    std::uint32_t out() const { return back_ + 1; } ///< target for what leaves the scene

    /// Moves the sums into `row`, ascending by patch, and starts afresh.
    void take(FormFactorRow& row);

private:
    std::uint32_t back_;
    std::vector<double> sums_;           ///< #patches + 2
    std::vector<std::uint64_t> touched_; ///< one bit per target that something was added to
    std::uint32_t lines_ = 0;
    float error_ = 0.0F;
};

/// A way to compute the form factors from one patch to all others. Thread-safe.
class FormFactorMethod {
public:
    virtual ~FormFactorMethod() = default;
    /// Adds the row of `patch` to an empty `accumulator`. The same arguments give the same bits.
    virtual void row(std::uint32_t patch, RowAccumulator& accumulator) const = 0;
    /// The same for a point: `origin` as is, unit `normal`; `index` tells the random numbers of several points apart. Throws
    /// UsageError where a method has no such rows.
    virtual void pointRow(const glm::vec3& origin, const glm::vec3& normal, std::uint32_t index,
                          RowAccumulator& accumulator) const;
    virtual std::size_t patchCount() const = 0;
    virtual std::uint64_t raysPerRow() const = 0;
    /// By all rows so far, where rows differ; 0: each takes raysPerRow().
    virtual std::uint64_t raysTraced() const { return 0; }
};

class MatrixJournal;

/// All rows, computed in parallel; with a journal those that it does not hold. It then holds all that were computed, also
/// if the computation ends early. Throws Cancelled; of the journal UsageError and SystemError.
FormFactorMatrix computeMatrix(const FormFactorMethod& method, MatrixStorage storage, Progress& progress,
                               MatrixJournal* journal = nullptr);

} // namespace lambert
