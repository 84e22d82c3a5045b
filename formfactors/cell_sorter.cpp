#include "formfactors/cell_sorter.h"

namespace lambert {

std::span<const std::uint32_t> CellSorter::order(std::span<const float> points, std::size_t count,
                                                 std::uint32_t dimensions, int bits,
                                                 std::span<const std::uint32_t> kept) {
    const std::uint32_t sideBits = static_cast<std::uint32_t>(bits);
    spread_.assign(std::size_t{1} << sideBits, 0); // a coordinate's bits, `dimensions` apart
    for (std::uint32_t k = 0; k < spread_.size(); ++k)
        for (std::uint32_t bit = 0; bit < sideBits; ++bit) spread_[k] |= (k >> bit & 1U) << (bit * dimensions);

    const auto side = static_cast<float>(1U << sideBits);
    next_.assign((std::size_t{1} << (sideBits * dimensions)) + 1, 0);
    cell_.resize(kept.size());
    for (std::size_t k = 0; k < kept.size(); ++k) {
        std::uint32_t cell = 0;
        for (std::uint32_t d = 0; d < dimensions; ++d)
            cell |= spread_[static_cast<std::uint32_t>(static_cast<int>(side * points[kept[k] + d * count]))] << d;
        cell_[k] = cell;
        ++next_[cell + 1];
    }
    for (std::size_t c = 1; c < next_.size(); ++c) next_[c] += next_[c - 1];
    order_.resize(kept.size());
    for (std::size_t k = 0; k < kept.size(); ++k) order_[next_[cell_[k]]++] = kept[k];
    return order_;
}

} // namespace lambert
