#pragma once

#include "formfactors/form_factor_matrix.h"

#include <cstdint>
#include <span>
#include <vector>

namespace lambert {

/// The group of patches that belong to none; light that reaches them counts as what meets backs.
inline constexpr std::uint32_t kNoGroup = 0xFFFFFFFF;

/// Form factors between groups of patches.
struct GroupFactors {
    std::size_t groups = 0;
    std::vector<double> area;     //!< #groups, m²
    std::vector<double> exchange; //!< #groups², row by row: Σ_{i in I} Σ_{j in J} A_i F_ij, m²
    std::vector<double> back;     //!< #groups, Σ A_i F_i,back, and to patches without group, m²
    std::vector<double> out;      //!< #groups, Σ A_i F_i,out, m²

    /// A_I F_IJ, m².
    double exchangeArea(std::size_t from, std::size_t to) const { return exchange[from * groups + to]; }
    /// F_IJ: what part of the light that leaves I, the same everywhere on it, reaches J.
    double factor(std::size_t from, std::size_t to) const { return mean(exchangeArea(from, to), from); }
    double backFactor(std::size_t from) const { return mean(back[from], from); }
    double outFactor(std::size_t from) const { return mean(out[from], from); }
    /// Per area of a group; 0 for one without.
    double mean(double sum, std::size_t of) const { return area[of] > 0.0 ? sum / area[of] : 0.0; }
};

/// Sums the factors of patches over groups. `area` (m²) and `group` (0 to `groups` − 1, or kNoGroup): #patches. Always in the same order.
GroupFactors groupFactors(const FormFactorMatrix& matrix, std::span<const float> area,
                          std::span<const std::uint32_t> group, std::size_t groups);

} // namespace lambert
