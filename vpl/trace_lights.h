#pragma once

#include "core/progress.h"
#include "core/sample_points.h"
#include "scene/rays/ray_caster.h"
#include "vpl/phong_lobe.h"
#include "vpl/virtual_point_light.h"

#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

namespace lambert {

/// How particles end.
enum class Walk {
    Quasi,    ///< of N particles, the first ρ̄ᵏ N go on to their k-th hit (Keller 1997); no chance in it
    Roulette, ///< with the probability that the surface absorbs them; no bias
    Fixed     ///< after a number of bounces; what comes after is lost
};

/// quasi, roulette or fixed; nothing for any other name.
std::optional<Walk> walkByName(std::string_view name);
std::string_view nameOf(Walk walk);

struct TraceOptions {
    std::uint32_t particles = 1000; //!< N, from the lights; 1 to 2^24
    Walk walk = Walk::Quasi;
    std::uint32_t bounces = 4;         //!< of fixed walks; 0 to 126
    Sampler sampler = Sampler::Halton; //!< of places and directions; Halton or Random
    /// Of each of Scene::materials, beside its diffuse reflection, on all sides that have the material: lights get
    /// lobes, and particles are carried on by them. Empty: none.
    std::vector<PhongLobe> gloss{};
    std::uint64_t seed = 0; //!< of the Halton sequence's scrambling, 0 for none; of the random numbers
};

/// Throws UsageError for options out of range.
void checkTrace(const TraceOptions& options);

/// Throws UsageError if there is gloss for another number of materials, one would reflect more than it receives, or an
/// exponent is out of range.
void checkGloss(const Scene& scene, std::span<const PhongLobe> gloss);

/// Where the particles' flux went, per channel; sums over particles, so that they balance but for noise:
/// emitted + received = absorbed + below horizon + back faces + escaped + lost. Particles of lights without area that
/// no surface receives are not counted.
struct ParticleFlux {
    glm::dvec3 emitted{0.0};      //!< by surfaces
    glm::dvec3 received{0.0};     //!< by surfaces, from lights without area
    glm::dvec3 absorbed{0.0};     //!< by the surfaces that reflected the rest
    glm::dvec3 belowHorizon{0.0}; //!< reflected by lobes into the surface they are on: absorbed there
    glm::dvec3 backFaces{0.0};    //!< met a black back
    glm::dvec3 escaped{0.0};      //!< left the scene
    glm::dvec3 lost{0.0}; //!< left the last lights of walks that end: is received, but not reflected any further
};

/// Lights that stand for all light in a scene, and how they came about.
struct VirtualPointLights {
    std::vector<VirtualPointLight> lights; //!< by bounce, ascending
    std::vector<std::uint32_t> particles;  //!< S_k, that were followed to their k-th hit; S_0 = N
    ParticleFlux flux;
    std::uint64_t rays = 0;

    /// Those of the bounces from `first` to `last`, both included.
    std::span<const VirtualPointLight> ofBounces(std::uint32_t first, std::uint32_t last) const;
};

/// Traces particles from the lights of a prepared scene; wherever one hits a surface that reflects, a virtual point light
/// remains. Those on emitters (bounce 0) stand for the emitters themselves; lights without area leave none there: their
/// direct light is to be had exactly. Particles that leave the scene or meet a black back leave none either.
///
/// A. Keller, "Instant radiosity", SIGGRAPH 1997; the quasi-random walk: particle j = 1 ... N is point j of the Halton sequence,
/// in bases 2 and 3 for the light and the place on it, and in the next two primes for every further direction. At level k the
/// first S_k = ⌊ρ̄ᵏ N⌋ particles leave lights of flux Φ_0/N · N/S_k · Π ρ(x_m), ρ̄ being the mean reflectance.
///
/// With gloss a light has a diffuse flux and a lobe, and its particle goes on by one of the two, chosen in proportion
/// to their fluxes (sum of the channels) by the first number of its direction, which is then rescaled.
///
/// The same whatever the number of threads. No lights if nothing emits. Throws UsageError for options out of range and as
/// checkGloss, Cancelled.
VirtualPointLights traceLights(const RayCaster& rays, const TraceOptions& options, Progress& progress);

/// ρ̄: the mean over all sides that reflect, by area, and over the channels; with that of gloss (see TraceOptions). 0
/// without any.
double meanReflectance(const Scene& scene, std::span<const PhongLobe> gloss = {});

} // namespace lambert
