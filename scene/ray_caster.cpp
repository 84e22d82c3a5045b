#include "scene/ray_caster.h"

#include "core/error.h"
#include "core/vector_clones.h"
#include "scene/surface.h"

#include <embree3/rtcore.h>
#include <fmt/format.h>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <tbb/task_arena.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>

namespace lambert {

namespace {

bool isFinite(const glm::vec3& v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

/// Embree's number of a geometry. Polygons with holes have one of their own, so that no others need a filter.
enum GeometryId : unsigned { kOpaque = 0, kWithHoles = 1 };

/// Polygons of one geometry. Embree knows them by their place in `polygons`.
struct PolygonSet {
    const Scene* scene = nullptr;
    std::vector<std::uint32_t> polygons; //!< into Scene::polygons, ascending
};

/// The polygons as one quad geometry; a triangle repeats its last corner, and its chart is that of the quad's first half.
RTCGeometry quadGeometry(RTCDevice device, const PolygonSet& set) {
    const Scene& scene = *set.scene;
    RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_QUAD);
    auto* indices = static_cast<std::uint32_t*>(rtcSetNewGeometryBuffer(
        geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT4, 4 * sizeof(std::uint32_t), set.polygons.size()));
    auto* vertices = static_cast<float*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                                                 3 * sizeof(float), scene.positions.size()));
    if (indices == nullptr || vertices == nullptr) throw SystemError("not enough memory for the ray caster");
    for (const std::uint32_t index : set.polygons) {
        const Polygon& polygon = scene.polygons[index];
        const auto& v = polygon.vertices;
        indices = std::copy_n(std::array{v[0], v[1], v[2], polygon.isQuad() ? v[3] : v[2]}.begin(), 4, indices);
    }
    for (const glm::vec3& position : scene.positions) {
        // Unused vertices may be anything in the file; Embree must not see them.
        const glm::vec3 p = isFinite(position) ? position : glm::vec3(0.0F);
        vertices = std::copy_n(std::array{p.x, p.y, p.z}.begin(), 3, vertices);
    }
    return geometry;
}

/// Embree's filter: rejects the hits (at most 16 at once) that lie in a hole.
void rejectHoles(const RTCFilterFunctionNArguments* query) {
    const auto& set = *static_cast<const PolygonSet*>(query->geometryUserPtr);
    for (unsigned lane = 0; lane < query->N; ++lane) {
        if (query->valid[lane] == 0) continue;
        const std::uint32_t polygon = set.polygons[RTCHitN_primID(query->hit, query->N, lane)];
        const float u = RTCHitN_u(query->hit, query->N, lane);
        const float v = RTCHitN_v(query->hit, query->N, lane);
        if (isHole(*set.scene, set.scene->polygons[polygon], u, v)) query->valid[lane] = 0;
    }
}

void attach(RTCScene target, RTCGeometry geometry, GeometryId id) {
    rtcCommitGeometry(geometry);
    rtcAttachGeometryByID(target, geometry, id);
    rtcReleaseGeometry(geometry);
}

LAMBERT_VECTOR_CLONES
void loadOrigin(const glm::vec3& origin, RTCRayHit16& rays) {
    for (int lane = 0; lane < RayPacket::kSize; ++lane) {
        rays.ray.org_x[lane] = origin.x;
        rays.ray.org_y[lane] = origin.y;
        rays.ray.org_z[lane] = origin.z;
    }
}

LAMBERT_VECTOR_CLONES
void loadOrigins(const RayOrigins& origins, RTCRayHit16& rays) {
    for (int lane = 0; lane < RayPacket::kSize; ++lane) {
        rays.ray.org_x[lane] = origins.x[lane];
        rays.ray.org_y[lane] = origins.y[lane];
        rays.ray.org_z[lane] = origins.z[lane];
    }
}

LAMBERT_VECTOR_CLONES
void loadDirections(const RayPacket& packet, RTCRayHit16& rays) {
    for (int lane = 0; lane < RayPacket::kSize; ++lane) {
        rays.ray.dir_x[lane] = packet.directionX[lane];
        rays.ray.dir_y[lane] = packet.directionY[lane];
        rays.ray.dir_z[lane] = packet.directionZ[lane];
        rays.ray.tnear[lane] = 0.0F;
        rays.ray.tfar[lane] = 1e30F;
        rays.ray.time[lane] = 0.0F;
        rays.ray.mask[lane] = ~0U;
        rays.ray.flags[lane] = 0;
        rays.hit.geomID[lane] = RTC_INVALID_GEOMETRY_ID;
    }
}

LAMBERT_VECTOR_CLONES
void store(const RTCRayHit16& rays, RayPacket& packet) {
    for (int lane = 0; lane < RayPacket::kSize; ++lane) {
        packet.facing[lane] = rays.ray.dir_x[lane] * rays.hit.Ng_x[lane] + rays.ray.dir_y[lane] * rays.hit.Ng_y[lane] +
                              rays.ray.dir_z[lane] * rays.hit.Ng_z[lane];
        packet.u[lane] = rays.hit.u[lane];
        packet.v[lane] = rays.hit.v[lane];
        packet.polygon[lane] = rays.hit.geomID[lane] != RTC_INVALID_GEOMETRY_ID ? rays.hit.primID[lane] : kNone;
    }
}

/// Occluders have two backs.
void turnOccluders(const Scene& scene, RayPacket& packet) {
    for (int lane = 0; lane < RayPacket::kSize; ++lane)
        if (packet.polygon[lane] != kNone && isOccluder(scene, scene.polygons[packet.polygon[lane]]))
            packet.facing[lane] = std::abs(packet.facing[lane]);
}

RTCRay embreeRay(const Ray& ray) {
    assert(isFinite(ray.origin) && isFinite(ray.direction)); // Debian's Embree aborts on such rays
    RTCRay result{};
    result.org_x = ray.origin.x;
    result.org_y = ray.origin.y;
    result.org_z = ray.origin.z;
    result.dir_x = ray.direction.x;
    result.dir_y = ray.direction.y;
    result.dir_z = ray.direction.z;
    result.tfar = ray.maxDistance;
    result.mask = ~0U;
    return result;
}

} // namespace

struct RayCaster::Impl {
    const Scene* scene = nullptr;
    Bounds bounds;
    float largestCoordinate = 0.0F;
    bool hasOccluders = false;
    RTCDevice device = nullptr;
    RTCScene embree = nullptr;
    std::array<PolygonSet, 2> sets; //!< by GeometryId

    /// Sorts the polygons into those with holes and the others, and gives them to Embree.
    void attachPolygons() {
        for (PolygonSet& set : sets) set.scene = scene;
        for (std::uint32_t i = 0; i < scene->polygons.size(); ++i)
            sets[hasHoles(*scene, scene->polygons[i]) ? kWithHoles : kOpaque].polygons.push_back(i);
        if (!sets[kOpaque].polygons.empty()) attach(embree, quadGeometry(device, sets[kOpaque]), kOpaque);
        if (!anyHoles()) return;
        const RTCGeometry geometry = quadGeometry(device, sets[kWithHoles]);
        rtcSetGeometryUserData(geometry, &sets[kWithHoles]);
        rtcSetGeometryIntersectFilterFunction(geometry, rejectHoles);
        rtcSetGeometryOccludedFilterFunction(geometry, rejectHoles);
        attach(embree, geometry, kWithHoles);
    }

    bool anyHoles() const { return !sets[kWithHoles].polygons.empty(); }

    std::uint32_t polygonOf(unsigned geometry, unsigned primitive) const {
        return anyHoles() ? sets[geometry].polygons[primitive] : primitive;
    }

    /// `rays` hold the origins, `packet` the directions.
    void trace(RTCRayHit16& rays, RayPacket& packet) const {
        RTCIntersectContext context;
        rtcInitIntersectContext(&context);
        context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
        loadDirections(packet, rays);
        rtcIntersect16(packet.active, embree, &context, &rays);
        store(rays, packet);
        if (anyHoles())
            for (int lane = 0; lane < RayPacket::kSize; ++lane)
                if (packet.polygon[lane] != kNone)
                    packet.polygon[lane] = polygonOf(rays.hit.geomID[lane], rays.hit.primID[lane]);
        if (hasOccluders) turnOccluders(*scene, packet);
    }

    ~Impl() {
        if (embree != nullptr) rtcReleaseScene(embree);
        if (device != nullptr) rtcReleaseDevice(device);
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

RayCaster::RayCaster(const Scene& scene) : impl_(std::make_unique<Impl>()) {
    impl_->scene = &scene;
    impl_->bounds = boundsOf(scene);
    const glm::vec3 largest = glm::max(glm::abs(impl_->bounds.lower), glm::abs(impl_->bounds.upper));
    impl_->largestCoordinate = std::max({largest.x, largest.y, largest.z});
    impl_->hasOccluders = std::any_of(scene.polygons.begin(), scene.polygons.end(),
                                      [&](const Polygon& polygon) { return isOccluder(scene, polygon); });
    impl_->device = rtcNewDevice(nullptr);
    if (impl_->device == nullptr)
        throw SystemError(
            fmt::format("Embree does not start (error {})", static_cast<int>(rtcGetDeviceError(nullptr))));
    impl_->embree = rtcNewScene(impl_->device);
    rtcSetSceneFlags(impl_->embree, RTC_SCENE_FLAG_ROBUST); // no ray slips between two polygons
    impl_->attachPolygons();
    // On one thread: a parallel build may order the leaves, and so decide ties on shared edges, differently from run to run.
    // (The device's own "threads" setting would limit oneTBB for the whole program.)
    tbb::task_arena(1).execute([&] { rtcCommitScene(impl_->embree); });
    if (const RTCError error = rtcGetDeviceError(impl_->device); error != RTC_ERROR_NONE)
        throw SystemError(fmt::format("Embree cannot build the scene (error {})", static_cast<int>(error)));
}

RayCaster::~RayCaster() = default;
RayCaster::RayCaster(RayCaster&&) noexcept = default;

std::optional<Hit> RayCaster::closest(const Ray& ray) const {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    RTCRayHit query{};
    query.ray = embreeRay(ray);
    query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    rtcIntersect1(impl_->embree, &context, &query);
    if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID) return std::nullopt;
    const glm::vec3 normal(query.hit.Ng_x, query.hit.Ng_y, query.hit.Ng_z);
    const std::uint32_t polygon = impl_->polygonOf(query.hit.geomID, query.hit.primID);
    const bool front =
        glm::dot(ray.direction, normal) < 0.0F && !isOccluder(*impl_->scene, impl_->scene->polygons[polygon]);
    return Hit{polygon, query.hit.u, query.hit.v, query.ray.tfar, front};
}

void RayCaster::closest(const glm::vec3& origin, RayPacket& packet) const {
    assert(isFinite(origin));
    alignas(64) RTCRayHit16 rays;
    loadOrigin(origin, rays);
    impl_->trace(rays, packet);
}

void RayCaster::closest(const RayOrigins& origins, RayPacket& packet) const {
    alignas(64) RTCRayHit16 rays;
    loadOrigins(origins, rays);
    impl_->trace(rays, packet);
}

bool RayCaster::occluded(const Ray& ray) const {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    RTCRay query = embreeRay(ray);
    rtcOccluded1(impl_->embree, &context, &query);
    return query.tfar < 0.0F;
}

const Scene& RayCaster::scene() const { return *impl_->scene; }
const Bounds& RayCaster::bounds() const { return impl_->bounds; }

float RayCaster::originOffset(float size) const { return 1e-6F * impl_->largestCoordinate + 1e-5F * size; }

} // namespace lambert
