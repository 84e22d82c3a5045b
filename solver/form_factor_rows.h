#pragma once

#include "core/progress.h"
#include "formfactors/form_factor_matrix.h"
#include "solver/solution.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace lambert {

/// Patches [begin, end).
struct PatchRange {
    std::uint32_t begin = 0, end = 0;
    bool contains(std::uint32_t patch) const { return patch - begin < end - begin; }
};

/// The form factors as a solver sees them: it does not know whether they are stored or computed when asked for.
/// gather() may be called by several threads at a time.
class FormFactorRows {
public:
    FormFactorRows() = default;
    virtual ~FormFactorRows() = default;
    FormFactorRows(const FormFactorRows&) = delete;
    FormFactorRows& operator=(const FormFactorRows&) = delete;

    virtual std::size_t size() const = 0; //!< #patches

    virtual void row(std::uint32_t patch, FormFactorRow& row) = 0;

    /// Σ_j F_ij B_j for i = `patch`; `radiosity` is B, #patches.
    virtual RgbSum gather(std::uint32_t patch, std::span<const RgbSum> radiosity) = 0;

    /// The same over all patches j outside `aside`; the factors to those inside replace what is in `inside`.
    virtual RgbSum gather(std::uint32_t patch, std::span<const RgbSum> radiosity, PatchRange aside,
                          std::vector<FormFactor>& inside) = 0;

    /// How many patches expect() would like to be told before row() is asked for that of `patch`; 0: none.
    virtual std::size_t wanted(std::uint32_t /*patch*/) const { return 0; }
    /// Says whose rows row() is soon asked for, the next one first. The same rows come, but maybe sooner.
    virtual void expect(std::span<const std::uint32_t> /*patches*/) {}

    /// Makes back() and out() known of all patches: before, they are of the rows that have been asked for. Throws Cancelled.
    virtual void complete(Progress& /*progress*/) {}
    virtual double back(std::uint32_t patch) const = 0; //!< F_i,back
    virtual double out(std::uint32_t patch) const = 0;  //!< F_i,out
};

/// irradiance_i = Σ_j F_ij B_j for all patches, in parallel; both #patches. Throws Cancelled.
void gatherAll(FormFactorRows& rows, std::span<const RgbSum> radiosity, std::span<RgbSum> irradiance,
               const Progress& progress);

/// Rows of a matrix, which must outlive this.
class StoredRows : public FormFactorRows {
public:
    explicit StoredRows(const FormFactorMatrix& matrix) : matrix_(matrix) {}

    std::size_t size() const override { return matrix_.size(); }
    void row(std::uint32_t patch, FormFactorRow& row) override;
    RgbSum gather(std::uint32_t patch, std::span<const RgbSum> radiosity) override;
    RgbSum gather(std::uint32_t patch, std::span<const RgbSum> radiosity, PatchRange aside,
                  std::vector<FormFactor>& inside) override;
    double back(std::uint32_t patch) const override { return matrix_.back(patch); }
    double out(std::uint32_t patch) const override { return matrix_.out(patch); }

private:
    const FormFactorMatrix& matrix_;
};

} // namespace lambert
