#pragma once
#include "core/warps.h"

#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace lambert {

/// Gloss beside a surface's diffuse reflection: what arrives from a direction is spread about the mirrored direction r
/// with the density (P+1)/2π max(0, r·ω)^P per sr (B. T. Phong, CACM 18(6), 1975, normalised). As a BRDF, for light
/// reflected to ω_o:
///
///     f = ρ_s (P+1)/2π max(0, r·ω_o)^P / cosθ_o
///
/// It reflects ρ_s of the light, but for the part of the lobe that lies below the horizon: that is absorbed, up to half
/// of it at grazing incidence. It is not reciprocal: f(i, o) cosθ_o is symmetric, f is not.
struct PhongLobe {
    glm::vec3 reflectance{0.0F}; //!< ρ_s per channel; with the diffuse one at most 1
    float exponent = 0.0F;       //!< P, 0 to 1e6: 0 a hemisphere about r, 1 a cosine, 10 dull, 1000 nearly a mirror

    explicit operator bool() const { return reflectance != glm::vec3(0.0F); }
    bool operator==(const PhongLobe&) const = default;
};

inline constexpr float kLargestPhongExponent = 1e6F;

/// (P+1)/2π max(0, cosine)^P, per sr; `cosine` of the angle to the mirrored direction.
inline double phongDensity(double exponent, double cosine) {
    constexpr double kFullAngle = 2.0 * std::numbers::pi;
    return cosine > 0.0 ? (exponent + 1.0) / kFullAngle * std::pow(std::min(cosine, 1.0), exponent) : 0.0;
}

/// Where light that comes along `direction`, or comes from it, goes on from a mirror: both of unit length.
inline glm::vec3 mirrored(const glm::vec3& direction, const glm::vec3& normal) {
    return glm::normalize(direction - 2.0F * glm::dot(direction, normal) * normal);
}

/// To directions about +z with density phongDensity(exponent, z), from a point of the unit square: strata stay strata.
inline glm::dvec3 phongDirection(const glm::dvec2& u, double exponent) {
    const glm::dvec2 disk = concentricDisk(u);
    const double squared = glm::dot(disk, disk);
    const double z = std::pow(std::max(0.0, 1.0 - squared), 1.0 / (exponent + 1.0));
    const double scale = squared > 0.0 ? std::sqrt((1.0 - z * z) / squared) : 0.0;
    return {scale * disk.x, scale * disk.y, z};
}

} // namespace lambert
