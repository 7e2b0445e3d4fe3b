// From nits to what a screen can show.
#pragma once

#include "render/image.hpp"
#include "render/png.hpp"

namespace render {

/// The exposure value at ISO 100 with which a light meter takes a scene of this mean luminance (ISO 2720, K = 12.5).
double exposure_of(double mean_nt);

/// What a camera's automatic would choose: by the log mean luminance. 0 for a picture without light.
double automatic_exposure(const Image& image);

/// The photographic operator of Reinhard, Stark, Shirley and Ferwerda 2002 on luminance, colours kept: what the meter takes for
/// the mean becomes middle grey, and the brightest pixels white, unless they are below that mean. A channel beyond the screen's
/// is clamped.
Picture tone_mapped(const Image& image, double exposure_ev100);

}  // namespace render
