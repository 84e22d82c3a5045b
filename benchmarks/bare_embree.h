#pragma once

#include "scene/scene.h"

#include <embree3/rtcore.h>

#include <cstdint>

namespace lambert {

/// A scene as Embree alone sees it, to compare with.
class BareEmbree {
public:
    /// `filter` sees every hit, if it is given.
    explicit BareEmbree(const Scene& scene, RTCFilterFunctionN filter = nullptr)
        : device_(rtcNewDevice(nullptr)), scene_(rtcNewScene(device_)) {
        rtcSetSceneFlags(scene_, RTC_SCENE_FLAG_ROBUST);
        RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_QUAD);
        auto* indices = static_cast<std::uint32_t*>(
            rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT4, 16, scene.polygons.size()));
        for (const Polygon& polygon : scene.polygons)
            for (std::size_t k = 0; k < 4; ++k) *indices++ = polygon.vertices[polygon.isQuad() || k < 3 ? k : 2];
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

private:
    RTCDevice device_;
    RTCScene scene_;
};

} // namespace lambert
