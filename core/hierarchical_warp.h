#pragma once

#include <glm/vec2.hpp>

#include <span>
#include <vector>

namespace lambert {

/// Warps points of the unit square so that their density is proportional to an image of importance: uniform points stay as
/// even as they were, and points close to each other stay close. Of the image it keeps the sums over 2 × 2, 4 × 4, ... texels;
/// from the coarsest on, every square's points are divided among its quadrants, first by rows, then by columns.
/// P. Clarberg, W. Jarosz, T. Akenine-Möller, H. W. Jensen, "Wavelet importance sampling", SIGGRAPH 2005, section 4.
class HierarchicalWarp {
public:
    /// `importance`: #width × height, row by row, >= 0 and finite, not all 0. Throws std::invalid_argument otherwise, and for
    /// an empty image.
    HierarchicalWarp(int width, int height, std::span<const float> importance);

    /// `u` in [0, 1)² to a point of [0, width) × [0, height) in texels: texel (x, y) gets its share of the points, evenly
    /// spread over it. No point lies on a texel without importance.
    glm::dvec2 warp(const glm::dvec2& u) const;

    /// The sum of all importance.
    double total() const { return levels_.back().front(); }
    /// The probability that a uniform point comes to lie on a texel; 0 <= x < width, 0 <= y < height.
    double probability(int x, int y) const;

private:
    using Level = std::vector<double>; ///< sums, row by row over a power of two squared

    std::vector<Level> levels_; ///< from the texels to one number
};

} // namespace lambert
