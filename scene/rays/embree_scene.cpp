#include "scene/rays/embree_scene.h"

#include "core/error.h"
#include "scene/surface.h"

#include <fmt/format.h>
#include <glm/common.hpp>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>

namespace lambert {

namespace {

float largestCoordinate(const Bounds& bounds) {
    const glm::vec3 largest = glm::max(glm::abs(bounds.lower), glm::abs(bounds.upper));
    return std::max({largest.x, largest.y, largest.z});
}

/// A power of two by which the largest coordinate comes to lie in [1/2, 1).
float scaleToOne(const Bounds& bounds) {
    int exponent = 0;
    std::frexp(largestCoordinate(bounds), &exponent);
    return std::ldexp(1.0F, std::clamp(-exponent, -120, 120));
}

RTCGeometry triangleGeometry(RTCDevice device, const Scene& scene, std::span<const std::uint32_t> halves, float scale) {
    RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
    auto* indices = static_cast<std::uint32_t*>(rtcSetNewGeometryBuffer(
        geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 3 * sizeof(std::uint32_t), halves.size()));
    auto* vertices = static_cast<float*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                                                 3 * sizeof(float), scene.positions.size()));
    if (indices == nullptr || vertices == nullptr) throw SystemError("not enough memory for the ray caster");
    for (const std::uint32_t half : halves) {
        const Polygon& polygon = scene.polygons[half >> 1U];
        const auto& v = polygon.vertices;
        const std::array first{v[0], v[1], v[polygon.isQuad() ? 3 : 2]};
        const std::array second{v[2], v[3], v[1]};
        indices = std::copy_n(((half & 1U) == 0 ? first : second).begin(), 3, indices);
    }
    for (const glm::vec3& position : scene.positions) {
        // Unused vertices may be anything in the file; Embree must not see them.
        const glm::vec3 p = isFinite(position) ? scale * position : glm::vec3(0.0F);
        vertices = std::copy_n(std::array{p.x, p.y, p.z}.begin(), 3, vertices);
    }
    return geometry;
}

} // namespace

EmbreeScene::EmbreeScene(const Scene& scene, const Filters& filters)
    : scale_(scaleToOne(boundsOf(scene))), device_(newEmbreeDevice()), width_(nativeWidth(device_.get())) {
    embree_.reset(rtcNewScene(device_.get()));
    rtcSetSceneFlags(handle(), RTC_SCENE_FLAG_ROBUST); // no ray slips between two polygons
    std::vector<std::uint32_t> withHoles;
    for (std::uint32_t i = 0; i < scene.polygons.size(); ++i) {
        std::vector<std::uint32_t>& list = hasHoles(scene, scene.polygons[i]) ? withHoles : halves_;
        list.push_back(2 * i);
        if (scene.polygons[i].isQuad()) list.push_back(2 * i + 1);
    }
    const std::size_t opaque = halves_.size();
    halves_.insert(halves_.end(), withHoles.begin(), withHoles.end());
    bool needed = false;
    for (std::uint32_t k = 0; k < halves_.size(); ++k) needed |= halves_[k] != k;
    for (GeometryData& data : data_) data = {&scene, {needed ? halves_.data() : nullptr}, 0};
    data_[kWithHoles].first = static_cast<std::uint32_t>(opaque);
    attach(kOpaque, std::span(halves_).first(opaque), filters.opaque);
    attach(kWithHoles, std::span(halves_).subspan(opaque), filters.withHoles);
    if (!needed) halves_ = {};
    // On one thread: a parallel build may order the leaves, and so decide ties on shared edges, differently from run to run.
    // (The device's own "threads" setting would limit oneTBB for the whole program.)
    tbb::task_arena(1).execute([&] { rtcCommitScene(handle()); });
    if (const RTCError error = rtcGetDeviceError(device_.get()); error != RTC_ERROR_NONE)
        throw SystemError(fmt::format("Embree cannot build the scene (error {})", static_cast<int>(error)));
}

void EmbreeScene::attach(GeometryId id, std::span<const std::uint32_t> halves, RTCFilterFunctionN filter) {
    if (halves.empty()) return;
    RTCGeometry geometry = triangleGeometry(device_.get(), *data_[id].scene, halves, scale_);
    rtcSetGeometryUserData(geometry, &data_[id]);
    rtcSetGeometryIntersectFilterFunction(geometry, filter);
    rtcSetGeometryOccludedFilterFunction(geometry, filter);
    rtcCommitGeometry(geometry);
    rtcAttachGeometryByID(handle(), geometry, id);
    rtcReleaseGeometry(geometry);
}

bool liesInHole(const RTCFilterFunctionNArguments& query, unsigned lane) {
    const auto& data = *static_cast<const GeometryData*>(query.geometryUserPtr);
    const PolygonHit hit = data.triangles.hit(data.first + RTCHitN_primID(query.hit, query.N, lane),
                                              RTCHitN_u(query.hit, query.N, lane), RTCHitN_v(query.hit, query.N, lane));
    return isHole(*data.scene, data.scene->polygons[hit.polygon], hit.u, hit.v);
}

float coordinateTolerance(const Bounds& bounds) { return 1e-6F * largestCoordinate(bounds); }

bool hasOccluders(const Scene& scene) {
    return std::any_of(scene.polygons.begin(), scene.polygons.end(),
                       [&](const Polygon& polygon) { return isOccluder(scene, polygon); });
}

} // namespace lambert
