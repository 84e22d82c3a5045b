#pragma once

#include "formfactors/form_factor_matrix.h"

#include <cstddef>
#include <span>
#include <vector>

namespace lambert {

/// A patch that sees more backs than this is covered: it lies inside something, or something stands on it. (Not all backs:
/// where solids touch, a ray may slip from the inside of one into the other.)
inline constexpr double kCovered = 0.8;

/// How well a matrix keeps what every exact one keeps.
struct MatrixQuality {
    std::size_t entries = 0, bytes = 0;
    double closureRms = 0.0;   //!< of Σ_j F_ij + F_i,back + F_i,out − 1 over the rows
    double closureWorst = 0.0; //!< the largest of these, as an absolute value
    std::size_t worstRow = 0;
    double back = 0.0, out = 0.0; //!< area-weighted means of F_i,back and F_i,out
    double coveredArea = 0.0;     //!< m², of patches with F_i,back above kCovered
    double openBack = 0.0;        //!< area-weighted mean of F_i,back over all other patches

    double meanError = 0.0, largestError = 0.0; //!< of the rows, Σ_j |ΔF_ij| as the method knows it; 0: unknown

    std::size_t comparedRows = 0;  //!< for reciprocity: all, or of large matrices some spread over the rows
    double reciprocityRms = 0.0;   //!< of A_i F_ij − A_j F_ji over their pairs, relative to the RMS of the means
    double reciprocityWorst = 0.0; //!< the largest |A_i F_ij − A_j F_ji|, relative to the smaller of both areas
};

/// `area`: #patches, m².
MatrixQuality assessMatrix(const FormFactorMatrix& matrix, std::span<const float> area);

/// A_j (1 − F_j,back − F_j,out) − Σ_i A_i F_ij, m²: what all others miss of the light of each patch j, per B_j; below 0 where they
/// see it too large. #patches, 0 of exact factors. `area`: #patches, m². On one thread.
std::vector<double> columnDeficit(const FormFactorMatrix& matrix, std::span<const float> area);

/// What each patch receives if every surface sends 1 per m², less 1. Rows that count lines close by construction and prove
/// nothing; their columns do.
struct ColumnClosure {
    std::vector<float> error; //!< #patches, |Σ_i A_i F_ij / A_j + F_j,back + F_j,out − 1|
    double rms = 0.0;         //!< over the patches
};

/// `area`: #patches, m², above 0. On one thread.
ColumnClosure columnClosure(const FormFactorMatrix& matrix, std::span<const float> area);

} // namespace lambert
