// The ways of asking Embree: each lays out Embree's records, traces them, and reads the answers; only the tracing is timed.
#pragma once

#include <embree3/rtcore.h>

#include <cstdint>
#include <span>
#include <string_view>

#include "gnomon.h"

namespace harness {

/// A function of Embree and how to ask it. Both members return the seconds spent tracing.
struct EmbreeCall {
    std::string_view intersect_name, occluded_name;
    double (*intersect)(RTCScene, std::span<const GnomonRay>, std::span<GnomonHit>, std::uint32_t threads);
    double (*occluded)(RTCScene, std::span<const GnomonRay>, std::span<std::uint8_t>, std::uint32_t threads);
};

extern const EmbreeCall embree_fresh, embree_prefilled;

/// Everything that takes many rays, and the single call over prefilled records: which is fastest depends on the rays.
std::span<const EmbreeCall> embree_batch_calls();

}  // namespace harness
