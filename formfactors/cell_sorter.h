#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace lambert {

/// Sorts points of the unit cube so that neighbours follow each other: by cells, first come first within a cell, and these
/// by the bits of their coordinates in turn. G. M. Morton, "A computer oriented geodetic data base", IBM 1966.
/// One per thread, reused: it keeps its memory.
class CellSorter {
public:
    /// Indices from `kept` in the order of their cells, 2^bits along each of the first `dimensions`. `points`: coordinates in
    /// [0, 1), dimension by dimension of `count` each. dimensions · bits <= 24. Valid until the next call.
    std::span<const std::uint32_t> order(std::span<const float> points, std::size_t count, std::uint32_t dimensions,
                                         int bits, std::span<const std::uint32_t> kept);

private:
    std::vector<std::uint32_t> cell_, next_, order_, spread_;
};

} // namespace lambert
