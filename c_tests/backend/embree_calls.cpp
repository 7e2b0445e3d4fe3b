// The ways of asking Embree, one loop each.
#ifdef GNOMON_WITH_EMBREE

#include "backend/embree_calls.hpp"

#include <array>
#include <cstddef>
#include <thread>
#include <vector>

#include "backend/embree_packets.hpp"
#include "backend/embree_records.hpp"
#include "backend/trace_loop.hpp"

namespace harness {
namespace {

constexpr auto coherent = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
constexpr auto incoherent = RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT;

/// Seconds for trace(begin, end) over [0, count), cut into one piece a thread.
template <class Trace>
double time_pieces(std::size_t count, std::uint32_t threads, Trace trace) {
    if (threads <= 1) return timed([&] { trace(std::size_t{0}, count); });
    return timed([&] {
        std::vector<std::jthread> workers;
        for (std::size_t piece = 0; piece < threads; ++piece) {
            workers.emplace_back(trace, count * piece / threads, count * (piece + 1) / threads);
        }
    });
}

/// Lays out one record a ray, times trace(records, begin, end) over them, and reads the answers.
template <class Trace>
double intersect_records(std::span<const GnomonRay> rays, std::span<GnomonHit> hits, std::uint32_t threads, Trace trace) {
    std::vector<RTCRayHit> records(rays.size());
    for (std::size_t i = 0; i < rays.size(); ++i) write_ray_hit(records[i], rays[i]);
    const double seconds =
        time_pieces(records.size(), threads, [&](std::size_t begin, std::size_t end) { trace(records.data(), begin, end); });
    for (std::size_t i = 0; i < rays.size(); ++i) hits[i] = read_hit(records[i]);
    return seconds;
}

template <class Trace>
double occlude_records(std::span<const GnomonRay> rays, std::span<std::uint8_t> occluded, std::uint32_t threads, Trace trace) {
    std::vector<RTCRay> records(rays.size());
    for (std::size_t i = 0; i < rays.size(); ++i) write_ray(records[i], rays[i]);
    const double seconds =
        time_pieces(records.size(), threads, [&](std::size_t begin, std::size_t end) { trace(records.data(), begin, end); });
    for (std::size_t i = 0; i < rays.size(); ++i) occluded[i] = read_occluded(records[i]);
    return seconds;
}

double fresh_intersect(RTCScene scene, std::span<const GnomonRay> rays, std::span<GnomonHit> hits, std::uint32_t) {
    EmbreeContext context;
    return time_each(rays.size(), [scene, &context, rays = rays.data(), hits = hits.data()](std::size_t i) {
        RTCRayHit record;
        write_ray_hit(record, rays[i]);
        rtcIntersect1(scene, &context, &record);
        hits[i] = read_hit(record);
    });
}

double fresh_occluded(RTCScene scene, std::span<const GnomonRay> rays, std::span<std::uint8_t> occluded, std::uint32_t) {
    EmbreeContext context;
    return time_each(rays.size(), [scene, &context, rays = rays.data(), occluded = occluded.data()](std::size_t i) {
        RTCRay record;
        write_ray(record, rays[i]);
        rtcOccluded1(scene, &context, &record);
        occluded[i] = read_occluded(record);
    });
}

double single_intersect(RTCScene scene, std::span<const GnomonRay> rays, std::span<GnomonHit> hits, std::uint32_t threads) {
    return intersect_records(rays, hits, threads, [scene](RTCRayHit* records, std::size_t begin, std::size_t end) {
        EmbreeContext context;
        for (std::size_t i = begin; i < end; ++i) rtcIntersect1(scene, &context, &records[i]);
    });
}

double single_occluded(RTCScene scene, std::span<const GnomonRay> rays, std::span<std::uint8_t> occluded, std::uint32_t threads) {
    return occlude_records(rays, occluded, threads, [scene](RTCRay* records, std::size_t begin, std::size_t end) {
        EmbreeContext context;
        for (std::size_t i = begin; i < end; ++i) rtcOccluded1(scene, &context, &records[i]);
    });
}

template <RTCIntersectContextFlags Coherence>
double stream_intersect(RTCScene scene, std::span<const GnomonRay> rays, std::span<GnomonHit> hits, std::uint32_t threads) {
    return intersect_records(rays, hits, threads, [scene](RTCRayHit* records, std::size_t begin, std::size_t end) {
        EmbreeContext context(Coherence);
        rtcIntersect1M(scene, &context, records + begin, static_cast<unsigned int>(end - begin), sizeof(RTCRayHit));
    });
}

template <RTCIntersectContextFlags Coherence>
double stream_occluded(RTCScene scene, std::span<const GnomonRay> rays, std::span<std::uint8_t> occluded, std::uint32_t threads) {
    return occlude_records(rays, occluded, threads, [scene](RTCRay* records, std::size_t begin, std::size_t end) {
        EmbreeContext context(Coherence);
        rtcOccluded1M(scene, &context, records + begin, static_cast<unsigned int>(end - begin), sizeof(RTCRay));
    });
}

template <std::size_t Width>
constexpr std::array<int, Width> every_lane() {
    std::array<int, Width> valid{};
    valid.fill(-1);
    return valid;
}

template <std::size_t Width, RTCIntersectContextFlags Coherence>
double packet_intersect(RTCScene scene, std::span<const GnomonRay> rays, std::span<GnomonHit> hits, std::uint32_t threads) {
    auto packets = packet_ray_hits<Width>(rays);
    const double seconds = time_pieces(packets.size(), threads, [&](std::size_t begin, std::size_t end) {
        EmbreeContext context(Coherence);
        alignas(64) const auto valid = every_lane<Width>();
        for (std::size_t i = begin; i < end; ++i) PacketOf<Width>::intersect(valid.data(), scene, &context, &packets[i]);
    });
    for (std::size_t i = 0; i < hits.size(); ++i) hits[i] = read_lane(packets[i / Width], i % Width);
    return seconds;
}

template <std::size_t Width, RTCIntersectContextFlags Coherence>
double packet_occluded(RTCScene scene, std::span<const GnomonRay> rays, std::span<std::uint8_t> occluded, std::uint32_t threads) {
    auto packets = packet_rays<Width>(rays);
    const double seconds = time_pieces(packets.size(), threads, [&](std::size_t begin, std::size_t end) {
        EmbreeContext context(Coherence);
        alignas(64) const auto valid = every_lane<Width>();
        for (std::size_t i = begin; i < end; ++i) PacketOf<Width>::occluded(valid.data(), scene, &context, &packets[i]);
    });
    for (std::size_t i = 0; i < occluded.size(); ++i) {
        occluded[i] = packets[i / Width].tfar[i % Width] == -std::numeric_limits<float>::infinity();
    }
    return seconds;
}

constexpr std::array batch_calls = {
    EmbreeCall{"rtcIntersect1", "rtcOccluded1", single_intersect, single_occluded},
    EmbreeCall{"rtcIntersect1M coherent", "rtcOccluded1M coherent", stream_intersect<coherent>, stream_occluded<coherent>},
    EmbreeCall{"rtcIntersect1M", "rtcOccluded1M", stream_intersect<incoherent>, stream_occluded<incoherent>},
    EmbreeCall{"rtcIntersect8 coherent", "rtcOccluded8 coherent", packet_intersect<8, coherent>, packet_occluded<8, coherent>},
    EmbreeCall{"rtcIntersect8", "rtcOccluded8", packet_intersect<8, incoherent>, packet_occluded<8, incoherent>},
    EmbreeCall{"rtcIntersect16 coherent", "rtcOccluded16 coherent", packet_intersect<16, coherent>,
               packet_occluded<16, coherent>},
    EmbreeCall{"rtcIntersect16", "rtcOccluded16", packet_intersect<16, incoherent>, packet_occluded<16, incoherent>},
};

}  // namespace

constexpr EmbreeCall embree_fresh{"rtcIntersect1", "rtcOccluded1", fresh_intersect, fresh_occluded};
constexpr EmbreeCall embree_prefilled = batch_calls[0];

std::span<const EmbreeCall> embree_batch_calls() { return batch_calls; }

}  // namespace harness

#endif
