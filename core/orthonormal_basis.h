#pragma once

#include <glm/vec3.hpp>

#include <cmath>

namespace lambert {

/// A right-handed frame with a given z axis, all of unit length.
struct OrthonormalBasis {
    glm::vec3 x, y, z;

    /// `normal` must have unit length. Continuous but for z = 0.
    /// T. Duff et al., "Building an orthonormal basis, revisited", JCGT 6(1), 2017.
    explicit OrthonormalBasis(const glm::vec3& normal) : z(normal) {
        const float sign = std::copysign(1.0F, normal.z);
        const float a = -1.0F / (sign + normal.z);
        const float b = normal.x * normal.y * a;
        x = {1.0F + sign * normal.x * normal.x * a, sign * b, -sign * normal.x};
        y = {b, sign + normal.y * normal.y * a, -normal.y};
    }

    /// The same turned about z by `angle` (radians).
    OrthonormalBasis(const glm::vec3& normal, float angle) : OrthonormalBasis(normal) {
        const glm::vec3 turned = std::cos(angle) * x + std::sin(angle) * y;
        y = std::cos(angle) * y - std::sin(angle) * x;
        x = turned;
    }
};

} // namespace lambert
