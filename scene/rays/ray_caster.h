#pragma once

#include "scene/scene.h"

#include <cstdint>
#include <memory>
#include <optional>

namespace lambert {

struct Ray {
    glm::vec3 origin;
    glm::vec3 direction;       //!< need not have unit length
    float maxDistance = 1e30F; //!< in lengths of `direction`
};

struct Hit {
    std::uint32_t polygon; //!< into Scene::polygons
    float u, v;            //!< chart of the polygon, see polygonPoint()
    float distance;        //!< in lengths of the ray's direction
    bool front;            //!< the ray meets the polygon's front
};

/// 16 rays that share an origin, and what they hit; laid out for vector code.
struct alignas(64) RayPacket {
    static constexpr int kSize = 16;
    float directionX[kSize], directionY[kSize], directionZ[kSize];
    int active[kSize]; //!< -1 for a ray to be traced, 0 for none

    std::uint32_t polygon[kSize]; //!< out: kNone where nothing was hit, and for inactive rays
    float u[kSize], v[kSize];     //!< out: chart of the polygon
    float facing[kSize];          //!< out: direction · geometric normal; negative on the front

    void aim(int lane, const glm::vec3& direction, bool isActive = true) {
        directionX[lane] = direction.x;
        directionY[lane] = direction.y;
        directionZ[lane] = direction.z;
        active[lane] = isActive ? -1 : 0;
    }
};

/// How near to each other the rays of a packet are; decides how they are traced, not what they hit.
enum class Coherence {
    High, ///< most of them meet the same polygons
    Low   ///< they begin near each other and have about the same direction
};

/// Origins of a packet's rays, if they do not share one.
struct alignas(64) RayOrigins {
    float x[RayPacket::kSize], y[RayPacket::kSize], z[RayPacket::kSize];

    void set(int lane, const glm::vec3& origin) {
        x[lane] = origin.x;
        y[lane] = origin.y;
        z[lane] = origin.z;
    }
};

/// 16 rays of which is asked only whether they are free; laid out for vector code.
struct alignas(64) ShadowPacket {
    static constexpr int kSize = 16;
    float originX[kSize], originY[kSize], originZ[kSize];
    float directionX[kSize], directionY[kSize], directionZ[kSize];
    float maxDistance[kSize]; //!< in lengths of the direction
    int active[kSize];        //!< -1 for a ray to be traced, 0 for none
    bool occluded[kSize];     //!< out: something lies on the ray before its maxDistance; false for inactive rays

    void set(int lane, const Ray& ray, bool isActive = true) {
        originX[lane] = ray.origin.x;
        originY[lane] = ray.origin.y;
        originZ[lane] = ray.origin.z;
        directionX[lane] = ray.direction.x;
        directionY[lane] = ray.direction.y;
        directionZ[lane] = ray.direction.z;
        maxDistance[lane] = ray.maxDistance;
        active[lane] = isActive ? -1 : 0;
    }
};

/// The point of a polygon with chart coordinates (u, v). A triangle's chart is v0 + u (v1 − v0) + v (v2 − v0).
/// A quad's is affine on each of the triangles (v0, v1, v3), where u + v <= 1, and (v2, v3, v1).
glm::vec3 polygonPoint(const Scene& scene, std::uint32_t polygon, float u, float v);

/// Finds what rays hit first among the source polygons of a scene. Thread-safe. Rays pass through holes (see hasHoles), where
/// the texel nearest to a hit, without any filtering, decides. Occluders are met on their back, from wherever they are seen. A ray that
/// is not finite meets nothing.
class RayCaster {
public:
    /// `scene` must outlive the caster. Every polygon must be finite and have an area.
    explicit RayCaster(const Scene& scene);
    ~RayCaster();
    RayCaster(RayCaster&&) noexcept;

    /// First hit, or nothing.
    std::optional<Hit> closest(const Ray& ray) const;
    /// First hits of 16 rays from `origin`, fastest if their directions are close to each other.
    void closest(const glm::vec3& origin, RayPacket& packet) const;
    /// The same for rays with origins of their own.
    void closest(const RayOrigins& origins, RayPacket& packet, Coherence coherence = Coherence::High) const;
    /// Whether anything lies on the ray before its maxDistance.
    bool occluded(const Ray& ray) const;
    /// The same for 16 rays, fastest if they are close to each other.
    void occluded(ShadowPacket& packet) const;

    const Scene& scene() const;
    const Bounds& bounds() const;

    /// A ray that leaves a surface starts this far above it (metres), `size` being the surface's diameter:
    /// far enough to clear rounding at the scene's scale, small against the surface.
    float originOffset(float size) const;

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

} // namespace lambert
