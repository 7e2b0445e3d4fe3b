// Embree's single-ray records: written from a GnomonRay, read into a GnomonHit.
#pragma once

#include <embree3/rtcore.h>

#include <cstdint>
#include <limits>

#include "backend/trace_loop.hpp"
#include "gnomon.h"

namespace harness {

inline constexpr unsigned int every_geometry = 0xFFFFFFFFu;

inline void write_ray(RTCRay& record, const GnomonRay& ray) {
    store_field(record.org_x, ray.origin[0]);
    store_field(record.org_y, ray.origin[1]);
    store_field(record.org_z, ray.origin[2]);
    store_field(record.tnear, ray.t_min);
    store_field(record.dir_x, ray.direction[0]);
    store_field(record.dir_y, ray.direction[1]);
    store_field(record.dir_z, ray.direction[2]);
    store_field(record.time, 0.0f);
    store_field(record.tfar, ray.t_max);
    store_field(record.mask, every_geometry);
    store_field(record.flags, 0u);
}

inline void write_ray_hit(RTCRayHit& record, const GnomonRay& ray) {
    write_ray(record.ray, ray);
    store_field(record.hit.geomID, RTC_INVALID_GEOMETRY_ID);
    store_field(record.hit.instID[0], RTC_INVALID_GEOMETRY_ID);
}

inline GnomonHit miss() {
    return {std::numeric_limits<float>::infinity(), 0, 0, {0, 0, 0}, GNOMON_INVALID_ID, GNOMON_INVALID_ID, GNOMON_INVALID_ID};
}

inline GnomonHit read_hit(const RTCRayHit& record) {
    const RTCHit& hit = record.hit;
    if (hit.geomID == RTC_INVALID_GEOMETRY_ID) return miss();
    return {record.ray.tfar, hit.u, hit.v, {hit.Ng_x, hit.Ng_y, hit.Ng_z}, hit.primID, hit.geomID, GNOMON_INVALID_ID};
}

/// Embree sets tfar to -inf where something is in the way.
inline bool read_occluded(const RTCRay& record) { return record.tfar == -std::numeric_limits<float>::infinity(); }

/// What a call hands to Embree beside the ray.
struct EmbreeContext : RTCIntersectContext {
    explicit EmbreeContext(RTCIntersectContextFlags coherence = RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT) {
        rtcInitIntersectContext(this);
        flags = coherence;
    }
};

}  // namespace harness
