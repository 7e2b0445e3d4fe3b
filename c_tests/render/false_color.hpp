// Luminance as colour, with a legend to read it off.
#pragma once

#include "render/image.hpp"
#include "render/png.hpp"

namespace render {

struct LuminanceRange {
    double lower_nt, upper_nt;  // 0 < lower < upper
};

/// Of the luminances but for the outermost thousandth at either end, widened to 1, 2 or 5 times a power of ten; at most six
/// decades below its upper end. From 1 to 10 nt for a picture without light.
LuminanceRange luminance_range(const Image& image);

/// Viridis (Smith and van der Walt 2015, in matplotlib): brightness grows evenly along it, and colour-blind eyes can read it.
/// Of `share` in [0, 1]; beyond, its end.
Srgb viridis(double share);

/// Viridis over the logarithm of the luminance; black where there is no light or NaN.
Srgb false_color(double luminance_nt, const LuminanceRange& range);

/// The picture in false colours, and to the right of it the scale, labelled in nt.
Picture false_colored(const Image& image);

}  // namespace render
