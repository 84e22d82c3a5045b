#include "scene/rays/ray_caster.h"

#include "core/vector_clones.h"
#include "scene/coplanar_ties.h"
#include "scene/rays/embree_scene.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace lambert {

namespace {

/// Embree's filter: rejects the hits (at most 16 at once) that lie in a hole.
void rejectHoles(const RTCFilterFunctionNArguments* query) {
    for (unsigned lane = 0; lane < query->N; ++lane)
        if (query->valid[lane] != 0 && liesInHole(*query, lane)) query->valid[lane] = 0;
}

LAMBERT_VECTOR_CLONES
void loadDirections(const RayPacket& packet, RTCRayHit16& rays) {
    for (int lane = 0; lane < RayPacket::kSize; ++lane) {
        rays.ray.dir_x[lane] = packet.directionX[lane];
        rays.ray.dir_y[lane] = packet.directionY[lane];
        rays.ray.dir_z[lane] = packet.directionZ[lane];
    }
    beginRays(packet.active, rays);
    leaveOutUntraceable(rays.ray);
}

LAMBERT_VECTOR_CLONES
void store(const RTCRayHit16& rays, RayPacket& packet) {
    for (int lane = 0; lane < RayPacket::kSize; ++lane) {
        packet.facing[lane] = rays.ray.dir_x[lane] * rays.hit.Ng_x[lane] + rays.ray.dir_y[lane] * rays.hit.Ng_y[lane] +
                              rays.ray.dir_z[lane] * rays.hit.Ng_z[lane];
    }
}

/// Geometry 1 begins with the triangle `first1`. `halves` as in TriangleTable.
LAMBERT_VECTOR_CLONES
void storePolygons(const RTCRayHit16& rays, const std::uint32_t* halves, std::uint32_t first1, RayPacket& packet) {
    std::uint32_t half[RayPacket::kSize];
    for (int lane = 0; lane < RayPacket::kSize; ++lane)
        half[lane] = rays.hit.geomID[lane] == RTC_INVALID_GEOMETRY_ID
                         ? 0
                         : rays.hit.primID[lane] + (rays.hit.geomID[lane] == 1 ? first1 : 0);
    if (halves != nullptr)
        for (int lane = 0; lane < RayPacket::kSize; ++lane) half[lane] = halves[half[lane]];
    for (int lane = 0; lane < RayPacket::kSize; ++lane) {
        const bool second = (half[lane] & 1U) != 0;
        packet.u[lane] = second ? 1.0F - rays.hit.u[lane] : rays.hit.u[lane];
        packet.v[lane] = second ? 1.0F - rays.hit.v[lane] : rays.hit.v[lane];
        packet.polygon[lane] = rays.hit.geomID[lane] != RTC_INVALID_GEOMETRY_ID ? half[lane] >> 1U : kNone;
    }
}

/// With directions of length 1 or so: rays of very short ones lose hits.
LAMBERT_VECTOR_CLONES
void load(const ShadowPacket& packet, float scale, RTCRay16& rays) {
    beginRays(packet.active, 1.0F, rays);
    for (int lane = 0; lane < ShadowPacket::kSize; ++lane) {
        const float x = std::abs(packet.directionX[lane]);
        const float y = std::abs(packet.directionY[lane]);
        const float z = std::abs(packet.directionZ[lane]);
        const float xy = x > y ? x : y;
        const float longest = xy > z ? xy : z;
        const float length = longest > 0.0F ? longest : 1.0F;
        rays.org_x[lane] = scale * packet.originX[lane];
        rays.org_y[lane] = scale * packet.originY[lane];
        rays.org_z[lane] = scale * packet.originZ[lane];
        rays.dir_x[lane] = packet.directionX[lane] / length;
        rays.dir_y[lane] = packet.directionY[lane] / length;
        rays.dir_z[lane] = packet.directionZ[lane] / length;
        const float end = scale * length * packet.maxDistance[lane];
        rays.tfar[lane] = end < std::numeric_limits<float>::max() ? end : std::numeric_limits<float>::max();
    }
    leaveOutUntraceable(rays);
}

LAMBERT_VECTOR_CLONES
void store(const RTCRay16& rays, ShadowPacket& packet) {
    for (int lane = 0; lane < ShadowPacket::kSize; ++lane)
        packet.occluded[lane] = packet.active[lane] != 0 && rays.tfar[lane] < 0.0F;
}

/// Occluders have two backs.
void turnOccluders(const Scene& scene, RayPacket& packet) {
    for (int lane = 0; lane < RayPacket::kSize; ++lane)
        if (packet.polygon[lane] != kNone && isOccluder(scene, scene.polygons[packet.polygon[lane]]))
            packet.facing[lane] = std::abs(packet.facing[lane]);
}

RTCRay embreeRay(const Ray& ray, float scale) {
    RTCRay result{};
    result.org_x = scale * ray.origin.x;
    result.org_y = scale * ray.origin.y;
    result.org_z = scale * ray.origin.z;
    result.dir_x = ray.direction.x;
    result.dir_y = ray.direction.y;
    result.dir_z = ray.direction.z;
    result.tfar = std::min(scale * ray.maxDistance, std::numeric_limits<float>::max());
    result.mask = ~0U;
    leaveOutUntraceable(result);
    return result;
}

} // namespace

struct RayCaster::Impl {
    explicit Impl(const Scene& source)
        : scene(source),
          bounds(boundsOf(source)),
          anyOccluders(hasOccluders(source)),
          ties(source),
          embree(source, {.opaque = nullptr, .withHoles = rejectHoles}) {}

    const Scene& scene;
    Bounds bounds;
    bool anyOccluders;
    CoplanarTies ties;
    EmbreeScene embree;

    /// `rays` hold the origins, `packet` the directions.
    void trace(RTCRayHit16& rays, RayPacket& packet, Coherence coherence) const {
        QueryContext context;
        beginQuery(context);
        loadDirections(packet, rays);
        intersectPacket(embree.width(), packet.active, embree.handle(), context,
                        coherence == Coherence::High ? Likeness::Coherent : Likeness::None, rays);
        store(rays, packet);
        storePolygons(rays, embree.triangles().halves, embree.firstTriangle(1), packet);
        if (anyOccluders) turnOccluders(scene, packet);
    }

    /// Where several polygons lie in the plane that a ray met, finds the one that it sees. `originOf` gives the origin of a lane.
    template <typename OriginOf>
    void settleTies(const OriginOf& originOf, RayPacket& packet) const {
        if (!ties.any()) return;
        for (int lane = 0; lane < RayPacket::kSize; ++lane) {
            const PolygonSide side{packet.polygon[lane], packet.facing[lane] > 0.0F};
            if (side.polygon == kNone || !ties.any(side)) continue;
            const glm::vec3 direction(packet.directionX[lane], packet.directionY[lane], packet.directionZ[lane]);
            const auto seen = ties.seen(side, polygonPoint(scene, side.polygon, packet.u[lane], packet.v[lane]),
                                        originOf(lane), direction);
            if (!seen) continue;
            packet.polygon[lane] = seen->polygon;
            packet.u[lane] = seen->u;
            packet.v[lane] = seen->v;
            packet.facing[lane] = std::copysign(packet.facing[lane], seen->front ? -1.0F : 1.0F);
        }
    }
};

glm::vec3 polygonPoint(const Scene& scene, std::uint32_t polygon, float u, float v) {
    const Polygon& p = scene.polygons[polygon];
    const glm::vec3 a = corner(scene, p, 0);
    if (!p.isQuad()) return a + u * (corner(scene, p, 1) - a) + v * (corner(scene, p, 2) - a);
    const glm::vec3 b = corner(scene, p, 1);
    const glm::vec3 c = corner(scene, p, 2);
    const glm::vec3 d = corner(scene, p, 3);
    if (u + v <= 1.0F) return a + u * (b - a) + v * (d - a);
    return c + (1.0F - u) * (d - c) + (1.0F - v) * (b - c);
}

RayCaster::RayCaster(const Scene& scene) : impl_(std::make_unique<Impl>(scene)) {}
RayCaster::~RayCaster() = default;
RayCaster::RayCaster(RayCaster&&) noexcept = default;

std::optional<Hit> RayCaster::closest(const Ray& ray) const {
    QueryContext context;
    beginQuery(context);
    RTCRayHit query{};
    query.ray = embreeRay(ray, impl_->embree.scale());
    query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    intersect(impl_->embree.handle(), context, query);
    if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID) return std::nullopt;
    const glm::vec3 normal(query.hit.Ng_x, query.hit.Ng_y, query.hit.Ng_z);
    const PolygonHit hit = impl_->embree.triangles().hit(
        impl_->embree.firstTriangle(query.hit.geomID) + query.hit.primID, query.hit.u, query.hit.v);
    const bool front =
        glm::dot(ray.direction, normal) < 0.0F && !isOccluder(impl_->scene, impl_->scene.polygons[hit.polygon]);
    const float distance = query.ray.tfar / impl_->embree.scale();
    if (const PolygonSide side{hit.polygon, !front}; impl_->ties.any() && impl_->ties.any(side))
        if (const auto seen = impl_->ties.seen(side, polygonPoint(impl_->scene, hit.polygon, hit.u, hit.v), ray.origin,
                                               ray.direction))
            return Hit{seen->polygon, seen->u, seen->v, distance, seen->front};
    return Hit{hit.polygon, hit.u, hit.v, distance, front};
}

void RayCaster::closest(const glm::vec3& origin, RayPacket& packet) const {
    alignas(64) RTCRayHit16 rays;
    const glm::vec3 scaled = impl_->embree.scale() * origin;
    std::fill_n(rays.ray.org_x, RayPacket::kSize, scaled.x);
    std::fill_n(rays.ray.org_y, RayPacket::kSize, scaled.y);
    std::fill_n(rays.ray.org_z, RayPacket::kSize, scaled.z);
    impl_->trace(rays, packet, Coherence::High);
    impl_->settleTies([&](int) { return origin; }, packet);
}

void RayCaster::closest(const RayOrigins& origins, RayPacket& packet, Coherence coherence) const {
    alignas(64) RTCRayHit16 rays;
    const float scale = impl_->embree.scale();
    for (int lane = 0; lane < RayPacket::kSize; ++lane) {
        rays.ray.org_x[lane] = scale * origins.x[lane];
        rays.ray.org_y[lane] = scale * origins.y[lane];
        rays.ray.org_z[lane] = scale * origins.z[lane];
    }
    impl_->trace(rays, packet, coherence);
    impl_->settleTies([&](int lane) { return glm::vec3(origins.x[lane], origins.y[lane], origins.z[lane]); }, packet);
}

bool RayCaster::occluded(const Ray& ray) const {
    QueryContext context;
    beginQuery(context);
    RTCRay query = embreeRay(ray, impl_->embree.scale());
    lambert::occluded(impl_->embree.handle(), context, query);
    return query.tfar < 0.0F;
}

void RayCaster::occluded(ShadowPacket& packet) const {
    QueryContext context;
    beginQuery(context);
    alignas(64) RTCRay16 rays;
    load(packet, impl_->embree.scale(), rays);
    occludedPacket(impl_->embree.width(), packet.active, impl_->embree.handle(), context, Likeness::Coherent, rays);
    store(rays, packet);
}

const Scene& RayCaster::scene() const { return impl_->scene; }
const Bounds& RayCaster::bounds() const { return impl_->bounds; }

float RayCaster::originOffset(float size) const { return coordinateTolerance(impl_->bounds) + 1e-5F * size; }

} // namespace lambert
