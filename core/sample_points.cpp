#include "core/sample_points.h"

#include "core/low_discrepancy.h"
#include "core/named.h"
#include "core/random.h"
#include "core/vector_clones.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <utility>

namespace lambert {

namespace {

constexpr double kBelowOne = 1.0 - 0x1p-53;
constexpr std::uint32_t kStream = 0x53414D50;

/// 53 random bits of a point's coordinate.
double randomNumber(std::uint32_t index, std::uint32_t dimension, std::uint64_t seed) {
    return static_cast<double>(randomKey({index, dimension, 0, kStream}, seed) >> 11) * 0x1p-53;
}

LAMBERT_VECTOR_CLONES
void randomNumbers(std::uint32_t first, std::uint32_t dimension, std::uint64_t seed, std::span<float> numbers) {
    const std::size_t count = numbers.size();
    float* number = numbers.data();
    for (std::size_t k = 0; k < count; ++k)
        number[k] = uniformFloat(philox({first + static_cast<std::uint32_t>(k), dimension, 0, kStream}, seed)[0]);
}

std::uint32_t roundedUpRoot(std::uint32_t n) {
    auto root = static_cast<std::uint32_t>(std::sqrt(static_cast<double>(n)));
    while (std::uint64_t{root} * root < n) ++root;
    return root;
}

constexpr std::array kNames{Named{Sampler::Random, "random"}, Named{Sampler::Stratified, "stratified"},
                            Named{Sampler::Halton, "halton"}, Named{Sampler::Sobol, "sobol"}};

} // namespace

std::optional<Sampler> samplerByName(std::string_view name) { return valueNamed(kNames, name); }
std::string_view nameOf(Sampler sampler) { return rowOf(kNames, sampler).name; }

SamplePoints::SamplePoints(Sampler sampler, std::uint32_t count, std::uint32_t dimensions, std::uint64_t seed)
    : sampler_(sampler), count_(count), seed_(seed) {
    assert(count >= 1 && dimensions <= kSobolDimensions);
    for (std::uint32_t d = 0; d < dimensions; ++d) {
        keys_.push_back(randomKey({d, 0, 0, 0x4B455953}, seed));
    }
}

double SamplePoints::at(std::uint32_t index, std::uint32_t dimension) const {
    assert(index < count_ && dimension < dimensions());
    switch (sampler_) {
    case Sampler::Random:
        return randomNumber(index, dimension, seed_);
    case Sampler::Stratified:
        return std::min(stratified(index, dimension), kBelowOne);
    case Sampler::Halton:
        return scrambledHalton(index, dimension, seed_);
    case Sampler::Sobol:
        break;
    }
    return scrambledSobol(index, dimension, static_cast<std::uint32_t>(keys_[dimension]));
}

void SamplePoints::fill(std::uint32_t first, std::uint32_t dimension, std::span<float> coordinates) const {
    assert(dimension < dimensions() && coordinates.size() <= count_ - first);
    if (sampler_ == Sampler::Sobol) {
        scrambledSobol(first, dimension, static_cast<std::uint32_t>(keys_[dimension]), coordinates);
        return;
    }
    if (sampler_ == Sampler::Random) {
        randomNumbers(first, dimension, seed_, coordinates);
        return;
    }
    for (std::size_t k = 0; k < coordinates.size(); ++k) {
        const double coordinate = at(first + static_cast<std::uint32_t>(k), dimension);
        coordinates[k] = static_cast<float>(std::floor(coordinate * 0x1p24) * 0x1p-24);
    }
}

/// Dimensions 2k and 2k + 1 share a grid of at least `count` cells, of which each point has one of its own; which one is
/// shuffled per pair. A last dimension without partner has `count` intervals.
double SamplePoints::stratified(std::uint32_t index, std::uint32_t dimension) const {
    const double jitter = randomNumber(index, dimension, seed_);
    if (dimension % 2 == 0 && dimension + 1 == dimensions())
        return (permuted(index, count_, keys_[dimension]) + jitter) / count_;
    const std::uint32_t columns = roundedUpRoot(count_);
    const std::uint32_t rows = (count_ + columns - 1) / columns;
    const std::uint32_t cell = permuted(index, columns * rows, keys_[dimension - dimension % 2]);
    return dimension % 2 == 0 ? (cell % columns + jitter) / columns : (cell / columns + jitter) / rows;
}

} // namespace lambert
