#pragma once

#include "core/progress.h"
#include "formfactors/form_factor_matrix.h"

#include <cstdint>
#include <span>
#include <vector>

namespace lambert {

/// What lies at the ends of spans, before it is counted; one per thread. Spans are kept by blocks of patches, so that
/// blocks can be counted in parallel.
class SpanLog {
public:
    /// At most kMostPatches patches.
    explicit SpanLog(std::size_t patches);
    static constexpr std::size_t kMostPatches = (std::size_t{1} << 26) - 2;

    std::uint32_t back() const { return patches_; }    ///< the end at a black back face
    std::uint32_t out() const { return patches_ + 1; } ///< the end outside of the scene

    /// A stretch of a line between two ends, in either order. Without effect if neither is a patch.
    void add(std::uint32_t a, std::uint32_t b) {
        const std::uint32_t row = a < b ? a : b;
        const std::uint32_t column = a < b ? b : a;
        if (row >= patches_) return;
        blocks_[row >> rowBits_].push_back((row & ((1U << rowBits_) - 1U)) << columnBits_ | column);
    }
    std::uint64_t size() const; ///< spans held
    void clear();

private:
    friend class GlobalLineCounts;
    std::uint32_t patches_;
    unsigned columnBits_, rowBits_;
    std::vector<std::vector<std::uint32_t>> blocks_; ///< by row >> rowBits_: row within the block and column
};

/// How many spans of lines connect each pair of patches, each patch with black backs, and each with the outside. Counts are
/// whole numbers: they do not depend on the order in which lines were traced. One to three bytes per pair that is connected.
class GlobalLineCounts {
public:
    explicit GlobalLineCounts(std::size_t patches);

    std::size_t size() const { return rows_.size(); } //!< #patches
    std::uint64_t lines() const { return lines_; }    //!< traced so far

    /// Counts the spans of `lines` further lines and clears the logs.
    void count(std::span<SpanLog> logs, std::uint64_t lines);

    /// N_i, the number of lines that cross each patch: #patches, 0 for a row that stays empty.
    std::vector<std::uint32_t> crossings() const;

    /// Rows F_ij = N_ij / N_i, exact in compact storage. A patch without crossings has an empty row (no entries, no remainders:
    /// FormFactorMatrix::isEmpty), nothing being known of it. Reciprocal after repair() with repairWeights(). Throws Cancelled.
    FormFactorMatrix matrix(MatrixStorage storage, Progress& progress) const;

    /// N_i / A_i, as repair() wants it: its merge then gives X_ij = (N_ij + N_ji) / (N_i / A_i + N_j / A_j). `area`: #patches.
    std::vector<double> repairWeights(std::span<const float> area) const;

    /// Passes the counts to an archive, see StateCheckpoint.
    template <typename Archive>
    void keep(Archive& archive) {
        archive(lines_);
        archive(rows_);
    }

    bool operator==(const GlobalLineCounts&) const = default;

private:
    class Counters;

    template <typename Use>
    void visit(std::size_t row, Use&& use) const;
    void countBlock(std::span<SpanLog> logs, std::size_t block, Counters& counters);

    std::uint64_t lines_ = 0;
    /// N_ij for i < j, and with j = #patches and #patches + 1 what goes to backs and out: by j, as steps from one to the next and
    /// counts, 7 bits to a byte.
    std::vector<std::vector<std::uint8_t>> rows_;
};

} // namespace lambert
