#pragma once

#include "scene/rays/embree.h"

#include <cmath>
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

/// Traces sixteen rays in packets of `width`. `active`: -1 for rays to be traced, 0 for none. Packets that Embree has to gather (see
/// kGathersPackets) know no such mask: what leaves a ray out of them is a tnear beyond its tfar, which beginRays() provides.
void intersectPacket(PacketWidth width, const int* active, RTCScene scene, QueryContext& context, Likeness likeness,
                     RTCRayHit16& rays);

/// The same of shadow rays: those that meet something get a tfar below 0. Where Embree gathers packets they stay together: nothing
/// but tfar comes back, and no width is faster.
void occludedPacket(PacketWidth width, const int* active, RTCScene scene, QueryContext& context, Likeness likeness,
                    RTCRay16& rays);

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

/// Debian's Embree aborts the program for a ray with a coordinate beyond this one, or that is no number.
inline constexpr float kLargestCoordinate = 1.8e18F;

inline bool isTraceable(float orgX, float orgY, float orgZ, float dirX, float dirY, float dirZ) {
    const auto fits = [](float x) { return std::abs(x) <= kLargestCoordinate; }; // false if it is no number
    return fits(orgX) & fits(orgY) & fits(orgZ) & fits(dirX) & fits(dirY) & fits(dirZ);
}

/// Lets a ray that Embree would abort for begin beyond its end. For when all else of it is set.
inline void leaveOutUntraceable(RTCRay& ray) {
    if (isTraceable(ray.org_x, ray.org_y, ray.org_z, ray.dir_x, ray.dir_y, ray.dir_z)) return;
    ray.org_x = ray.org_y = ray.org_z = ray.dir_x = ray.dir_y = ray.dir_z = 0.0F;
    ray.tnear = std::numeric_limits<float>::infinity();
}

/// The same of sixteen rays; hardly any time where there is none such.
inline void leaveOutUntraceable(RTCRay16& rays) {
    int left = 0;
    for (unsigned lane = 0; lane < 16; ++lane)
        left |= isTraceable(rays.org_x[lane], rays.org_y[lane], rays.org_z[lane], rays.dir_x[lane], rays.dir_y[lane],
                            rays.dir_z[lane])
                    ? 0
                    : 1;
    if (left == 0) [[likely]]
        return;
    for (unsigned lane = 0; lane < 16; ++lane) {
        RTCRay ray = rtcGetRayFromRayN(reinterpret_cast<RTCRayN*>(&rays), 16, lane);
        leaveOutUntraceable(ray);
        rays.org_x[lane] = ray.org_x;
        rays.org_y[lane] = ray.org_y;
        rays.org_z[lane] = ray.org_z;
        rays.dir_x[lane] = ray.dir_x;
        rays.dir_y[lane] = ray.dir_y;
        rays.dir_z[lane] = ray.dir_z;
        rays.tnear[lane] = ray.tnear;
    }
}

} // namespace lambert
