#include "render/image.hpp"

#include <cmath>
#include <cstddef>

namespace render {

double mean_luminance(const Image& image) {
    double sum = 0;
    for (const Rgb& pixel : image.pixels) sum += luminance(pixel);
    return image.pixels.empty() ? 0 : sum / double(image.pixels.size());
}

double log_mean_luminance(const Image& image) {
    double sum = 0;
    std::size_t count = 0;
    for (const Rgb& pixel : image.pixels) {
        const double nits = luminance(pixel);
        if (!(nits > 0 && std::isfinite(nits))) continue;
        sum += std::log(nits);
        ++count;
    }
    return count == 0 ? 0 : std::exp(sum / double(count));
}

}  // namespace render
