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

/// The steps of scales and axes: 1, 2, 5, 10, 20, … for n = 0, 1, 2, 3, 4, …, and below 1 for n < 0.
double roundStep(int n);
/// The largest n with roundStep(n) <= value, which is positive and finite.
int stepBelow(double value);

/// Values to colours on a logarithmic scale between two round numbers.
class ColourScale {
public:
    /// From the round number above the largest value down by at most `mostDecades` (>= 1); the lowest twentieth of the values may
    /// share the last colour. Values of which none is positive and finite give 0.1 to 1.
    ColourScale(std::span<const float> values, int mostDecades);

    double lowest() const { return roundStep(lowest_); }
    double highest() const { return roundStep(highest_); }
    /// Round numbers for a bar: its ends, and between them all of a short one or the decades of a long one.
    std::vector<double> ticks() const;
    float position(double value) const; //!< in [0, 1]; 0 also for 0 and what is not finite
    Rgb colour(double value) const { return viridis(position(value)); } //!< encoded sRGB

private:
    int lowest_, highest_; ///< steps
};

} // namespace lambert
