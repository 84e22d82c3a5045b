#pragma once

#include "scene/scene.h"
#include "vpl/receiver_block.h"
#include "vpl/virtual_point_light.h"

namespace lambert {

/// Whether any of them has gloss.
bool anyGlossy(std::span<const Receiver> receivers);

/// ρ_s / cosθ_eye: the factor of a receiver's lobe (see PhongLobe) that is the same for light from everywhere; black
/// without gloss, or if the eye is below the horizon.
glm::dvec3 glossyScale(const Receiver& receiver);

/// Adds to a block, whose terms are 0 where a light does not arrive, what the light's lobe gives,
///
///     E(x) += Φ_s/π min((P+1)/2 max(0, r·ω)^P cosθ_x / d², G_max),
///
/// and to the radiance that receivers with gloss send to their eyes what they reflect of its lobe and of its diffuse part.
void addGlossy(const VirtualPointLight& light, float largest, ReceiverBlock& block);

/// The same of a light without area; `block.term` holds its irradiance in units of its intensity.
void addGlossy(const PunctualLight& light, ReceiverBlock& block);

} // namespace lambert
