// Spot: https://github.com/KhronosGroup/glTF/tree/main/extensions/2.0/Khronos/KHR_lights_punctual#inner-and-outer-cone-angles

#include "scene/punctual_light.h"

#include "core/orthonormal_basis.h"
#include "core/warps.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace lambert {

namespace {

/// A spot's falloff t² over the cosine of the angle to its axis: t rises by 1 over `width` from `outer` on and stays 1.
struct SpotCone {
    double outer, width;
    double rim, core; ///< ∫ t² over the cosines where it rises, and where it is 1

    explicit SpotCone(const PunctualLight& light) {
        const double inner = std::cos(static_cast<double>(light.innerConeAngle));
        outer = std::cos(static_cast<double>(light.outerConeAngle));
        width = std::max(0.001, inner - outer);
        const double t = std::min(1.0, (1.0 - outer) / width); // a beam may be too narrow to reach 1
        rim = width * t * t * t / 3.0;
        core = std::max(0.0, 1.0 - outer - width);
    }

    double falloff(double cosine) const {
        const double t = std::clamp((cosine - outer) / width, 0.0, 1.0);
        return t * t;
    }
    double cosineAt(double u) const {
        const double area = u * (rim + core);
        if (area < rim) return std::min(1.0, outer + width * std::cbrt(3.0 * area / width));
        return std::min(1.0, outer + width + (area - rim));
    }
};

} // namespace

Rgb intensityToward(const PunctualLight& light, const glm::vec3& direction) {
    if (light.kind != PunctualLight::Kind::Spot) return light.intensity;
    const double cosine = glm::dot(glm::dvec3(light.direction), glm::dvec3(direction));
    return static_cast<float>(SpotCone(light).falloff(cosine)) * light.intensity;
}

glm::dvec3 totalFlux(const PunctualLight& light) {
    const glm::dvec3 intensity(light.intensity);
    if (light.kind != PunctualLight::Kind::Spot) return 4.0 * std::numbers::pi * intensity;
    const SpotCone cone(light);
    return 2.0 * std::numbers::pi * (cone.rim + cone.core) * intensity;
}

glm::dvec3 sampleDirection(const PunctualLight& light, const glm::dvec2& u) {
    if (light.kind != PunctualLight::Kind::Spot) return uniformSphere(u);
    const double cosine = SpotCone(light).cosineAt(u.x);
    const double sine = std::sqrt(std::max(0.0, 1.0 - cosine * cosine));
    const double angle = 2.0 * std::numbers::pi * u.y;
    const OrthonormalBasis frame(light.direction);
    return glm::normalize(sine * std::cos(angle) * glm::dvec3(frame.x) + sine * std::sin(angle) * glm::dvec3(frame.y) +
                          cosine * glm::dvec3(frame.z));
}

} // namespace lambert
