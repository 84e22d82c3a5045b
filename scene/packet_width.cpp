#include "scene/packet_width.h"

#include "core/error.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <cstdlib>
#include <cstring>

namespace lambert {

namespace {

/// rtcIntersect16 in packets of `Width`, by `trace(active, narrow)`. Embree's packets are arrays of numbers of four bytes, one array
/// for each member of a ray and its hit.
template <typename Narrow, int Width, typename Trace>
void intersectNarrow(const int* active, RTCRayHit16& rays, Trace trace) {
    constexpr std::size_t kTfar = 8;   // its place among the members
    constexpr std::size_t kHit = 12;   // that of the first of a hit
    constexpr std::size_t kCount = 20; // of all
    static_assert(sizeof(Narrow) == 4 * kCount * Width && sizeof(RTCRayHit16) == 4 * kCount * 16);
    static_assert(offsetof(Narrow, hit) == 4 * kHit * Width && offsetof(RTCRayHit16, hit) == 4 * kHit * 16);
    static_assert(offsetof(RTCRay16, tfar) == 4 * kTfar * 16);
    constexpr std::size_t kBytes = 4 * Width;
    alignas(64) Narrow narrow;
    for (int first = 0; first < 16; first += Width) {
        auto* all = reinterpret_cast<std::byte*>(&rays) + 4 * first;
        auto* some = reinterpret_cast<std::byte*>(&narrow);
        for (std::size_t k = 0; k < kHit; ++k) std::memcpy(some + k * kBytes, all + k * 64, kBytes);
        std::fill_n(narrow.hit.geomID, Width, RTC_INVALID_GEOMETRY_ID);
        trace(active + first, narrow);
        std::memcpy(all + kTfar * 64, some + kTfar * kBytes, kBytes);
        for (std::size_t k = kHit; k < kCount; ++k) std::memcpy(all + k * 64, some + k * kBytes, kBytes);
    }
}

} // namespace

RTCDevice newEmbreeDevice() {
    const char* configuration = std::getenv(kEmbreeVariable);
    RTCDevice device = rtcNewDevice(configuration);
    if (device == nullptr) {
        const int error = static_cast<int>(rtcGetDeviceError(nullptr));
        throw SystemError(configuration == nullptr ? fmt::format("Embree does not start (error {})", error)
                                                   : fmt::format("Embree does not start with {}={} (error {})",
                                                                 kEmbreeVariable, configuration, error));
    }
    return device;
}

PacketWidth nativeWidth(RTCDevice device) {
    if (rtcGetDeviceProperty(device, RTC_DEVICE_PROPERTY_NATIVE_RAY16_SUPPORTED) != 0) return PacketWidth::Sixteen;
    if (rtcGetDeviceProperty(device, RTC_DEVICE_PROPERTY_NATIVE_RAY8_SUPPORTED) != 0) return PacketWidth::Eight;
    return PacketWidth::Four;
}

void intersectPacket(PacketWidth width, const int* active, RTCScene scene, RTCIntersectContext& context,
                     RTCRayHit16& rays) {
    switch (width) {
    case PacketWidth::Sixteen:
        rtcIntersect16(active, scene, &context, &rays);
        break;
    case PacketWidth::Eight:
        intersectNarrow<RTCRayHit8, 8>(
            active, rays, [&](const int* valid, RTCRayHit8& eight) { rtcIntersect8(valid, scene, &context, &eight); });
        break;
    case PacketWidth::Four:
        intersectNarrow<RTCRayHit4, 4>(
            active, rays, [&](const int* valid, RTCRayHit4& four) { rtcIntersect4(valid, scene, &context, &four); });
        break;
    }
}

} // namespace lambert
