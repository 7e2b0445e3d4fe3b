#include "render/texture.hpp"

#include <algorithm>
#include <cmath>

namespace render {
namespace {

/// The texels on both sides of a coordinate, and the share of the second.
struct Between {
    std::size_t first, second;
    float share;
};

Between between(double coordinate, int size, bool repeats) {
    // Within one period first: whatever the coordinate, the indices below fit an int.
    const double texels = (repeats ? coordinate - std::floor(coordinate) : std::clamp(coordinate, 0.0, 1.0)) * size - 0.5;
    const double lower = std::floor(texels);
    const auto index = [&](int i) { return static_cast<std::size_t>(repeats ? (i + size) % size : std::clamp(i, 0, size - 1)); };
    const int first = static_cast<int>(lower);
    return {index(first), index(first + 1), static_cast<float>(texels - lower)};
}

}  // namespace

Rgb texel_color(const Texture& texture, double u, double v) {
    if (!std::isfinite(u) || !std::isfinite(v)) return {0, 0, 0};
    const Between column = between(u, texture.width, texture.repeats_u), row = between(v, texture.height, texture.repeats_v);
    const auto width = static_cast<std::size_t>(texture.width);
    const auto texel = [&](std::size_t y, std::size_t x) -> const Rgb& { return texture.texels[y * width + x]; };
    Rgb color;
    for (std::size_t channel = 0; channel < 3; ++channel) {
        const float upper =
            std::lerp(texel(row.first, column.first)[channel], texel(row.first, column.second)[channel], column.share);
        const float lower =
            std::lerp(texel(row.second, column.first)[channel], texel(row.second, column.second)[channel], column.share);
        color[channel] = std::lerp(upper, lower, row.share);
    }
    return color;
}

}  // namespace render
