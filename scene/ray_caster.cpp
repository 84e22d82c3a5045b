#include "scene/ray_caster.h"

#include "core/error.h"
#include "core/vector_clones.h"

#include <embree3/rtcore.h>
#include <fmt/format.h>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <span>

namespace lambert {

namespace {

/// The two geometries of the Embree scene.
enum GeometryId : unsigned { kTriangles = 0, kQuads = 1 };

bool isFinite(const glm::vec3& v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

void attachPolygons(RTCDevice device, RTCScene target, const Scene& scene, std::span<const std::uint32_t> ids,
                    GeometryId geometryId) {
    if (ids.empty()) return;
    const bool quads = geometryId == kQuads;
    RTCGeometry geometry = rtcNewGeometry(device, quads ? RTC_GEOMETRY_TYPE_QUAD : RTC_GEOMETRY_TYPE_TRIANGLE);
    const std::size_t corners = quads ? 4 : 3;
    auto* indices = static_cast<std::uint32_t*>(rtcSetNewGeometryBuffer(
        geometry, RTC_BUFFER_TYPE_INDEX, 0, quads ? RTC_FORMAT_UINT4 : RTC_FORMAT_UINT3, corners * 4, ids.size()));
    auto* vertices = static_cast<float*>(rtcSetNewGeometryBuffer(
        geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 3 * sizeof(float), scene.positions.size()));
    if (indices == nullptr || vertices == nullptr) throw SystemError("not enough memory for the ray caster");
    for (std::size_t i = 0; i < ids.size(); ++i)
        std::copy_n(scene.polygons[ids[i]].vertices.data(), corners, indices + corners * i);
    for (std::size_t i = 0; i < scene.positions.size(); ++i) {
        // Unused vertices may be anything in the file; Embree must not see them.
        const glm::vec3 p = isFinite(scene.positions[i]) ? scene.positions[i] : glm::vec3(0.0F);
        vertices[3 * i] = p.x;
        vertices[3 * i + 1] = p.y;
        vertices[3 * i + 2] = p.z;
    }
    rtcCommitGeometry(geometry);
    rtcAttachGeometryByID(target, geometry, geometryId);
    rtcReleaseGeometry(geometry);
}

LAMBERT_VECTOR_CLONES
void load(const glm::vec3& origin, const RayPacket& packet, RTCRayHit16& rays) {
    for (int lane = 0; lane < RayPacket::kSize; ++lane) {
        rays.ray.org_x[lane] = origin.x;
        rays.ray.org_y[lane] = origin.y;
        rays.ray.org_z[lane] = origin.z;
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

/// `polygonOf` holds the polygons of all triangles, then, from `firstQuad`, of all quads.
LAMBERT_VECTOR_CLONES
void store(const RTCRayHit16& rays, const std::uint32_t* polygonOf, std::uint32_t firstQuad, RayPacket& packet) {
    for (int lane = 0; lane < RayPacket::kSize; ++lane) {
        packet.facing[lane] = rays.ray.dir_x[lane] * rays.hit.Ng_x[lane] + rays.ray.dir_y[lane] * rays.hit.Ng_y[lane] +
                              rays.ray.dir_z[lane] * rays.hit.Ng_z[lane];
        packet.u[lane] = rays.hit.u[lane];
        packet.v[lane] = rays.hit.v[lane];
        const bool hit = rays.hit.geomID[lane] != RTC_INVALID_GEOMETRY_ID;
        const std::uint32_t primitive = rays.hit.primID[lane] + (rays.hit.geomID[lane] == kQuads ? firstQuad : 0);
        const std::uint32_t polygon = polygonOf[hit ? primitive : 0];
        packet.polygon[lane] = hit ? polygon : kNone;
    }
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
    RTCDevice device = nullptr;
    RTCScene embree = nullptr;
    std::vector<std::uint32_t> polygonOf; ///< of each triangle, then of each quad that Embree has
    std::uint32_t firstQuad = 0;

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
    for (const bool quads : {false, true}) {
        if (quads) impl_->firstQuad = static_cast<std::uint32_t>(impl_->polygonOf.size());
        for (std::uint32_t i = 0; i < scene.polygons.size(); ++i)
            if (scene.polygons[i].isQuad() == quads) impl_->polygonOf.push_back(i);
    }

    impl_->device = rtcNewDevice(nullptr);
    if (impl_->device == nullptr)
        throw SystemError(fmt::format("Embree does not start (error {})", static_cast<int>(rtcGetDeviceError(nullptr))));
    impl_->embree = rtcNewScene(impl_->device);
    rtcSetSceneFlags(impl_->embree, RTC_SCENE_FLAG_ROBUST); // no ray slips between two polygons
    const std::span<const std::uint32_t> polygons(impl_->polygonOf);
    attachPolygons(impl_->device, impl_->embree, scene, polygons.first(impl_->firstQuad), kTriangles);
    attachPolygons(impl_->device, impl_->embree, scene, polygons.subspan(impl_->firstQuad), kQuads);
    if (impl_->polygonOf.empty()) impl_->polygonOf.push_back(kNone); // read, not used, where a ray hits nothing
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
    const std::uint32_t primitive = query.hit.primID + (query.hit.geomID == kQuads ? impl_->firstQuad : 0);
    return Hit{impl_->polygonOf[primitive], query.hit.u, query.hit.v, query.ray.tfar,
               glm::dot(ray.direction, normal) < 0.0F};
}

void RayCaster::closest(const glm::vec3& origin, RayPacket& packet) const {
    assert(isFinite(origin));
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
    alignas(64) RTCRayHit16 rays;
    load(origin, packet, rays);
    rtcIntersect16(packet.active, impl_->embree, &context, &rays);
    store(rays, impl_->polygonOf.data(), impl_->firstQuad, packet);
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
