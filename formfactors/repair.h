#pragma once

#include "formfactors/form_factor_matrix.h"

#include <cstddef>
#include <span>
#include <vector>

namespace lambert {

struct RepairOptions {
    double tolerance = 1e-6;   //!< of a row's sum; rows within it are closed
    int maxIterations = 2'000; //!< of the closure
};

/// What had to be changed; large numbers tell of poor factors.
struct RepairReport {
    double reciprocityError = 0.0; //!< before: RMS of A_i F_ij − A_j F_ji over pairs, relative to the RMS of their mean
    double closureError = 0.0;     //!< after the merge, before closure: largest |Σ_j F_ij − s_i|
    double largestCorrection = 0.0;  //!< of a factor by closure: max |d_i d_j − 1|
    double rowChange = 0.0;          //!< of a row by both: Σ_j |change of F_ij|, area-weighted mean
    double remainingError = 0.0;     //!< after: largest |Σ_j F_ij − s_i|
    int iterations = 0;              //!< of the closure
    std::vector<std::size_t> failed; //!< patches whose rows did not close
};

/// Makes a matrix reciprocal, A_i F_ij = A_j F_ji, and closed, Σ_j F_ij = s_i = 1 − F_i,back − F_i,out.
///
/// Merge: the exchange area of a pair is the mean of both estimates, the one of row i weighted by `weight[i]`: 1 / A_i where
/// each row is computed alike (the smaller patch's row is the better one), N_i / A_i where N_i lines are counted.
/// Closure: X_ij is multiplied by d_i d_j, d found by iterating d_i ← √(d_i A_i s_i / Σ_j X_ij d_j); see also R. L. van
/// Leersum, "A method for determining a consistent set of radiation view factors", Int. J. Heat Fluid Flow 10(1), 1989.
/// Keeps which pairs see each other. `area` and `weight` have #patches elements, above 0; a weight of 0 says that nothing is
/// known of a patch (no line has met it): its row, which must be empty, stays so and does not count as failed.
RepairReport repair(FormFactorMatrix& matrix, std::span<const float> area, std::span<const double> weight,
                    const RepairOptions& options = {});

} // namespace lambert
