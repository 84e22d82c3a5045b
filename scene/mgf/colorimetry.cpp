// Rec. 709: ITU-R BT.709-6, primaries, white D65 and luminance weights (item 3.2).
// Bradford transform: K. M. Lam, "Metamerism and colour constancy" (1985), with the matrix of CIE 159:2004.
// Black body: Planck's law with c2 = 0.014388 m K.

#include "scene/mgf/colorimetry.h"

#include "scene/mgf/cie_observer.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <cmath>

namespace lambert {

namespace {

constexpr glm::dvec3 kLuminance{0.2126, 0.7152, 0.0722};

/// Of the observer, linear between the table's wavelengths.
Xyz observerAt(double nanometres) {
    const double at = (nanometres - kObserverBegin) / kObserverStep;
    if (at < 0.0 || at > static_cast<double>(kObserver.size() - 1)) return Xyz(0.0);
    const std::size_t k = std::min(static_cast<std::size_t>(at), kObserver.size() - 2);
    return glm::mix(kObserver[k], kObserver[k + 1], at - static_cast<double>(k));
}

/// Σ of observer times spectrum in steps of 1 nm, fine enough for measured spectra.
template <typename Spectrum>
Xyz integrate(Spectrum&& spectrum) {
    Xyz sum(0.0);
    const double end = kObserverBegin + kObserverStep * static_cast<double>(kObserver.size() - 1);
    for (double wavelength = kObserverBegin; wavelength <= end; wavelength += 1.0)
        sum += observerAt(wavelength) * spectrum(wavelength);
    return sum;
}

/// The columns are the primaries' colours; they add up to the white.
glm::dmat3 rec709ToXyz(const Xyz& white) {
    const glm::dmat3 primaries(xyzOfChromaticity(0.64, 0.33), xyzOfChromaticity(0.30, 0.60),
                               xyzOfChromaticity(0.15, 0.06));
    const glm::dvec3 shares = glm::inverse(primaries) * white;
    return {primaries[0] * shares[0], primaries[1] * shares[1], primaries[2] * shares[2]};
}

glm::dmat3 adaptation(const Xyz& from, const Xyz& to) {
    const glm::dmat3 cones =
        glm::transpose(glm::dmat3({0.8951, 0.2664, -0.1614}, {-0.7502, 1.7135, 0.0367}, {0.0389, -0.0685, 1.0296}));
    const glm::dvec3 gain = (cones * to) / (cones * from);
    const glm::dmat3 scale(glm::dvec3(gain.x, 0, 0), glm::dvec3(0, gain.y, 0), glm::dvec3(0, 0, gain.z));
    return glm::inverse(cones) * scale * cones;
}

} // namespace

Xyz xyzOfChromaticity(double x, double y) { return {x / y, 1.0, (1.0 - x - y) / y}; }

Xyz xyzOfSpectrum(double shortest, double longest, std::span<const double> values) {
    const double step = (longest - shortest) / static_cast<double>(values.size() - 1);
    return integrate([&](double wavelength) {
        if (wavelength < shortest || wavelength > longest) return 0.0;
        const double at = (wavelength - shortest) / step;
        const std::size_t k = std::min(static_cast<std::size_t>(at), values.size() - 2);
        return glm::mix(values[k], values[k + 1], at - static_cast<double>(k));
    });
}

Xyz xyzOfBlackBody(double kelvin) {
    return integrate([&](double wavelength) {
        const double metres = wavelength * 1e-9;
        return std::pow(wavelength, -5.0) / std::expm1(0.014388 / (metres * kelvin));
    });
}

RgbColour rgbOfUnitLuminance(const Xyz& colour) {
    static const glm::dmat3 kToRgb = [] {
        const Xyz d65 = xyzOfChromaticity(0.3127, 0.3290);
        return glm::inverse(rec709ToXyz(d65)) * adaptation(kEqualEnergyWhite, d65);
    }();
    constexpr double kRounding = 1e-9; // of the matrices: a primary's own zero may come out negative
    RgbColour result{kToRgb * (colour / colour.y)};
    const double largest = std::max({result.rgb.x, result.rgb.y, result.rgb.z});
    result.clamped = std::min({result.rgb.x, result.rgb.y, result.rgb.z}) < -kRounding * largest;
    result.rgb = glm::max(result.rgb, 0.0);
    result.rgb /= glm::dot(kLuminance, result.rgb);
    return result;
}

} // namespace lambert
