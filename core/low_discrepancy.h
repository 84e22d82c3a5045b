#pragma once

#include <array>
#include <cstdint>
#include <span>

namespace lambert {

/// Low-discrepancy sequences. "Index" counts from 0; index 0 of all of them is the origin, so quasi-random walks that
/// must not start there count from 1.

/// Φ_b(index): the index's digits in base b >= 2, mirrored at the point. In [0, 1).
double radicalInverse(std::uint32_t base, std::uint64_t index);

/// Coordinate `dimension` < kPrimes of the Halton sequence: the radical inverse in the dimension's prime.
inline constexpr std::uint32_t kPrimes = 256;
double halton(std::uint64_t index, std::uint32_t dimension);

/// The same with the digits permuted at random, each permutation chosen by the digits before it (after Owen 1995): any point
/// becomes uniform in [0, 1), the set keeps its discrepancy. Equal seeds give equal points.
double scrambledHalton(std::uint64_t index, std::uint32_t dimension, std::uint64_t seed);

/// Coordinate `dimension` < kSobolDimensions of the Sobol sequence, as 32 bits after the point. Any 2^m successive points
/// that begin at a multiple of 2^m are stratified in every dimension, and in dimensions 0 and 1 together.
/// S. Joe, F. Y. Kuo, "Constructing Sobol sequences with better two-dimensional projections", SIAM J. Sci. Comput. 2008.
inline constexpr std::uint32_t kSobolDimensions = 16;
std::uint32_t sobol(std::uint32_t index, std::uint32_t dimension);
/// Dimensions 0 to 3 at once, faster.
std::array<std::uint32_t, 4> sobol4(std::uint32_t index);

inline std::uint32_t reversedBits(std::uint32_t x) {
    x = (x >> 16) | (x << 16);
    x = ((x & 0xFF00FF00U) >> 8) | ((x & 0x00FF00FFU) << 8);
    x = ((x & 0xF0F0F0F0U) >> 4) | ((x & 0x0F0F0F0FU) << 4);
    x = ((x & 0xCCCCCCCCU) >> 2) | ((x & 0x33333333U) << 2);
    return ((x & 0xAAAAAAAAU) >> 1) | ((x & 0x55555555U) << 1);
}

/// Nested uniform scrambling in base 2 (Owen 1995) of 32 bits after the point, by hashing.
/// B. Burley, "Practical hash-based Owen scrambling", JCGT 9(4), 2020.
inline std::uint32_t owenScrambled(std::uint32_t bits, std::uint32_t seed) {
    // Laine, Karras 2011: a hash in which a bit is changed only by lower ones; constants: Burley 2020's successors.
    std::uint32_t x = reversedBits(bits);
    x ^= x * 0x3D20ADEAU;
    x += seed;
    x *= (seed >> 16) | 1U;
    x ^= x * 0x05526C56U;
    x ^= x * 0x53A22864U;
    return reversedBits(x);
}

/// Coordinate `dimension` of the scrambled Sobol sequence, in (0, 1).
double scrambledSobol(std::uint32_t index, std::uint32_t dimension, std::uint32_t seed);
/// The same of the points from `first` on, one per element of `coordinates`, cut off after 24 bits.
void scrambledSobol(std::uint32_t first, std::uint32_t dimension, std::uint32_t seed, std::span<float> coordinates);

/// The place of `index` in a random permutation of 0 ... count − 1 that the seed chooses; index < count.
std::uint32_t permuted(std::uint32_t index, std::uint32_t count, std::uint64_t seed);

} // namespace lambert
