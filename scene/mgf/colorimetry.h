#pragma once

#include "scene/scene.h"

#include <glm/vec3.hpp>

#include <span>

namespace lambert {

/// Tristimulus values X, Y, Z of the CIE 1931 standard observer (2°); Y is the luminance.
using Xyz = glm::dvec3;

/// White of the equal-energy illuminant E, with luminance 1.
inline constexpr Xyz kEqualEnergyWhite{1.0, 1.0, 1.0};

/// The colour with the chromaticity coordinates x and y and luminance 1. 0 <= x, 0 < y, x + y <= 1.
Xyz xyzOfChromaticity(double x, double y);

/// The colour of a spectrum whose values (at least 2) stand evenly from `shortest` to `longest` (nm); between them it is
/// linear, outside it is 0. Its luminance is in arbitrary units, and 0 if there is nothing between 380 and 780 nm.
Xyz xyzOfSpectrum(double shortest, double longest, std::span<const double> values);

/// The colour of a black body, luminance in arbitrary units. 100 <= kelvin <= 1e9.
Xyz xyzOfBlackBody(double kelvin);

/// A colour in linear RGB.
struct RgbColour {
    glm::dvec3 rgb{1.0};  //!< >= 0, its luminance 0.2126 R + 0.7152 G + 0.0722 B is 1
    bool clamped = false; //!< a component was negative (outside the gamut of Rec. 709) and set to 0
};

/// `colour` in linear RGB (Rec. 709) with luminance 1, seen by an eye adapted to the equal-energy white, which becomes
/// R = G = B (Bradford transform to D65). `colour` must be finite with a luminance above 0; its own luminance is lost.
RgbColour rgbOfUnitLuminance(const Xyz& colour);

} // namespace lambert
