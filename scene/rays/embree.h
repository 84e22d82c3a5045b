#pragma once

// Embree 3, as Debian 12 has it, or 4, as Debian 13 has it: what differs between them, in one place. What is common to both keeps
// its name.

#if __has_include(<embree4/rtcore.h>)
#define LAMBERT_EMBREE_4
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

namespace lambert {

/// Whether the rays of a query are alike in origin or direction.
enum class Likeness { None, Coherent };

#ifdef LAMBERT_EMBREE_4

/// What a filter gets of a query, as `context`; at the beginning of whatever else it is to know.
using QueryContext = RTCRayQueryContext;

/// Packets wider than the processor's own are traced ray by ray.
inline constexpr bool kGathersPackets = false;

inline void beginQuery(QueryContext& context) { rtcInitRayQueryContext(&context); }

namespace detail {

inline RTCIntersectArguments intersectArguments(QueryContext& context, Likeness likeness) {
    RTCIntersectArguments arguments;
    rtcInitIntersectArguments(&arguments);
    arguments.context = &context;
    arguments.flags = likeness == Likeness::Coherent ? RTC_RAY_QUERY_FLAG_COHERENT : RTC_RAY_QUERY_FLAG_INCOHERENT;
    return arguments;
}

inline RTCOccludedArguments occludedArguments(QueryContext& context, Likeness likeness) {
    RTCOccludedArguments arguments;
    rtcInitOccludedArguments(&arguments);
    arguments.context = &context;
    arguments.flags = likeness == Likeness::Coherent ? RTC_RAY_QUERY_FLAG_COHERENT : RTC_RAY_QUERY_FLAG_INCOHERENT;
    return arguments;
}

} // namespace detail

inline void intersect(RTCScene scene, QueryContext& context, RTCRayHit& ray) {
    RTCIntersectArguments arguments = detail::intersectArguments(context, Likeness::None);
    rtcIntersect1(scene, &ray, &arguments);
}
inline void occluded(RTCScene scene, QueryContext& context, RTCRay& ray) {
    RTCOccludedArguments arguments = detail::occludedArguments(context, Likeness::None);
    rtcOccluded1(scene, &ray, &arguments);
}

// `active`: -1 for rays to be traced, 0 for none.
inline void intersect(const int* active, RTCScene scene, QueryContext& context, Likeness likeness, RTCRayHit4& rays) {
    RTCIntersectArguments arguments = detail::intersectArguments(context, likeness);
    rtcIntersect4(active, scene, &rays, &arguments);
}
inline void intersect(const int* active, RTCScene scene, QueryContext& context, Likeness likeness, RTCRayHit8& rays) {
    RTCIntersectArguments arguments = detail::intersectArguments(context, likeness);
    rtcIntersect8(active, scene, &rays, &arguments);
}
inline void intersect(const int* active, RTCScene scene, QueryContext& context, Likeness likeness, RTCRayHit16& rays) {
    RTCIntersectArguments arguments = detail::intersectArguments(context, likeness);
    rtcIntersect16(active, scene, &rays, &arguments);
}
inline void occluded(const int* active, RTCScene scene, QueryContext& context, Likeness likeness, RTCRay4& rays) {
    RTCOccludedArguments arguments = detail::occludedArguments(context, likeness);
    rtcOccluded4(active, scene, &rays, &arguments);
}
inline void occluded(const int* active, RTCScene scene, QueryContext& context, Likeness likeness, RTCRay8& rays) {
    RTCOccludedArguments arguments = detail::occludedArguments(context, likeness);
    rtcOccluded8(active, scene, &rays, &arguments);
}
inline void occluded(const int* active, RTCScene scene, QueryContext& context, Likeness likeness, RTCRay16& rays) {
    RTCOccludedArguments arguments = detail::occludedArguments(context, likeness);
    rtcOccluded16(active, scene, &rays, &arguments);
}

#else

/// What a filter gets of a query, as `context`; at the beginning of whatever else it is to know.
using QueryContext = RTCIntersectContext;

/// Packets wider than the processor's own are gathered into those, without a look at which of their rays are active: what leaves a
/// ray out is a tnear beyond its tfar.
inline constexpr bool kGathersPackets = true;

inline void beginQuery(QueryContext& context) { rtcInitIntersectContext(&context); }

namespace detail {

inline RTCIntersectContext* with(QueryContext& context, Likeness likeness) {
    context.flags =
        likeness == Likeness::Coherent ? RTC_INTERSECT_CONTEXT_FLAG_COHERENT : RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT;
    return &context;
}

} // namespace detail

inline void intersect(RTCScene scene, QueryContext& context, RTCRayHit& ray) {
    rtcIntersect1(scene, detail::with(context, Likeness::None), &ray);
}
inline void occluded(RTCScene scene, QueryContext& context, RTCRay& ray) {
    rtcOccluded1(scene, detail::with(context, Likeness::None), &ray);
}

// `active`: -1 for rays to be traced, 0 for none.
inline void intersect(const int* active, RTCScene scene, QueryContext& context, Likeness likeness, RTCRayHit4& rays) {
    rtcIntersect4(active, scene, detail::with(context, likeness), &rays);
}
inline void intersect(const int* active, RTCScene scene, QueryContext& context, Likeness likeness, RTCRayHit8& rays) {
    rtcIntersect8(active, scene, detail::with(context, likeness), &rays);
}
inline void intersect(const int* active, RTCScene scene, QueryContext& context, Likeness likeness, RTCRayHit16& rays) {
    rtcIntersect16(active, scene, detail::with(context, likeness), &rays);
}
inline void occluded(const int* active, RTCScene scene, QueryContext& context, Likeness likeness, RTCRay4& rays) {
    rtcOccluded4(active, scene, detail::with(context, likeness), &rays);
}
inline void occluded(const int* active, RTCScene scene, QueryContext& context, Likeness likeness, RTCRay8& rays) {
    rtcOccluded8(active, scene, detail::with(context, likeness), &rays);
}
inline void occluded(const int* active, RTCScene scene, QueryContext& context, Likeness likeness, RTCRay16& rays) {
    rtcOccluded16(active, scene, detail::with(context, likeness), &rays);
}

#endif

} // namespace lambert
