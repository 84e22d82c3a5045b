#pragma once

#include <embree3/rtcore.h>

#include <limits>

namespace lambert {

/// How many rays at once Embree's kernels on a processor take.
enum class PacketWidth { Four = 4, Eight = 8, Sixteen = 16 };

/// The environment variable whose value every Embree device of the program gets as its configuration, so that one machine can show
/// what others do: LAMBERT_EMBREE=isa=avx2, see docs/processors.md.
inline constexpr const char* kEmbreeVariable = "LAMBERT_EMBREE";

/// A new device, configured by kEmbreeVariable; its owner releases it. Throws SystemError.
RTCDevice newEmbreeDevice();

/// The widest packets that a device traces with kernels of its own. Embree gathers wider ones into these.
PacketWidth nativeWidth(RTCDevice device);

/// rtcIntersect16 in packets of `width`. `active`: -1 for rays to be traced, 0 for none. Packets that Embree has to gather, here and
/// in rtcOccluded16, know no such mask: what leaves a ray out of them is a tnear beyond its tfar, which beginRays() provides.
///
/// Shadow rays always go to rtcOccluded16: of what is gathered for them nothing but tfar comes back, and no width is faster.
void intersectPacket(PacketWidth width, const int* active, RTCScene scene, RTCIntersectContext& context,
                     RTCRayHit16& rays);

/// All but origins and directions of rays that end after `length` of their directions and meet everything on the way. Rays that are
/// not active begin beyond any end.
inline void beginRays(const int* active, float length, RTCRay16& rays) {
    for (unsigned lane = 0; lane < 16; ++lane) {
        rays.tnear[lane] = active[lane] != 0 ? 0.0F : std::numeric_limits<float>::infinity();
        rays.tfar[lane] = length;
        rays.time[lane] = 0.0F;
        rays.mask[lane] = ~0U;
        rays.id[lane] = lane;
        rays.flags[lane] = 0;
    }
}

/// The same of rays without end, and that they have not met anything.
inline void beginRays(const int* active, RTCRayHit16& rays) {
    beginRays(active, 1e30F, rays.ray);
    for (unsigned& geometry : rays.hit.geomID) geometry = RTC_INVALID_GEOMETRY_ID;
}

} // namespace lambert
