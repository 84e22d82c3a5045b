// Patterns: CIE S 011/E:2003 (ISO 15469), "Spatial distribution of daylight: CIE standard general sky": formulas (1) to (3), types 12
//   and 16. As R. Kittler, R. Perez, S. Darula, "A set of standard skies characterizing daylight conditions", 1998.
// Illuminances: IES Calculation Procedures Committee, "Recommended practice for the calculation of daylight availability",
//   Journal of the IES 13(4), 1984.
// Air mass: F. Kasten, A. T. Young, "Revised optical air mass tables and approximation formula", Applied Optics 28(22), 1989.

#include "scene/sky.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace lambert {

namespace {

constexpr double kPi = std::numbers::pi;

double sine(double degrees) { return std::sin(degrees * kPi / 180.0); }

/// From the zenith (cosine 1) to the horizon: φ of the standard, type 12.
double gradation(double cosine) { return cosine > 0.0 ? 1.0 - std::exp(-0.32 / cosine) : 1.0; }

/// Around the sun at an angle χ (radians): f of the standard, type 12.
double indicatrix(double angle) {
    const double cosine = std::cos(angle);
    return 1.0 + 10.0 * (std::exp(-3.0 * angle) - std::exp(-1.5 * kPi)) + 0.45 * cosine * cosine;
}

double angleBetween(const glm::dvec3& a, const glm::dvec3& b) {
    return std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b));
}

/// ∫ L sin(elevation) dω over the upper half of the sphere, by the midpoint rule in azimuth and in sin² of the elevation.
double levelIlluminance(const glm::dvec3& toSun) {
    constexpr int kSteps = 512;
    double sum = 0.0;
    for (int row = 0; row < kSteps; ++row) {
        const double height = std::sqrt((row + 0.5) / kSteps);
        const double radius = std::sqrt(1.0 - height * height);
        for (int column = 0; column < kSteps; ++column) {
            const double azimuth = 2.0 * kPi * (column + 0.5) / kSteps;
            sum += clearSkyPattern({radius * std::sin(azimuth), height, -radius * std::cos(azimuth)}, toSun);
        }
    }
    return kPi * sum / (kSteps * kSteps);
}

} // namespace

double clearSkyPattern(const glm::dvec3& direction, const glm::dvec3& toSun) {
    if (!(direction.y > 0.0)) return 0.0;
    const double sunToZenith = angleBetween(toSun, {0.0, 1.0, 0.0});
    return indicatrix(angleBetween(direction, toSun)) * gradation(direction.y) /
           (indicatrix(sunToZenith) * gradation(1.0));
}

double clearSkyIlluminance(double sunElevation) {
    return 800.0 + 15500.0 * std::sqrt(std::max(0.0, sine(sunElevation)));
}

double overcastSkyIlluminance(double sunElevation) { return 300.0 + 21000.0 * std::max(0.0, sine(sunElevation)); }

double sunIlluminance(double sunElevation) {
    constexpr double kBeyondAir = 127500.0; // lx, the mean over the year
    constexpr double kExtinction = 0.21;    // per air mass, clear sky
    const double airMass = 1.0 / (sine(sunElevation) + 0.50572 * std::pow(sunElevation + 6.07995, -1.6364));
    return kBeyondAir * std::exp(-kExtinction * airMass);
}

Environment clearSky(double sunAzimuth, double sunElevation) {
    const glm::dvec3 toSun = skyDirection(sunAzimuth, sunElevation);
    const double zenith = clearSkyIlluminance(sunElevation) / levelIlluminance(toSun);
    return Environment::function([=](const glm::dvec3& direction) {
        return Rgb(static_cast<float>(zenith * clearSkyPattern(direction, toSun)));
    });
}

Environment overcastSky(double illuminance) {
    const double zenith = illuminance * 9.0 / (7.0 * kPi);
    return Environment::function([=](const glm::dvec3& direction) {
        return Rgb(direction.y > 0.0 ? static_cast<float>(zenith * (1.0 + 2.0 * direction.y) / 3.0) : 0.0F);
    });
}

} // namespace lambert
