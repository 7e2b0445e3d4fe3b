#include "render/false_color.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "render/text.hpp"

namespace render {

namespace {

/// Every fifteenth of matplotlib's 256 colours (_cm_listed.py, CC0); between them a straight line is within 0.02.
constexpr double viridis_table[][3] = {
    {0.267004, 0.004874, 0.329415}, {0.281924, 0.089666, 0.412415}, {0.280255, 0.165693, 0.476498},
    {0.263663, 0.237631, 0.518762}, {0.237441, 0.305202, 0.541921}, {0.208623, 0.367752, 0.552675},
    {0.182256, 0.426184, 0.557120}, {0.159194, 0.482237, 0.558073}, {0.137770, 0.537492, 0.554906},
    {0.121148, 0.592739, 0.544641}, {0.128087, 0.647749, 0.523491}, {0.180653, 0.701402, 0.488189},
    {0.274149, 0.751988, 0.436601}, {0.395174, 0.797475, 0.367757}, {0.535621, 0.835785, 0.281908},
    {0.688944, 0.865448, 0.182725}, {0.845561, 0.887322, 0.099702}, {0.993248, 0.906157, 0.143936}};

constexpr double most_decades = 6;
constexpr Srgb paper{255, 255, 255}, ink{0, 0, 0}, darkness{0, 0, 0};

/// 1, 2 and 5 times each power of ten.
double preferred_number(int index) {
    constexpr double within_decade[] = {1, 2, 5};
    const int decade = index >= 0 ? index / 3 : -((2 - index) / 3);
    return within_decade[index - 3 * decade] * std::pow(10, decade);
}

/// Of the largest preferred number that is not above `x`. The factor forgives the rounding of pow.
int preferred_index_below(double x) {
    int index = 3 * static_cast<int>(std::floor(std::log10(x))) - 1;
    while (preferred_number(index + 1) <= x * (1 + 1e-12)) ++index;
    return index;
}

/// Its place in [0, 1] on the logarithmic scale.
double place(double luminance_nt, const LuminanceRange& range) {
    return std::log(luminance_nt / range.lower_nt) / std::log(range.upper_nt / range.lower_nt);
}

std::string label(double nits) {
    char text[32];
    std::snprintf(text, sizeof text, nits < 1e6 && nits >= 1e-3 ? "%.6g nt" : "%.0e nt", nits);
    return text;
}

/// The bar with its labels: everything in multiples of `unit`, which grows with the picture.
struct Legend {
    int unit, left, top, height;

    static constexpr int bar_width = 12, gap = 8, width = 84;

    int y_of(double share) const { return top + static_cast<int>(std::lround((1 - share) * (height - 1))); }

    void draw(Picture& picture, const LuminanceRange& range) const {
        for (int row = 0; row < height; ++row)
            fill_rectangle(picture, left + gap * unit, top + row, bar_width * unit, 1,
                           viridis(height == 1 ? 1 : 1 - double(row) / (height - 1)));
        const int first = preferred_index_below(range.lower_nt), last = preferred_index_below(range.upper_nt);
        // From the top; a label that would touch the one above is left out, but never the lower end's.
        int next_free = top - text_height * unit;
        const int lowest = y_of(0) - text_height * unit;
        for (int index = last; index >= first; --index) {
            const int y = y_of(place(preferred_number(index), range));
            if (y < next_free || (index != first && y > lowest)) continue;
            draw_mark(picture, y, label(preferred_number(index)));
            next_free = y + text_height * unit;
        }
    }

private:
    void draw_mark(Picture& picture, int y, const std::string& text) const {
        const int right = left + (gap + bar_width) * unit;
        fill_rectangle(picture, right, y - unit / 2, 3 * unit, unit, ink);
        draw_text(picture, right + 5 * unit, y - 4 * unit, unit, text, ink);
    }
};

}  // namespace

LuminanceRange luminance_range(const Image& image) {
    std::vector<double> nits;
    for (const Rgb& pixel : image.pixels) {
        const double value = luminance(pixel);
        if (value > 0 && std::isfinite(value)) nits.push_back(value);
    }
    if (nits.empty()) return {1, 10};
    std::ranges::sort(nits);
    const std::size_t outermost = nits.size() / 1000;
    const double lowest = nits[outermost], highest = nits[nits.size() - 1 - outermost];
    int upper = preferred_index_below(highest);
    if (preferred_number(upper) < highest) ++upper;
    const double most = preferred_number(upper);
    const int lower = preferred_index_below(std::max(lowest, most * std::pow(10, -most_decades)));
    return {preferred_number(lower == upper ? lower - 1 : lower), most};
}

Srgb viridis(double share) {
    constexpr std::size_t interval_count = std::size(viridis_table) - 1;
    const double place = interval_count * std::clamp(share, 0.0, 1.0);
    const auto below = std::min(static_cast<std::size_t>(place), interval_count - 1);
    Srgb color;
    for (std::size_t channel = 0; channel < 3; ++channel)
        color[channel] = static_cast<std::uint8_t>(std::lround(
            255 * std::lerp(viridis_table[below][channel], viridis_table[below + 1][channel], place - double(below))));
    return color;
}

Srgb false_color(double luminance_nt, const LuminanceRange& range) {
    return luminance_nt > 0 ? viridis(place(luminance_nt, range)) : darkness;
}

Picture false_colored(const Image& image) {
    const LuminanceRange range = luminance_range(image);
    const int unit = std::max(1, image.height / 250), margin = text_height * unit;
    Picture picture{image.width + Legend::width * unit, image.height, {}};
    picture.pixels.assign(static_cast<std::size_t>(picture.width) * static_cast<std::size_t>(picture.height), paper);
    for (std::size_t i = 0; i < image.pixels.size(); ++i) {
        const auto width = static_cast<std::size_t>(image.width);
        picture.pixels[i / width * static_cast<std::size_t>(picture.width) + i % width] =
            false_color(luminance(image.pixels[i]), range);
    }
    Legend{unit, image.width, margin, std::max(1, image.height - 2 * margin)}.draw(picture, range);
    return picture;
}

}  // namespace render
