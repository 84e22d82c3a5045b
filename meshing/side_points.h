#pragma once

#include "scene/rays/ray_caster.h"

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <cstdint>
#include <functional>
#include <vector>

namespace lambert {

/// A point on a side of a polygon.
struct SidePoint {
    glm::vec3 point;  //!< metres, on the polygon
    glm::vec3 normal; //!< unit length, to the side
    std::uint32_t polygon;

    /// Where rays begin that leave it.
    glm::vec3 above(const RayCaster& rays) const;
};

/// Points on those sides of a prepared scene that are not black, spread by a weight.
class SidePoints {
public:
    /// `weight(area, material)` >= 0 of a side with this area (m²) and this material.
    SidePoints(const Scene& scene, const std::function<double(double area, const Material& material)>& weight);

    bool empty() const { return sides_.empty(); } //!< no side has a weight
    /// The side at `share` of the sum of all weights, at a point of the unit square. Both in [0, 1); not if empty().
    SidePoint at(double share, const glm::dvec2& u) const;

private:
    struct Side {
        std::uint32_t polygon;
        bool back;
        double upTo; ///< sum of the weights up to and including it
    };

    const Scene& scene_;
    std::vector<Side> sides_;
};

/// Those that emit, by what they emit.
SidePoints emittingSides(const Scene& scene);

/// Directions of a packet around the unit `normal`, density cos/π, one in each of 4 × 4 strata. `one` and `two` tell packets apart.
void aimPacket(const glm::vec3& normal, std::uint32_t one, std::uint32_t two, RayPacket& packet);

} // namespace lambert
