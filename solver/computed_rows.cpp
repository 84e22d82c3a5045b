#include "solver/computed_rows.h"

#include "core/parallel.h"

#include <cmath>
#include <limits>
#include <utility>

namespace lambert {

namespace {

/// Rows of about equal effort, so many that threads seldom wait for each other, and so few that most are used.
constexpr std::size_t kAheadPerThread = 4;
/// Rows kept that were computed ahead and not asked for yet.
constexpr std::size_t kMostAheadPerThread = 16;

std::size_t threads() { return static_cast<std::size_t>(threadCount()); }

} // namespace

ComputedRows::ComputedRows(const FormFactorMethod& method)
    : method_(method), back_(method.patchCount(), std::numeric_limits<double>::quiet_NaN()), out_(back_) {}

void ComputedRows::compute(std::uint32_t patch, FormFactorRow& row) {
    std::unique_ptr<RowAccumulator> accumulator;
    {
        const std::lock_guard lock(mutex_);
        if (!accumulators_.empty()) {
            accumulator = std::move(accumulators_.back());
            accumulators_.pop_back();
        }
    }
    if (!accumulator) accumulator = std::make_unique<RowAccumulator>(size());
    method_.row(patch, *accumulator);
    accumulator->take(row);
    back_[patch] = row.back;
    out_[patch] = row.out;
    ++rowsComputed_;
    const double error = std::abs(row.sum() - 1.0);
    for (double largest = largestClosureError_; error > largest;)
        if (largestClosureError_.compare_exchange_weak(largest, error)) break;
    const std::lock_guard lock(mutex_);
    accumulators_.push_back(std::move(accumulator));
}

void ComputedRows::row(std::uint32_t patch, FormFactorRow& row) {
    if (auto found = ahead_.extract(patch))
        row = std::move(found.mapped());
    else
        compute(patch, row);
}

RgbSum ComputedRows::gather(std::uint32_t patch, std::span<const RgbSum> radiosity) {
    std::vector<FormFactor> none;
    return gather(patch, radiosity, {}, none);
}

RgbSum ComputedRows::gather(std::uint32_t patch, std::span<const RgbSum> radiosity, PatchRange aside,
                            std::vector<FormFactor>& inside) {
    FormFactorRow row;
    compute(patch, row);
    inside.clear();
    RgbSum sum(0.0);
    for (const FormFactor& factor : row.entries) {
        if (aside.contains(factor.patch))
            inside.push_back(factor);
        else
            sum += factor.value * radiosity[factor.patch];
    }
    return sum;
}

std::size_t ComputedRows::wanted(std::uint32_t patch) const {
    return ahead_.contains(patch) ? 0 : kAheadPerThread * threads();
}

void ComputedRows::expect(std::span<const std::uint32_t> patches) {
    if (ahead_.size() + patches.size() > kMostAheadPerThread * threads()) ahead_.clear();
    std::vector<std::uint32_t> missing;
    for (const std::uint32_t patch : patches)
        if (!ahead_.contains(patch)) missing.push_back(patch);
    std::vector<FormFactorRow> rows(missing.size());
    parallelFor(missing.size(), 1, [&](std::size_t begin, std::size_t end, int) {
        for (std::size_t k = begin; k < end; ++k) compute(missing[k], rows[k]);
    });
    for (std::size_t k = 0; k < missing.size(); ++k) ahead_.emplace(missing[k], std::move(rows[k]));
}

void ComputedRows::complete(Progress& progress) {
    std::vector<std::uint32_t> missing;
    for (std::uint32_t i = 0; i < size(); ++i)
        if (std::isnan(back_[i])) missing.push_back(i);
    if (missing.empty()) return;
    progress.begin("form factors of what has shot nothing", missing.size());
    parallelFor(missing.size(), 8, [&](std::size_t begin, std::size_t end, int) {
        FormFactorRow row;
        for (std::size_t k = begin; k < end; ++k) compute(missing[k], row);
        progress.advance(end - begin);
    });
    progress.end();
}

} // namespace lambert
