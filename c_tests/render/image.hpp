// What a camera sees: luminance by pixel.
#pragma once

#include <vector>

#include "render/render_scene.hpp"

namespace render {

/// Rec. 709's weights: of linear R, G and B in nt, nt.
inline double luminance(const Rgb& color) { return 0.2126 * color[0] + 0.7152 * color[1] + 0.0722 * color[2]; }

struct Image {
    int width, height;
    std::vector<Rgb> pixels;  // row by row from the top, nt
};

/// In nt. NaN where a pixel is.
double mean_luminance(const Image& image);

/// The geometric mean of the pixels whose luminance is positive and finite, in nt: half the picture may be black. 0 without any.
double log_mean_luminance(const Image& image);

}  // namespace render
