#pragma once

#include "scene/scene.h"

#include <span>
#include <string>
#include <vector>

namespace lambert {

/// The colour map viridis by S. van der Walt, N. Smith and E. Firing (matplotlib, CC0): lightness rises evenly, for the
/// colour-blind and in grey as well. `t` in [0, 1] (clamped); encoded sRGB.
Rgb viridis(float t);

/// An encoded sRGB colour as the linear one that pictures hold.
Rgb linearDisplay(const Rgb& srgb);

/// Values to colours on a logarithmic scale of whole decades.
class ColourScale {
public:
    /// From the decade above the largest value, `mostDecades` (>= 1) down at the most, to the decade below the smallest one
    /// that is above 0; values of which none is positive and finite give one decade below 1.
    ColourScale(std::span<const float> values, int mostDecades);

    int lowest() const { return lowest_; }   //!< as a power of ten
    int highest() const { return highest_; } //!< the same
    float position(float value) const;       //!< in [0, 1]; 0 also for 0 and what is not finite
    Rgb colour(float value) const { return viridis(position(value)); } //!< encoded sRGB

private:
    int lowest_, highest_;
};

} // namespace lambert
