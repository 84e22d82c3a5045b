#pragma once

#include "vpl/gather.h"

namespace lambert {

/// What a bound of the geometric term took away, found anew.
struct Recovered {
    std::vector<glm::dvec3> irradiance; //!< #receivers
    std::uint64_t rays = 0;             //!< from receivers
    std::uint64_t shadowRays = 0;
};

/// T. Kollig, A. Keller, "Illumination in the presence of weak singularities", Monte Carlo and Quasi-Monte Carlo Methods 2004:
/// the integral of the part of the geometric term above G_max, by rays from the receiver,
///
///     E(x) += ∫ max(0, 1 − G_max / G(x, y)) (L_e(y) + ρ(y) E(y) / π) cosθ dω .
///
/// G is above its bound only where y is near. E(y) is gathered in the same way, what the bound takes away there included: the
/// recursion ends by Russian roulette with the weights as probabilities. Unbiased, for lights that are.
Recovered recoverLight(const RayCaster& rays, std::span<const VirtualPointLight> lights,
                       std::span<const Receiver> receivers, double largestTerm, const GatherOptions& options,
                       Progress& progress);

} // namespace lambert
