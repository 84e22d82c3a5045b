#include "scene/rays/packet_width.h"

#include "core/error.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <cstdlib>
#include <cstring>

namespace lambert {

namespace {

// Embree's packets are arrays of numbers of four bytes, one array for each member of a ray and its hit.
constexpr std::size_t kTfar = 8;                         ///< its place among the members
constexpr std::size_t kHit = 12;                         ///< that of the first of a hit
constexpr std::size_t kCount = sizeof(RTCRayHit16) / 64; ///< of all, 20 or 21
static_assert(sizeof(RTCRay16) == 64 * kHit && sizeof(RTCRayHit16) == 64 * kCount);
static_assert(offsetof(RTCRayHit16, hit) == 64 * kHit && offsetof(RTCRay16, tfar) == 64 * kTfar);

/// Members from `first` up to `last` of `Width` rays, from the packet of sixteen or back into it.
template <int Width>
void copyOut(const std::byte* sixteen, std::byte* narrow, std::size_t first, std::size_t last) {
    for (std::size_t k = first; k < last; ++k) std::memcpy(narrow + k * 4 * Width, sixteen + k * 64, 4 * Width);
}
template <int Width>
void copyBack(const std::byte* narrow, std::byte* sixteen, std::size_t first, std::size_t last) {
    for (std::size_t k = first; k < last; ++k) std::memcpy(sixteen + k * 64, narrow + k * 4 * Width, 4 * Width);
}

template <typename Narrow, int Width>
void intersectNarrow(const int* active, RTCScene scene, QueryContext& context, Likeness likeness, RTCRayHit16& rays) {
    static_assert(sizeof(Narrow) == 4 * kCount * Width && offsetof(Narrow, hit) == 4 * kHit * Width);
    alignas(64) Narrow narrow;
    auto* some = reinterpret_cast<std::byte*>(&narrow);
    for (int first = 0; first < 16; first += Width) {
        auto* all = reinterpret_cast<std::byte*>(&rays) + 4 * first;
        copyOut<Width>(all, some, 0, kHit);
        std::fill_n(narrow.hit.geomID, Width, RTC_INVALID_GEOMETRY_ID);
        intersect(active + first, scene, context, likeness, narrow);
        copyBack<Width>(some, all, kTfar, kTfar + 1);
        copyBack<Width>(some, all, kHit, kCount);
    }
}

template <typename Narrow, int Width>
void occludedNarrow(const int* active, RTCScene scene, QueryContext& context, Likeness likeness, RTCRay16& rays) {
    static_assert(sizeof(Narrow) == 4 * kHit * Width);
    alignas(64) Narrow narrow;
    auto* some = reinterpret_cast<std::byte*>(&narrow);
    for (int first = 0; first < 16; first += Width) {
        auto* all = reinterpret_cast<std::byte*>(&rays) + 4 * first;
        copyOut<Width>(all, some, 0, kHit);
        occluded(active + first, scene, context, likeness, narrow);
        copyBack<Width>(some, all, kTfar, kTfar + 1);
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

void intersectPacket(PacketWidth width, const int* active, RTCScene scene, QueryContext& context, Likeness likeness,
                     RTCRayHit16& rays) {
    switch (width) {
    case PacketWidth::Sixteen:
        return intersect(active, scene, context, likeness, rays);
    case PacketWidth::Eight:
        return intersectNarrow<RTCRayHit8, 8>(active, scene, context, likeness, rays);
    case PacketWidth::Four:
        return intersectNarrow<RTCRayHit4, 4>(active, scene, context, likeness, rays);
    }
}

void occludedPacket(PacketWidth width, const int* active, RTCScene scene, QueryContext& context, Likeness likeness,
                    RTCRay16& rays) {
    if (kGathersPackets || width == PacketWidth::Sixteen) return occluded(active, scene, context, likeness, rays);
    if (width == PacketWidth::Eight) return occludedNarrow<RTCRay8, 8>(active, scene, context, likeness, rays);
    occludedNarrow<RTCRay4, 4>(active, scene, context, likeness, rays);
}

} // namespace lambert
