#pragma once

#include "solver/solution.h"

#include <atomic>
#include <cmath>
#include <cstdint>
#include <vector>

namespace lambert {

/// How real numbers become 64-bit integers, whose sum is the same in any order.
///
/// If the magnitudes of all terms of a sum add up to at most `bound`, the sum cannot overflow: the unit is a power of two with
/// bound / 2^62 < unit <= bound / 2^61, so that the terms come to less than 2^62 units, and their rounding, half a unit each,
/// to less than 2^62 more for fewer than 2^63 terms. A sum of n terms is wrong by at most n units / 2 <= n bound / 2^62.
class FixedPointScale {
public:
    /// `bound` >= 0 and finite; 0: all terms are 0.
    explicit FixedPointScale(double bound = 0.0)
        : exponent_(bound > 0.0 ? 61 - std::ilogb(bound) : 0), perUnit_(std::ldexp(1.0, exponent_)) {}

    std::int64_t units(double value) const { return std::llrint(value * perUnit_); }
    double value(std::int64_t units) const { return std::ldexp(static_cast<double>(units), -exponent_); }

private:
    int exponent_;
    double perUnit_;
};

/// Sums per channel that many threads add to, with the same bits whatever their number and order.
class FixedPointSums {
public:
    explicit FixedPointSums(std::size_t count) : units_(3 * count, 0) {}

    std::size_t size() const { return units_.size() / 3; }
    /// For each channel of each sum. Only while all sums are 0, or once they were restored, to the scale they had.
    void setScale(const FixedPointScale& scale) { scale_ = scale; }

    /// From any thread.
    void add(std::size_t index, const Rgb& value) {
        const std::int64_t units[3] = {scale_.units(static_cast<double>(value.x)),
                                       scale_.units(static_cast<double>(value.y)),
                                       scale_.units(static_cast<double>(value.z))};
        addUnits(index, units);
    }
    /// Three channels in units of the scale, from any thread.
    void addUnits(std::size_t index, const std::int64_t* units) {
        for (std::size_t c = 0; c < 3; ++c)
            std::atomic_ref(units_[3 * index + c]).fetch_add(units[c], std::memory_order_relaxed);
    }
    void prefetch(std::size_t index) const { __builtin_prefetch(&units_[3 * index], 1); }

    RgbSum operator[](std::size_t index) const {
        const std::int64_t* u = &units_[3 * index];
        return {scale_.value(u[0]), scale_.value(u[1]), scale_.value(u[2])};
    }
    /// The sum, which is set to 0.
    RgbSum take(std::size_t index) {
        const RgbSum sum = (*this)[index];
        for (std::size_t c = 0; c < 3; ++c) units_[3 * index + c] = 0;
        return sum;
    }

    /// Passes the sums, without their scale, to an archive, see SolverCheckpoint.
    template <typename Archive>
    void keep(Archive& archive) {
        archive(units_);
    }

private:
    std::vector<std::int64_t> units_; ///< channel by channel of one sum after the other
    FixedPointScale scale_;
};

} // namespace lambert
