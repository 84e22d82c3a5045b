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
    /// Σ_J F_IJ + F_I,back + F_I,out; 1 of exact factors, 0 of a group without area.
    double rowSum(std::size_t from) const;
    /// |A_I F_IJ − A_J F_JI| over their mean, 0 to 2; 0 of exact factors, and where neither sees the other.
    double reciprocityError(std::size_t a, std::size_t b) const;
    /// Per area of a group; 0 for one without.
    double mean(double sum, std::size_t of) const { return area[of] > 0.0 ? sum / area[of] : 0.0; }
};

/// How far A_I F_IJ and A_J F_JI of groups are apart.
struct GroupReciprocity {
    double rms = 0.0;            //!< of the differences over all pairs, relative to the RMS of the means
    std::vector<double> largest; //!< #groups: the largest reciprocityError of a group's pairs
    std::size_t a = 0, b = 0;    //!< the pair with the largest of all
};
GroupReciprocity groupReciprocity(const GroupFactors& factors);

/// Sums the factors of patches over groups. `area` (m²) and `group` (0 to `groups` − 1, or kNoGroup): #patches. Always in the same order.
GroupFactors groupFactors(const FormFactorMatrix& matrix, std::span<const float> area,
                          std::span<const std::uint32_t> group, std::size_t groups);

} // namespace lambert
