// The edge functions of exact.hpp in double, with what two other computations of them may differ by: the exact one, and the
// f32 one of the FAST and ACCURATE precisions.
#pragma once

#include <array>
#include <cmath>
#include <optional>

#include "oracle/ray_frame.hpp"

namespace harness {

struct EdgeEstimate {
    double value;
    double rounding;  // |value - exact| <= rounding
    double band;      // |exact - dz^2 * the edge function of the f32 coordinates| <= band

    bool sign_is_known() const { return std::abs(value) > rounding; }
    int sign() const { return value > 0 ? 1 : -1; }
    bool in_band() const { return !(std::abs(value) > rounding + band); }
};

/// U, V, W; nothing where neither the exact nor the f32 edge functions can all have one sign. Triangle in the ray's frame.
std::optional<std::array<EdgeEstimate, 3>> estimate_edges(const RayFrame& ray, const Triangle& triangle);

}  // namespace harness
