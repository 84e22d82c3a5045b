#pragma once

#include <glm/vec3.hpp>

#include <string>

namespace lambert {

/// A pinhole camera. Looks from `eye` along `direction`.
struct Camera {
    std::string name;
    glm::vec3 eye{0.0F};
    glm::vec3 direction{0.0F, 0.0F, -1.0F}; //!< unit length
    glm::vec3 up{0.0F, 1.0F, 0.0F};         //!< not parallel to `direction`
    float verticalFov = 0.8F;               //!< radians, full angle, 0 to π
};

} // namespace lambert
