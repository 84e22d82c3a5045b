#pragma once

#include "scene/polygon_points.h"
#include "scene/ray_caster.h"
#include "scene/surface.h"

#include <glm/vec2.hpp>

#include <cstdint>
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

/// All that emits light in a prepared scene: polygons, two-sided ones on both sides, and lights without area. The environment
/// is not among them.
class ParticleSources {
public:
    /// `rays` must outlive it.
    explicit ParticleSources(const RayCaster& rays);

    bool empty() const { return sources_.empty(); }

    /// Chooses a light with a probability proportional to its flux (sum of the channels; an emission texture is taken for
    /// white here and counts in the particle's flux), a point on it, and a direction: cosine-distributed on polygons,
    /// proportional to the intensity of point lights and spots. A directional light sends its particles from a disk across
    /// the scene's bounding sphere. `place` chooses the light (first coordinate, then rescaled) and the point, `direction`
    /// the direction; both in [0, 1)².
    Emission emit(const glm::dvec2& place, const glm::dvec2& direction) const;

private:
    struct Source {
        std::uint32_t polygon = kNone; ///< or none:
        std::uint32_t light = kNone;   ///< into Scene::lights
        bool front = true;
        glm::dvec3 flux{0.0};
    };
    void add(const Source& source);
    Emission fromPolygon(const Source& source, const glm::dvec2& place, const glm::dvec2& direction) const;
    Emission fromLight(const PunctualLight& light, const glm::dvec2& place, const glm::dvec2& direction) const;

    const RayCaster& rays_;
    std::vector<Source> sources_;
    std::vector<double> cumulative_; ///< #sources, of the fluxes' sums
};

} // namespace lambert
