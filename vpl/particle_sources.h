#pragma once

#include "scene/polygon_points.h"
#include "scene/rays/ray_caster.h"
#include "scene/surface.h"
#include "vpl/textured_emitter.h"

#include <glm/vec2.hpp>

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

namespace lambert {

/// A point of a side of a polygon.
struct SurfacePoint {
    glm::vec3 position; //!< metres
    glm::vec3 normal;   //!< unit length, of the side
    float lift;         //!< rays leave so far above it, see RayCaster::originOffset
};

/// The point of a polygon's chart on its front or back.
SurfacePoint surfacePoint(const RayCaster& rays, std::uint32_t polygon, bool front, float u, float v);

/// A particle as it leaves a light.
struct Emission {
    std::optional<SurfacePoint> surface; //!< where it leaves; nothing for lights without area
    Rgb flux{0.0F};                      //!< of the light, over the probability that this one was chosen
    glm::vec3 origin{0.0F};              //!< of the ray, metres
    glm::vec3 direction{0.0F};           //!< unit length
};

/// All that emits light in a prepared scene: polygons, two-sided ones on both sides, lights without area, and the environment.
class ParticleSources {
public:
    /// `rays` must outlive it.
    explicit ParticleSources(const RayCaster& rays);

    bool empty() const { return sources_.empty(); }

    /// Chooses a light with a probability proportional to its flux (sum of the channels), a point on it, where an emission
    /// texture is bright, and a direction: cosine-distributed on polygons, proportional to the intensity of point lights and
    /// spots, to the brightness of the environment. Directional lights and the environment send their particles from a disk
    /// across the scene's bounding sphere. `place` chooses the light (first coordinate, then rescaled) and the point,
    /// `direction` the direction; both in [0, 1)².
    Emission emit(const glm::dvec2& place, const glm::dvec2& direction) const;

private:
    struct Source {
        std::uint32_t polygon = kNone; ///< or none:
        std::uint32_t light = kNone;   ///< into Scene::lights; neither: the environment
        bool front = true;
        glm::dvec3 flux{0.0};
        std::shared_ptr<const TexturedEmitter> texture{}; ///< of a polygon that has one
    };
    void addPolygons();
    void add(const Source& source);
    Emission fromPolygon(const Source& source, const glm::dvec2& place, const glm::dvec2& direction) const;
    Emission fromLight(const PunctualLight& light, const glm::dvec2& place, const glm::dvec2& direction) const;
    Emission fromEnvironment(const glm::dvec2& place, const glm::dvec2& direction) const;

    const RayCaster& rays_;
    std::vector<Source> sources_;
    std::vector<double> cumulative_; ///< #sources, of the fluxes' sums
};

} // namespace lambert
