#pragma once

#include "vpl/phong_lobe.h"

#include <glm/vec3.hpp>

namespace lambert {

/// What a receiver reflects beside its diffuse part, as the one sees it who looks at it. Only gathering knows of it.
struct ReceiverGloss {
    PhongLobe lobe{};
    glm::vec3 toEye{0.0F}; //!< unit length; below the surface's horizon nothing is seen
};

/// A point that receives light: a patch's centre, a vertex, a sensor, what a pixel shows.
struct Receiver {
    glm::vec3 position{0.0F}; //!< metres
    glm::vec3 normal{0.0F};   //!< unit length
    float lift = 0.0F;        //!< shadow rays end so far above it, metres; see RayCaster::originOffset
    ReceiverGloss gloss{};    //!< or none
};

} // namespace lambert
