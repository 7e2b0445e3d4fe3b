// Embree's packets of 8 and 16 rays: written from GnomonRays, read into GnomonHits.
#pragma once

#include <embree3/rtcore.h>

#include <cstddef>
#include <limits>
#include <span>
#include <vector>

#include "backend/embree_records.hpp"

namespace harness {

template <std::size_t Width>
struct PacketOf;

template <>
struct PacketOf<8> {
    using Ray = RTCRay8;
    using RayHit = RTCRayHit8;
    static constexpr auto intersect = rtcIntersect8;
    static constexpr auto occluded = rtcOccluded8;
};

template <>
struct PacketOf<16> {
    using Ray = RTCRay16;
    using RayHit = RTCRayHit16;
    static constexpr auto intersect = rtcIntersect16;
    static constexpr auto occluded = rtcOccluded16;
};

template <class PacketRay>
void write_lane(PacketRay& packet, std::size_t lane, const GnomonRay& ray) {
    packet.org_x[lane] = ray.origin[0];
    packet.org_y[lane] = ray.origin[1];
    packet.org_z[lane] = ray.origin[2];
    packet.tnear[lane] = ray.t_min;
    packet.dir_x[lane] = ray.direction[0];
    packet.dir_y[lane] = ray.direction[1];
    packet.dir_z[lane] = ray.direction[2];
    packet.time[lane] = 0;
    packet.tfar[lane] = ray.t_max;
    packet.mask[lane] = every_geometry;
    packet.flags[lane] = 0;
}

/// An interval that holds nothing, for the lanes beyond the last ray.
inline GnomonRay idle_ray() { return {{0, 0, 0}, 1, {1, 0, 0}, 0}; }

template <std::size_t Width>
std::vector<typename PacketOf<Width>::Ray> packet_rays(std::span<const GnomonRay> rays) {
    std::vector<typename PacketOf<Width>::Ray> packets((rays.size() + Width - 1) / Width);
    for (std::size_t i = 0; i < packets.size() * Width; ++i) {
        write_lane(packets[i / Width], i % Width, i < rays.size() ? rays[i] : idle_ray());
    }
    return packets;
}

template <std::size_t Width>
std::vector<typename PacketOf<Width>::RayHit> packet_ray_hits(std::span<const GnomonRay> rays) {
    std::vector<typename PacketOf<Width>::RayHit> packets((rays.size() + Width - 1) / Width);
    for (std::size_t i = 0; i < packets.size() * Width; ++i) {
        auto& [ray, hit] = packets[i / Width];
        write_lane(ray, i % Width, i < rays.size() ? rays[i] : idle_ray());
        hit.geomID[i % Width] = RTC_INVALID_GEOMETRY_ID;
        hit.instID[0][i % Width] = RTC_INVALID_GEOMETRY_ID;
    }
    return packets;
}

template <class PacketRayHit>
GnomonHit read_lane(const PacketRayHit& packet, std::size_t lane) {
    const auto& hit = packet.hit;
    if (hit.geomID[lane] == RTC_INVALID_GEOMETRY_ID) return miss();
    return {packet.ray.tfar[lane], hit.u[lane],      hit.v[lane],      {hit.Ng_x[lane], hit.Ng_y[lane], hit.Ng_z[lane]},
            hit.primID[lane],      hit.geomID[lane], GNOMON_INVALID_ID};
}

}  // namespace harness
