#pragma once

#include "vpl/vpl_method.h"

#include <span>
#include <string>
#include <vector>

namespace lambert {

/// What one approximation owns of a method's error.
struct ErrorPart {
    Approximation approximation;
    double share = 0.0;      //!< of the expected squared error; of all parts with what is left: 1
    double shareError = 0.0; //!< standard error of the share; 0 for a method without chance
    double rms = 0.0;        //!< of the part alone, free of noise; in the fields' unit
    double bias = 0.0;       //!< its mean
    double biasError = 0.0;  //!< standard error of it
    double rmsWithout = 0.0; //!< RMS error that would be left if this part alone were taken away
};

/// How a method's error is put together. With F_0 the field that it computes with some random numbers, F_k that with its first k
/// approximations exchanged for exact ones, and R the reference:
///
///     F_0 − R = (F_0 − ⟨F_0⟩) + ⟨F_0 − F_1⟩ + … + ⟨F_(n−1) − F_n⟩ + ⟨F_n − R⟩
///                 sampling       part 1             part n           what is left
///
/// ⟨⟩ being the mean over random numbers. A part p has the share ⟨(F_0 − R, p)⟩ / ⟨|F_0 − R|²⟩, in the weighted inner product
/// over receivers and channels: shares add up to 1 whatever the parts are, one that is at right angles to the error
/// has none, one that cancels others has a negative one. All means are over pairs of different runs, so that noise that a part and
/// the error have in common is not taken for a share.
struct ErrorAnatomy {
    double rms = 0.0;      //!< √⟨|F_0 − R|²⟩
    double rmsError = 0.0; //!< standard error
    /// Sampling, the method's approximations, and what is left unexplained: the reference's error, and what no approximation names.
    std::vector<ErrorPart> parts;
};

/// The size of each part at each receiver, RMS over the channels, in the fields' unit: of sampling the deviation of one run, of all
/// others and of what is left the mean over the runs. #approximations + 2 fields; arguments as below.
std::vector<std::vector<float>> partSizes(std::span<const RgbSum> reference,
                                          std::span<const std::vector<std::vector<RgbSum>>> runs);

/// `weight` (#receivers, above 0), `reference` (#receivers), `runs` (#runs × #approximations + 1 × #receivers, of independent random
/// numbers each; at least 3, or 1 for a method without chance). Standard errors are by the jackknife over the runs; that of what is
/// left holds also what `ownError`, the RMS error of the reference, can contribute at most.
ErrorAnatomy errorAnatomy(std::span<const double> weight, std::span<const RgbSum> reference, double ownError,
                          std::span<const std::vector<std::vector<RgbSum>>> runs,
                          std::span<const Approximation> approximations, const Approximation& sampling);

} // namespace lambert
