#pragma once

#include "formfactors/form_factor_matrix.h"
#include "meshing/patch_optics.h"
#include "solver/solution.h"

#include <optional>
#include <span>
#include <vector>

namespace lambert {

/// What tells a matrix from a reference.
struct FormFactorErrors {
    double rms = 0.0;         //!< of F_ij − F_ij,ref over all pairs i ≠ j, those without exchange too
    double maximum = 0.0;     //!< largest |F_ij − F_ij,ref|
    double relativeRms = 0.0; //!< of F_ij / F_ij,ref − 1 over the pairs with F_ij,ref >= threshold; 0 if there are none
    double bias = 0.0;        //!< mean of the same, signed
    double misdirected = 0.0;         //!< share of all light (equal from every m²) that a row sends to the wrong place
    std::vector<float> misdirectedBy; //!< #patches: ½ (Σ_j |F_ij − F_ij,ref| + |Δ F_i,back| + |Δ F_i,out|), 0 to 1
};

/// `found` and `reference` have the same size, `area` an element per patch.
FormFactorErrors formFactorErrors(const FormFactorMatrix& found, const FormFactorMatrix& reference,
                                  std::span<const float> area, double threshold);

/// The part of the relative RMS error (see FormFactorErrors) that other random numbers would not change: with M the mean
/// square of single errors and m that of the errors' mean over the K matrices, √((K m − M) / (K − 1)), 0 where that is
/// negative. Nothing for a single matrix.
std::optional<double> systematicError(std::span<const FormFactorMatrix> found, const FormFactorMatrix& reference,
                                      double threshold);

/// Relative errors of the factors of one order of size.
struct FactorSizeError {
    double lower = 0.0, upper = 0.0; //!< lower <= F_ref < upper
    std::size_t pairs = 0;
    double relativeRms = 0.0; //!< over pairs and matrices
};

/// By half decades of F_ref from 10^-7 to 1, ascending, those with at least ten pairs.
std::vector<FactorSizeError> errorsBySize(std::span<const FormFactorMatrix> found, const FormFactorMatrix& reference);

/// √(Σ A |B − B_ref|² / Σ A |B_ref − B_e|²): relative to the reflected light, as no form factor changes what is emitted.
double radiosityError(const PatchMesh& mesh, const PatchOptics& optics, const std::vector<RgbSum>& found,
                      const std::vector<RgbSum>& reference);

} // namespace lambert
