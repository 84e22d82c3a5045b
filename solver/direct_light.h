#pragma once

#include "core/progress.h"
#include "core/sample_points.h"
#include "meshing/patch_mesh.h"
#include "scene/ray_caster.h"
#include "solver/solution.h"

#include <cstdint>
#include <span>
#include <vector>

namespace lambert {

struct DirectLightOptions {
    std::uint32_t points = 64;        //!< of a patch from which each light is looked for; 1 to 65536
    Sampler sampler = Sampler::Sobol; //!< of these points
    std::uint64_t seed = 1;
};

/// E_0, the irradiance from lights that have no area, on fronts:
///
///     point, spot: I(direction) cosθ / d²        directional: E_⊥ cosθ
///
/// as a mean over points of the patch, each with a shadow ray. A spot's I falls off as KHR_lights_punctual proposes.
class DirectLight {
public:
    /// `rays` must outlive it. Throws UsageError for options out of range.
    DirectLight(const RayCaster& rays, const DirectLightOptions& options);

    /// E_0 per m² of every patch, #patches. The same whatever the number of threads. Throws Cancelled.
    std::vector<RgbSum> irradiance(const PatchMesh& mesh, std::span<const PunctualLight> lights,
                                   Progress& progress) const;
    /// The same at a point (metres) of a surface with this unit normal.
    RgbSum irradiance(const glm::vec3& point, const glm::vec3& normal, std::span<const PunctualLight> lights) const;

    /// Shadow rays at most that irradiance() of a mesh takes.
    std::uint64_t rayCount(std::size_t patches, std::size_t lights) const;

private:
    const RayCaster& rays_;
    DirectLightOptions options_;
};

/// The intensity of a point light or spot (per sr) toward a direction of unit length; the illuminance across (per m²) of a
/// directional one.
Rgb intensityToward(const PunctualLight& light, const glm::vec3& direction);

} // namespace lambert
