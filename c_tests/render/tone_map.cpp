#include "render/tone_map.hpp"

#include <algorithm>
#include <cmath>

namespace render {

namespace {

constexpr double meter_constant = 12.5;  // ISO 2720: L = 2^EV K / S
constexpr double film_speed = 100;
constexpr double middle_grey = 0.18;

double mean_of_exposure(double exposure_ev100) { return std::exp2(exposure_ev100) * meter_constant / film_speed; }

/// The luminance that only one pixel in a thousand surpasses: single fireflies do not decide about the picture.
double brightest(const Image& image) {
    std::vector<double> nits;
    for (const Rgb& pixel : image.pixels)
        if (std::isfinite(luminance(pixel))) nits.push_back(luminance(pixel));
    if (nits.empty()) return 0;
    const auto place = nits.begin() + static_cast<std::ptrdiff_t>(nits.size() - 1 - nits.size() / 1000);
    std::nth_element(nits.begin(), place, nits.end());
    return *place;
}

}  // namespace

double exposure_of(double mean_nt) { return std::log2(mean_nt * film_speed / meter_constant); }

double automatic_exposure(const Image& image) {
    const double mean = log_mean_luminance(image);
    return mean > 0 ? exposure_of(mean) : 0;
}

Picture tone_mapped(const Image& image, double exposure_ev100) {
    const double scale = middle_grey / mean_of_exposure(exposure_ev100);
    // Not below what the meter takes for the mean: a picture that a given exposure leaves dim stays dim.
    const double white = std::max(middle_grey, scale * brightest(image));
    Picture picture{image.width, image.height, {}};
    picture.pixels.reserve(image.pixels.size());
    for (const Rgb& pixel : image.pixels) {
        const double exposed = scale * luminance(pixel);
        const double gain = scale * (1 + exposed / (white * white)) / (1 + exposed);
        picture.pixels.push_back({to_srgb(gain * pixel[0]), to_srgb(gain * pixel[1]), to_srgb(gain * pixel[2])});
    }
    return picture;
}

}  // namespace render
