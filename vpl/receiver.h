#pragma once

#include <glm/vec3.hpp>

namespace lambert {

/// A point that receives light: a patch's centre, a vertex, a sensor, what a pixel shows.
struct Receiver {
    glm::vec3 position{0.0F}; //!< metres
    glm::vec3 normal{0.0F};   //!< unit length
    float lift = 0.0F;        //!< shadow rays end so far above it, metres; see RayCaster::originOffset
};

} // namespace lambert
