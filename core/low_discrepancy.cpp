#include "core/low_discrepancy.h"

#include "core/random.h"
#include "core/vector_clones.h"

#include <boost/math/special_functions/prime.hpp>

#include <algorithm>
#include <array>
#include <bit>
#include <cassert>

namespace lambert {

namespace {

/// Primitive polynomials and initial direction numbers of dimensions 1 to 15: Joe, Kuo 2008, "new-joe-kuo-6".
struct Direction {
    std::uint32_t degree, coefficients;
    std::array<std::uint32_t, 6> initial;
};
constexpr std::array<Direction, kSobolDimensions - 1> kDirections{{{1, 0, {1}},
                                                                   {2, 1, {1, 3}},
                                                                   {3, 1, {1, 3, 1}},
                                                                   {3, 2, {1, 1, 1}},
                                                                   {4, 1, {1, 1, 3, 3}},
                                                                   {4, 4, {1, 3, 5, 13}},
                                                                   {5, 2, {1, 1, 5, 5, 17}},
                                                                   {5, 4, {1, 1, 5, 5, 5}},
                                                                   {5, 7, {1, 1, 7, 11, 19}},
                                                                   {5, 11, {1, 1, 5, 1, 1}},
                                                                   {5, 13, {1, 1, 1, 3, 11}},
                                                                   {5, 14, {1, 3, 5, 5, 31}},
                                                                   {6, 1, {1, 3, 3, 9, 7, 49}},
                                                                   {6, 13, {1, 1, 1, 15, 21, 21}},
                                                                   {6, 16, {1, 3, 1, 13, 27, 49}}}};

using Matrix = std::array<std::uint32_t, 32>; ///< column k belongs to bit k of the index

std::array<Matrix, kSobolDimensions> sobolMatrices() {
    std::array<Matrix, kSobolDimensions> matrices{};
    for (std::uint32_t k = 0; k < 32; ++k) matrices[0][k] = 0x80000000U >> k;
    for (std::uint32_t d = 1; d < kSobolDimensions; ++d) {
        const Direction& direction = kDirections[d - 1];
        const std::uint32_t degree = direction.degree;
        Matrix& v = matrices[d];
        for (std::uint32_t k = 0; k < 32; ++k) {
            if (k < degree) {
                v[k] = direction.initial[k] << (31 - k);
                continue;
            }
            v[k] = v[k - degree] ^ (v[k - degree] >> degree);
            for (std::uint32_t j = 1; j < degree; ++j)
                if ((direction.coefficients >> (degree - 1 - j)) & 1U) v[k] ^= v[k - j];
        }
    }
    return matrices;
}

/// All bits of the result depend on all bits of `x`: the finaliser of SplitMix64 (Steele, Lea, Flood 2014).
std::uint64_t mixed(std::uint64_t x) {
    x += 0x9E3779B97F4A7C15U;
    x = (x ^ (x >> 30)) * 0xBF58476D1CE4E5B9U;
    x = (x ^ (x >> 27)) * 0x94D049BB133111EBU;
    return x ^ (x >> 31);
}

/// Random bits to 0 ... count − 1.
std::uint64_t scaled(std::uint32_t bits, std::uint32_t count) { return (std::uint64_t{bits} * count) >> 32; }

} // namespace

double radicalInverse(std::uint32_t base, std::uint64_t index) {
    // As an integer while it fits: the division at the end rounds once.
    std::uint64_t mirrored = 0;
    std::uint64_t scale = 1;
    for (; index > 0; index /= base) {
        if (scale > (std::uint64_t{1} << 53) / base) break; // later digits are below the last bit
        mirrored = mirrored * base + index % base;
        scale *= base;
    }
    return static_cast<double>(mirrored) / static_cast<double>(scale);
}

double halton(std::uint64_t index, std::uint32_t dimension) {
    return radicalInverse(boost::math::prime(dimension), index);
}

double scrambledHalton(std::uint64_t index, std::uint32_t dimension, std::uint64_t seed) {
    const std::uint32_t base = boost::math::prime(dimension);
    const std::uint64_t key = mixed(seed + dimension);
    std::uint64_t mirrored = 0;
    std::uint64_t scale = 1;
    std::uint64_t prefix = 1;
    // All digits of 32 bits, also the zeros that stand before the index: they are permuted too.
    for (; scale < (std::uint64_t{1} << 32); index /= base) {
        // An affine permutation of the digits takes any two of them to any other two with equal odds, as a uniform one
        // does, and variances depend on no more.
        const std::uint64_t hash = mixed(key ^ prefix);
        const std::uint64_t factor = 1 + scaled(static_cast<std::uint32_t>(hash), base - 1);
        const std::uint64_t shift = scaled(static_cast<std::uint32_t>(hash >> 32), base);
        const std::uint64_t digit = index % base;
        prefix = prefix * base + digit;
        mirrored = mirrored * base + (factor * digit + shift) % base;
        scale *= base;
    }
    return (static_cast<double>(mirrored) + 0.5) / static_cast<double>(scale);
}

std::uint32_t sobol(std::uint32_t index, std::uint32_t dimension) {
    static const auto matrices = sobolMatrices();
    assert(dimension < kSobolDimensions);
    std::uint32_t bits = 0;
    for (; index != 0; index &= index - 1)
        bits ^= matrices[dimension][static_cast<std::size_t>(std::countr_zero(index))];
    return bits;
}

std::array<std::uint32_t, 4> sobol4(std::uint32_t index) {
    using Point = std::array<std::uint32_t, 4>;
    static const auto byBytes = [] { // the sequence is linear in the index's bits
        std::array<std::array<Point, 256>, 4> table{};
        for (std::uint32_t place = 0; place < 4; ++place)
            for (std::uint32_t byte = 0; byte < 256; ++byte)
                for (std::uint32_t d = 0; d < 4; ++d) table[place][byte][d] = sobol(byte << (8 * place), d);
        return table;
    }();
    Point point = byBytes[0][index & 0xFF];
    for (std::size_t place = 1; (index >>= 8) != 0; ++place)
        for (std::size_t d = 0; d < 4; ++d) point[d] ^= byBytes[place][index & 0xFF][d];
    return point;
}

namespace {

/// Up to 256 points whose indices differ in the lowest eight bits only, `low` of which are those bits' part.
LAMBERT_VECTOR_CLONES
void scrambledRun(std::uint32_t high, const std::uint32_t* low, std::uint32_t seed, std::span<float> coordinates) {
    const std::size_t count = coordinates.size();
    float* coordinate = coordinates.data();
    for (std::size_t k = 0; k < count; ++k) coordinate[k] = uniformFloat(owenScrambled(high ^ low[k], seed));
}

} // namespace

double scrambledSobol(std::uint32_t index, std::uint32_t dimension, std::uint32_t seed) {
    return (static_cast<double>(owenScrambled(sobol(index, dimension), seed)) + 0.5) * 0x1p-32;
}

void scrambledSobol(std::uint32_t first, std::uint32_t dimension, std::uint32_t seed, std::span<float> coordinates) {
    constexpr std::uint32_t kRun = 256;
    std::array<std::uint32_t, kRun> low{};
    for (std::uint32_t bit = 0; bit < 8; ++bit) { // the sequence is linear in the index's bits
        const std::uint32_t column = sobol(1U << bit, dimension);
        for (std::uint32_t k = 0; k < 1U << bit; ++k) low[(1U << bit) + k] = low[k] ^ column;
    }
    for (std::size_t done = 0; done < coordinates.size();) {
        const std::uint32_t index = first + static_cast<std::uint32_t>(done);
        const std::uint32_t place = index % kRun;
        const std::size_t count = std::min<std::size_t>(kRun - place, coordinates.size() - done);
        scrambledRun(sobol(index - place, dimension), low.data() + place, seed, coordinates.subspan(done, count));
        done += count;
    }
}

std::uint32_t permuted(std::uint32_t index, std::uint32_t count, std::uint64_t seed) {
    assert(index < count);
    // A Feistel network permutes the next power of four; what falls outside walks on along its cycle.
    const int half = (std::bit_width(count - 1) + 1) / 2;
    if (half == 0) return 0;
    const std::uint32_t mask = (1U << half) - 1U;
    std::uint32_t value = index;
    do {
        std::uint32_t left = value >> half;
        std::uint32_t right = value & mask;
        const auto key = philox({0, 0, 0, 0x46454953}, seed);
        for (int round = 0; round < 4; ++round) {
            std::uint32_t hash = (right ^ key[static_cast<std::size_t>(round)]) * 0x9E3779B1U;
            hash = (hash ^ (hash >> 15)) * 0x85EBCA6BU;
            hash ^= hash >> 13;
            left ^= hash & mask;
            std::swap(left, right);
        }
        value = (left << half) | right;
    } while (value >= count);
    return value;
}

} // namespace lambert
