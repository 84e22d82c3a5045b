#pragma once

#include "core/progress.h"
#include "scene/rays/ray_caster.h"
#include "vpl/receiver.h"
#include "vpl/virtual_point_light.h"

#include <cstdint>
#include <limits>
#include <span>
#include <vector>

namespace lambert {

inline constexpr double kUnbounded = std::numeric_limits<double>::infinity();

struct GatherOptions {
    /// Bound of the geometric term G = cosθ_receiver cosθ_light / d², in units of 1/ℓ² where ℓ² is a sixth of the scene's area
    /// (a cube's edge): above 0, kUnbounded for none. A bound takes away light in corners, and the noise there.
    double bound = 10.0;
    /// Rays from each receiver that recover what the bound takes away (Kollig, Keller 2004); 0 to 65536, 0: none. Does
    /// nothing without a bound.
    std::uint32_t recoveryRays = 0;
    std::uint64_t seed = 1; //!< of these rays
    /// Whether receivers get what lights without area and the environment give them directly; no for who has found that in
    /// another way.
    bool direct = true;
    std::uint32_t skyRays = 1024; //!< from each receiver to the environment; 2 to 2^24
};

/// Throws UsageError for options out of range.
void checkGather(const GatherOptions& options);

struct Gathered {
    std::vector<glm::dvec3> irradiance;  //!< #receivers, E per m²
    std::vector<glm::dvec3> cutAt;       //!< #receivers: what the bound took away from each; in part recovered
    std::vector<glm::dvec3> recoveredAt; //!< #receivers: what recovery gave back to each; empty without it
    /// #receivers: radiance that they send by their gloss, see ReceiverGloss, toward their eyes: of the lights as
    /// bounded, of lights without area and of the environment. Empty if none has gloss.
    std::vector<glm::dvec3> glossyRadiance;
    glm::dvec3 cut{0.0}, recovered{0.0}; //!< their means over the receivers
    std::uint64_t shadowRays = 0;
    std::uint64_t recoveryRays = 0;
};

/// G_max in 1/m² of a bound in units of 1/ℓ²; infinite for kUnbounded.
double largestGeometricTerm(const Scene& scene, double bound);

/// The irradiance at receivers from virtual point lights, and from the prepared scene's own lights without area exactly:
///
///     E(x) = Σ Φ/π min(cosθ_x cosθ_v / d², G_max) V(x, v)  +  point, spot: I cosθ_x / d²  +  directional: E_⊥ cosθ_x
///
/// one shadow ray each, in packets from a light to neighbouring receivers; and what the environment gives directly, by
/// rays. Lobes of lights (see VirtualPointLight) count with
///
///     Φ_s/π min((P+1)/2 max(0, r·ω)^P cosθ_x / d², G_max)
///
/// and the gloss of receivers reflects what arrives toward their eyes, see PhongLobe. Recovery knows only diffuse
/// light: together with either it is refused. The same whatever the number of threads. Throws UsageError for that and
/// for options out of range, Cancelled.
Gathered gatherIrradiance(const RayCaster& rays, std::span<const VirtualPointLight> lights,
                          std::span<const Receiver> receivers, const GatherOptions& options, Progress& progress);

} // namespace lambert
