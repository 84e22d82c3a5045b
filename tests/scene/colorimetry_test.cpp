#include "scene/mgf/colorimetry.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

namespace lambert {
namespace {

double luminance(const glm::dvec3& rgb) { return glm::dot(rgb, glm::dvec3(0.2126, 0.7152, 0.0722)); }

glm::dvec2 chromaticityOf(const Xyz& xyz) { return glm::dvec2(xyz) / (xyz.x + xyz.y + xyz.z); }

double largestDifference(const glm::dvec3& a, const glm::dvec3& b) {
    const glm::dvec3 d = glm::abs(a - b);
    return std::max({d.x, d.y, d.z});
}

TEST(Colorimetry, EqualEnergyIsWhite) {
    constexpr double kRounding = 1e-12;
    EXPECT_LT(largestDifference(rgbOfUnitLuminance(kEqualEnergyWhite).rgb, glm::dvec3(1.0)), kRounding);
    EXPECT_LT(largestDifference(rgbOfUnitLuminance(xyzOfChromaticity(1.0 / 3, 1.0 / 3)).rgb, glm::dvec3(1.0)),
              kRounding);
    // Four digits, as files have them, leave 1e-4 in x and y.
    EXPECT_LT(largestDifference(rgbOfUnitLuminance(xyzOfChromaticity(0.3333, 0.3333)).rgb, glm::dvec3(1.0)), 1e-3);
}

TEST(Colorimetry, AFlatSpectrumIsEqualEnergy) {
    const glm::dvec2 xy = chromaticityOf(xyzOfSpectrum(380, 780, std::vector(5, 0.7)));
    EXPECT_NEAR(xy.x, 1.0 / 3, 2e-5); // the observer's three functions have the same sum to five digits
    EXPECT_NEAR(xy.y, 1.0 / 3, 2e-5);
}

TEST(Colorimetry, BlackBodiesHaveTheirChromaticities) {
    // The Planckian locus to four digits; 2856 K is the CIE's illuminant A.
    const std::vector<std::pair<double, glm::dvec2>> locus = {
        {2000.0, {0.5267, 0.4133}}, {2856.0, {0.4475, 0.4074}}, {4000.0, {0.3805, 0.3768}}, {6500.0, {0.3135, 0.3237}}};
    for (const auto& [kelvin, expected] : locus) {
        const glm::dvec2 xy = chromaticityOf(xyzOfBlackBody(kelvin));
        EXPECT_NEAR(xy.x, expected.x, 3e-4) << kelvin; // older tables have another value of the constant c2
        EXPECT_NEAR(xy.y, expected.y, 3e-4) << kelvin;
    }
}

TEST(Colorimetry, BlackBodiesTurnFromRedToBlue) {
    double last = 1e300;
    for (const double kelvin : {500.0, 1000.0, 2000.0, 3000.0, 5000.0, 6504.0, 10000.0, 1e9}) {
        const glm::dvec3 rgb = rgbOfUnitLuminance(xyzOfBlackBody(kelvin)).rgb;
        const double ratio = rgb.x / (rgb.x + rgb.z);
        EXPECT_LT(ratio, last + 1e-12) << kelvin; // the first two have no blue at all
        last = ratio;
    }
    // Equal energy has the correlated colour temperature 5455 K, but lies a little off the locus, on the side of purple.
    EXPECT_LT(largestDifference(rgbOfUnitLuminance(xyzOfBlackBody(5455.0)).rgb, glm::dvec3(1.0)), 0.07);
}

TEST(Colorimetry, LuminanceIsOneWhateverTheColour) {
    for (double x = 0.02; x < 0.98; x += 0.06) {
        for (double y = 0.005; x + y <= 1.0; y += 0.06) {
            const RgbColour colour = rgbOfUnitLuminance(xyzOfChromaticity(x, y));
            EXPECT_NEAR(luminance(colour.rgb), 1.0, 1e-12) << x << " " << y;
            EXPECT_GE(std::min({colour.rgb.x, colour.rgb.y, colour.rgb.z}), 0.0) << x << " " << y;
        }
    }
}

TEST(Colorimetry, OnlyColoursOutsideTheGamutAreClamped) {
    EXPECT_FALSE(rgbOfUnitLuminance(kEqualEnergyWhite).clamped);
    EXPECT_FALSE(rgbOfUnitLuminance(xyzOfChromaticity(0.5, 0.35)).clamped);
    EXPECT_TRUE(rgbOfUnitLuminance(xyzOfChromaticity(0.07, 0.83)).clamped);  // 520 nm
    EXPECT_TRUE(rgbOfUnitLuminance(xyzOfChromaticity(0.16, 0.02)).clamped);  // 450 nm
    EXPECT_TRUE(rgbOfUnitLuminance(xyzOfChromaticity(0.73, 0.265)).clamped); // 700 nm
}

TEST(Colorimetry, SpectraAreLinearBetweenTheirValues) {
    const Xyz coarse = xyzOfSpectrum(400, 700, std::vector{0.0, 1.0});
    std::vector<double> values;
    for (int k = 0; k <= 300; ++k) values.push_back(k / 300.0);
    EXPECT_LT(largestDifference(xyzOfSpectrum(400, 700, values), coarse), 1e-9 * coarse.y);
    EXPECT_EQ(xyzOfSpectrum(800, 900, std::vector{1.0, 1.0}), Xyz(0.0));
}

} // namespace
} // namespace lambert
