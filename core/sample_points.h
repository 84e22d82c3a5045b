#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

namespace lambert {

/// How the points are spread over the unit cube.
enum class Sampler {
    Random,     ///< independent
    Stratified, ///< successive pairs of dimensions in jittered grids of their own
    Halton,     ///< scrambled Halton sequence
    Sobol       ///< Owen-scrambled Sobol sequence
};

/// random, stratified, halton or sobol; nothing for any other name.
std::optional<Sampler> samplerByName(std::string_view name);
std::string_view nameOf(Sampler sampler);

/// A set of points in the unit cube [0, 1)^dimensions. Every single point is uniform, whatever the sampler: sums over the
/// set are unbiased. Sets of different seeds are independent. Coordinates are computed when asked for, in any order.
class SamplePoints {
public:
    /// At most kSobolDimensions dimensions, `count` >= 1 (of Halton and Sobol points only the first are used, so a
    /// longer set continues a shorter one).
    SamplePoints(Sampler sampler, std::uint32_t count, std::uint32_t dimensions, std::uint64_t seed);

    std::uint32_t count() const { return count_; }
    std::uint32_t dimensions() const { return static_cast<std::uint32_t>(keys_.size()); }
    /// Coordinate `dimension` of point `index`, in [0, 1).
    double at(std::uint32_t index, std::uint32_t dimension) const;
    /// The same of the points from `first` on, one per element of `coordinates`, cut off after 24 bits. Much faster than one
    /// by one for random and Sobol points.
    void fill(std::uint32_t first, std::uint32_t dimension, std::span<float> coordinates) const;

private:
    double stratified(std::uint32_t index, std::uint32_t dimension) const;

    Sampler sampler_;
    std::uint32_t count_;
    std::uint64_t seed_;
    std::vector<std::uint64_t> keys_; ///< #dimensions
};

} // namespace lambert
