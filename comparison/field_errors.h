#pragma once

#include <span>

namespace lambert {

/// How far a field is from another one, in its unit unless said otherwise. Means are weighted.
struct FieldErrors {
    double mean = 0.0;         //!< of the reference
    double bias = 0.0;         //!< mean of the difference, field − reference
    double meanAbsolute = 0.0; //!< of |difference|
    double rms = 0.0;          //!< sqrt of the mean of difference²
    double relativeRms = 0.0;  //!< rms / mean; 0 if both are 0
    double percentile99 = 0.0; //!< 99 % of the weight has at most this |difference|
    double maximum = 0.0;      //!< of |difference|
    double energyRatio = 1.0;  //!< Σ weight · field / Σ weight · reference; 1 if both are 0
};

/// `weight` (>= 0, of which one is above 0), `reference` and `field` have the same length, which is not 0. Throws UsageError
/// if they have not.
FieldErrors fieldErrors(std::span<const double> weight, std::span<const double> reference,
                        std::span<const double> field);

} // namespace lambert
