#pragma once

#include "formfactors/form_factor_method.h"
#include "solver/form_factor_rows.h"

#include <atomic>
#include <memory>
#include <mutex>
#include <unordered_map>

namespace lambert {

/// Rows that are computed when asked for, each time anew. Memory: 16 bytes per patch, and per thread a few rows.
class ComputedRows : public FormFactorRows {
public:
    /// `method` must outlive this.
    explicit ComputedRows(const FormFactorMethod& method);

    std::size_t size() const override { return method_.patchCount(); }
    void row(std::uint32_t patch, FormFactorRow& row) override;
    RgbSum gather(std::uint32_t patch, std::span<const RgbSum> radiosity) override;
    RgbSum gather(std::uint32_t patch, std::span<const RgbSum> radiosity, PatchRange aside,
                  std::vector<FormFactor>& inside) override;

    /// Rows are computed in parallel ahead of row().
    std::size_t wanted(std::uint32_t patch) const override;
    void expect(std::span<const std::uint32_t> patches) override;

    /// Computes the rows that nobody has asked for.
    void complete(Progress& progress) override;
    double back(std::uint32_t patch) const override { return back_[patch]; }
    double out(std::uint32_t patch) const override { return out_[patch]; }

    std::uint64_t rowsComputed() const { return rowsComputed_; }
    /// max |Σ_j F_ij + F_i,back + F_i,out − 1| over the rows that were computed.
    double largestClosureError() const { return largestClosureError_; }

private:
    void compute(std::uint32_t patch, FormFactorRow& row);

    const FormFactorMethod& method_;
    std::vector<double> back_, out_; ///< #patches, NaN until known
    std::unordered_map<std::uint32_t, FormFactorRow> ahead_;
    std::vector<std::unique_ptr<RowAccumulator>> accumulators_; ///< that no thread uses now
    std::mutex mutex_;                                          ///< of accumulators_
    std::atomic<std::uint64_t> rowsComputed_{0};
    std::atomic<double> largestClosureError_{0.0};
};

} // namespace lambert
