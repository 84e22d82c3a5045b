#pragma once

#include "scene/rays/packet_width.h"
#include "scene/scene.h"

#include <cstdint>

namespace lambert {

/// Calls `f` with a null pointer to Embree's packet of that many rays, whose type is what `f` is to know.
template <typename F>
auto withPacketOf(PacketWidth width, F f) {
    if (width == PacketWidth::Sixteen) return f(static_cast<RTCRayHit16*>(nullptr));
    if (width == PacketWidth::Eight) return f(static_cast<RTCRayHit8*>(nullptr));
    return f(static_cast<RTCRayHit4*>(nullptr));
}

/// A scene as Embree alone sees it, to compare with.
class BareEmbree {
public:
    /// `filter` sees every hit, if it is given.
    explicit BareEmbree(const Scene& scene, RTCFilterFunctionN filter = nullptr)
        : device_(newEmbreeDevice()), scene_(rtcNewScene(device_)) {
        rtcSetSceneFlags(scene_, RTC_SCENE_FLAG_ROBUST);
        RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
        std::size_t quads = 0;
        for (const Polygon& polygon : scene.polygons) quads += polygon.isQuad() ? 1 : 0;
        auto* indices = static_cast<std::uint32_t*>(rtcSetNewGeometryBuffer(
            geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 12, scene.polygons.size() + quads));
        for (const Polygon& polygon : scene.polygons) {
            const auto& v = polygon.vertices;
            for (const std::uint32_t vertex : {v[0], v[1], v[polygon.isQuad() ? 3 : 2]}) *indices++ = vertex;
            if (!polygon.isQuad()) continue;
            for (const std::uint32_t vertex : {v[2], v[3], v[1]}) *indices++ = vertex;
        }
        auto* vertices = static_cast<float*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0,
                                                                     RTC_FORMAT_FLOAT3, 12, scene.positions.size()));
        for (const glm::vec3& p : scene.positions)
            for (int axis = 0; axis < 3; ++axis) *vertices++ = p[axis];
        rtcSetGeometryOccludedFilterFunction(geometry, filter);
        rtcCommitGeometry(geometry);
        rtcAttachGeometry(scene_, geometry);
        rtcReleaseGeometry(geometry);
        rtcCommitScene(scene_);
    }
    ~BareEmbree() {
        rtcReleaseScene(scene_);
        rtcReleaseDevice(device_);
    }
    BareEmbree(const BareEmbree&) = delete;
    BareEmbree& operator=(const BareEmbree&) = delete;

    RTCScene handle() const { return scene_; }
    PacketWidth width() const { return nativeWidth(device_); }

private:
    RTCDevice device_;
    RTCScene scene_;
};

} // namespace lambert
