// Light channel by channel.
#pragma once

#include <algorithm>

#include "rays/vector.hpp"
#include "render/render_scene.hpp"

namespace render {

using harness::operator*;  // beside those below, which would hide it

inline Rgb operator*(float s, const Rgb& a) { return {s * a[0], s * a[1], s * a[2]}; }
inline Rgb operator*(const Rgb& a, const Rgb& b) { return {a[0] * b[0], a[1] * b[1], a[2] * b[2]}; }
inline Rgb& operator+=(Rgb& a, const Rgb& b) {
    for (std::size_t channel = 0; channel < 3; ++channel) a[channel] += b[channel];
    return a;
}
inline float largest(const Rgb& a) { return std::max({a[0], a[1], a[2]}); }

}  // namespace render
