#pragma once

#include "scene/scene.h"

#include <cstdint>

namespace lambert {

/// What a glossy surface sends about the mirrored direction, see PhongLobe.
struct LightLobe {
    Rgb flux{0.0F};       //!< Φ_s, the part below the horizon included, which is lost
    glm::vec3 axis{0.0F}; //!< r, unit length
    float exponent = 0.0F;

    explicit operator bool() const { return flux != Rgb(0.0F); }
};

/// A point of a surface that stands for a share of the light that leaves the scene's surfaces.
///
/// It shines as a diffuse surface does: a receiver at distance d in the direction ω gets  E = Φ/π · cosθ_receiver
/// cosθ_light / d² if nothing stands between; and of its lobe  E = Φ_s (P+1)/2π max(0, r·ω)^P · cosθ_receiver / d².
struct VirtualPointLight {
    glm::vec3 position{0.0F}; //!< on the surface, metres
    glm::vec3 normal{0.0F};   //!< unit length, to the side that shines
    Rgb flux{0.0F};           //!< Φ
    std::uint32_t bounce = 0; //!< reflections behind it; 0: on an emitter
    float lift = 0.0F;        //!< its shadow rays start so far above the surface, metres
    bool castsShadows = true; //!< false: shines through everything, as methods have it that leave indirect shadows out
    LightLobe lobe{};         //!< or none
};

} // namespace lambert
