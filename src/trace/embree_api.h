#pragma once

// Everything that differs between Embree 3 and Embree 4 stands here.
#if __has_include(<embree4/rtcore.h>)
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

namespace heliodon::trace {

inline void embree_intersect(RTCScene scene, RTCRayHit& query) {
#if RTC_VERSION_MAJOR >= 4
    rtcIntersect1(scene, &query);
#else
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    rtcIntersect1(scene, &context, &query);
#endif
}

/// Sets `ray.tfar` to minus infinity where anything lies on the segment.
inline void embree_occluded(RTCScene scene, RTCRay& ray) {
#if RTC_VERSION_MAJOR >= 4
    rtcOccluded1(scene, &ray);
#else
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    rtcOccluded1(scene, &context, &ray);
#endif
}

/// Eight rays at a time, those that are −1 in `valid`; otherwise as the single ones.
inline void embree_intersect(RTCScene scene, const int* valid, RTCRayHit8& queries) {
#if RTC_VERSION_MAJOR >= 4
    rtcIntersect8(valid, scene, &queries);
#else
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    rtcIntersect8(valid, scene, &context, &queries);
#endif
}
inline void embree_occluded(RTCScene scene, const int* valid, RTCRay8& rays) {
#if RTC_VERSION_MAJOR >= 4
    rtcOccluded8(valid, scene, &rays);
#else
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    rtcOccluded8(valid, scene, &context, &rays);
#endif
}

/// A geometry inside an instance answers every ray mask; the instance's own mask decides. (Embree 3 starts
/// geometries with all bits set, Embree 4 with the lowest one.)
inline void embree_answer_every_mask(RTCGeometry geometry) {
    rtcSetGeometryMask(geometry, 0xffffffffu);
}

}  // namespace heliodon::trace
