#pragma once

#include "scene/coplanar_sides.h"
#include "scene/scene.h"

#include <glm/vec3.hpp>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace lambert {

/// What a ray sees of a polygon.
struct SeenPolygon {
    std::uint32_t polygon = kNone; //!< into Scene::polygons
    float u = 0.0F, v = 0.0F;      //!< chart of the polygon, see polygonPoint
    bool front = true;
};

/// Decides for rays between polygons that overlap in one plane, as seenSide does: where two stand back to back a ray must meet the
/// front of one, whichever the ray caster happens to find. Of polygons that face the same way, which prepareScene leaves only where
/// it keeps all polygons, an emitter lies over what does not emit, then the later over the earlier.
class CoplanarTies {
public:
    explicit CoplanarTies(const Scene& scene);

    /// Whether there are such polygons at all.
    bool any() const { return !first_.empty(); }
    /// Whether others hide some of this side.
    bool any(const PolygonSide& side) const { return first_[place(side)] != first_[place(side) + 1]; }

    /// What a ray sees where it meets a side, at a point; nothing if that.
    std::optional<SeenPolygon> seen(const PolygonSide& side, const glm::vec3& point, const glm::vec3& origin,
                                    const glm::vec3& direction) const;

private:
    static std::size_t place(const PolygonSide& side) { return 2 * std::size_t{side.polygon} + (side.back ? 1 : 0); }

    /// A polygon that hides some of a side.
    struct Other {
        std::uint32_t polygon;
        Bounds reach; ///< rays that do not graze meet it only from points of the side in here
    };

    const Scene& scene_;
    std::vector<std::uint32_t> first_; ///< 2 #polygons + 1: of the front and the back of each, into others_; or empty
    std::vector<Other> others_;
    std::vector<glm::vec3> normals_; ///< of length 1, of the polygons; or empty
    double slack_ = 0.0;             ///< metres: what is nearer to an edge lies within it
};

} // namespace lambert
