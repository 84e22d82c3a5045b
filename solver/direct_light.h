#pragma once

#include "core/progress.h"
#include "core/sample_points.h"
#include "meshing/patch_mesh.h"
#include "scene/rays/ray_caster.h"
#include "solver/solution.h"

#include <cstdint>
#include <span>
#include <vector>

namespace lambert {

struct DirectLightOptions {
    std::uint32_t points = 256;       //!< of a patch from which each light is looked for; 1 to 65536
    std::uint32_t skyRays = 4096;     //!< per patch, to the environment; 2 to 2^24
    Sampler sampler = Sampler::Sobol; //!< of points and rays
    std::uint64_t seed = 1;
};

/// Throws UsageError for options out of range.
void checkDirectLight(const DirectLightOptions& options);

/// Lights without area; whoever fills this in keeps them.
struct LightSources {
    std::span<const PunctualLight> lights{};
    const Environment* environment = nullptr; //!< or none

    bool empty() const { return lights.empty() && environment == nullptr; }
};
LightSources lightsOf(const Scene& scene);

/// E_0, the irradiance from lights that have no area, on fronts:
///
///     point, spot: I(direction) cosθ / d²    directional: E_⊥ cosθ    environment: ∫ L(ω) cosθ dω over the free directions
///
/// as a mean over points of the patch, each with a shadow ray. A spot's I falls off as KHR_lights_punctual proposes. Rays to
/// the environment are half cosine-distributed, half by its brightness, weighted by the balance heuristic; all are
/// cosine-distributed if it is the same all around.
class DirectLight {
public:
    /// `rays` must outlive it. Throws UsageError for options out of range.
    DirectLight(const RayCaster& rays, const DirectLightOptions& options);

    /// E_0 per m² of every patch, #patches. The same whatever the number of threads. Throws Cancelled.
    std::vector<RgbSum> irradiance(const PatchMesh& mesh, const LightSources& sources, Progress& progress) const;
    /// The same at a point (metres) of a surface with this unit normal. Points of different `index` have rays of their own.
    RgbSum irradiance(const glm::vec3& point, const glm::vec3& normal, std::uint32_t index,
                      const LightSources& sources) const;

private:
    const RayCaster& rays_;
    DirectLightOptions options_;
};

} // namespace lambert
