// Pictures on disk and on screen: what is written is what was rendered.
#define DOCTEST_CONFIG_IMPLEMENT_WITH_MAIN
#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfInputFile.h>
#include <ImfStandardAttributes.h>
#include <doctest/doctest.h>

#include <cmath>
#include <cstring>
#include <fstream>
#include <iterator>
#include <limits>

#include "harness/rng.hpp"
#include "render/decode_image.hpp"
#include "render/exr.hpp"
#include "render/false_color.hpp"
#include "render/text.hpp"
#include "render/tone_map.hpp"
#include "scene/load.hpp"
#include "suites/temp_folder.hpp"

using namespace render;

namespace {

Image grey_image(int width, const std::vector<float>& nits) {
    Image image{width, int(nits.size()) / width, {}};
    for (const float value : nits) image.pixels.push_back({value, value, value});
    return image;
}

/// Luminances over `decade_count` decades, in no order.
Image wide_image(double decade_count) {
    harness::Rng rng(1);
    Image image{40, 25, {}};
    for (int i = 0; i < 40 * 25; ++i) {
        const auto nits = float(std::pow(10, rng.uniform(-decade_count / 2, decade_count / 2)));
        image.pixels.push_back({nits, float(rng.uniform()) * nits, float(rng.uniform()) * nits});
    }
    return image;
}

std::vector<unsigned char> read_file(const std::string& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
}

const Srgb& pixel(const Picture& picture, int x, int y) { return picture.pixels[std::size_t(y * picture.width + x)]; }

int brightness(const Srgb& color) { return 2126 * color[0] + 7152 * color[1] + 722 * color[2]; }

}  // namespace

TEST_CASE("an OpenEXR file holds every float to the bit, rows from the top, and says nits") {
    constexpr float infinity = std::numeric_limits<float>::infinity();
    Image image = wide_image(60);
    image.pixels[0] = {0, -0.0F, std::numeric_limits<float>::denorm_min()};
    image.pixels[1] = {infinity, std::numeric_limits<float>::quiet_NaN(), 65505};  // beyond half floats
    const harness::TempFolder folder;
    const std::string path = folder.file("picture.exr");
    write_exr(image, path);

    Imf::InputFile file(path.c_str());
    CHECK(Imf::whiteLuminance(file.header()) == 1);
    CHECK(Imf::hasChromaticities(file.header()));
    CHECK(Imf::comments(file.header()).find("nt") != std::string::npos);
    REQUIRE(file.header().dataWindow().max == Imath::V2i(image.width - 1, image.height - 1));
    std::vector<Rgb> read(image.pixels.size());
    Imf::FrameBuffer buffer;
    const char* names[] = {"R", "G", "B"};
    for (std::size_t channel = 0; channel < 3; ++channel) {
        REQUIRE(file.header().channels()[names[channel]].type == Imf::FLOAT);
        buffer.insert(names[channel], Imf::Slice(Imf::FLOAT, reinterpret_cast<char*>(&read[0][channel]), sizeof(Rgb),
                                                 sizeof(Rgb) * std::size_t(image.width)));
    }
    file.setFrameBuffer(buffer);
    file.readPixels(0, image.height - 1);
    CHECK(std::memcmp(read.data(), image.pixels.data(), read.size() * sizeof(Rgb)) == 0);
}

TEST_CASE("a PNG file holds every byte") {
    Picture picture{16, 16, {}};
    for (int i = 0; i < 256; ++i) picture.pixels.push_back({std::uint8_t(i), std::uint8_t(255 - i), std::uint8_t(i * 7)});
    const harness::TempFolder folder;
    write_png(picture, folder.file("picture.png"));
    const Texture read = decode_image(read_file(folder.file("picture.png")), 256);
    REQUIRE(read.width == 16);
    REQUIRE(read.height == 16);
    for (std::size_t i = 0; i < 256; ++i)
        for (std::size_t channel = 0; channel < 3; ++channel)
            CHECK(read.texels[i][channel] == from_srgb(picture.pixels[i][channel]));
}

TEST_CASE("files that cannot be written or decoded are named") {
    const harness::TempFolder folder;
    const std::string lost = folder.file("no/picture");
    CHECK_THROWS_WITH(write_png({1, 1, {{1, 2, 3}}}, lost), (lost + ": cannot be written").c_str());
    CHECK_THROWS_WITH(write_exr(grey_image(1, {1}), lost), doctest::Contains((lost + ": ").c_str()));
    CHECK_THROWS_AS(decode_image({}, 100), harness::SceneError);
    write_png({2, 1, {{1, 2, 3}, {1, 2, 3}}}, folder.file("picture.png"));
    const std::vector<unsigned char> file = read_file(folder.file("picture.png"));
    CHECK_THROWS_WITH(decode_image(file, 1), "2 x 1 texels, of which there is room for 1");
    for (std::size_t bytes = 0; bytes + 16 < file.size(); ++bytes)  // without the end alone stb_image does
        CHECK_THROWS_AS(decode_image(std::span(file).first(bytes), 2), harness::SceneError);
}

TEST_CASE("sRGB bytes survive linear light, and the ends are black and white") {
    for (int i = 0; i < 256; ++i) CHECK(to_srgb(from_srgb(std::uint8_t(i))) == i);
    CHECK(from_srgb(255) == 1);
    CHECK(to_srgb(0.18) == 118);  // by IEC 61966-2-1: 255 (1.055 0.18^(1 / 2.4) - 0.055) = 117.6
    CHECK(to_srgb(-1) == 0);
    CHECK(to_srgb(2) == 255);
    CHECK(to_srgb(std::numeric_limits<double>::infinity()) == 255);
    CHECK(to_srgb(std::numeric_limits<double>::quiet_NaN()) == 0);
}

TEST_CASE("the log mean passes over black, infinite and NaN pixels") {
    constexpr float infinity = std::numeric_limits<float>::infinity(), nan = std::numeric_limits<float>::quiet_NaN();
    CHECK(log_mean_luminance(grey_image(1, {1, 100, 0, infinity, nan})) == doctest::Approx(10));
    CHECK(log_mean_luminance(grey_image(1, {0})) == 0);
    CHECK(mean_luminance(grey_image(1, {1, 3})) == doctest::Approx(2));
    CHECK(luminance({0, 1, 0}) == 0.7152);
}

TEST_CASE("the exposure value is the light meter's") {
    CHECK(exposure_of(4096) == doctest::Approx(15));  // a sunny day: L = 2^15 12.5 / 100
    CHECK(automatic_exposure(grey_image(1, {16, 64})) == doctest::Approx(8));
    CHECK(automatic_exposure(grey_image(1, {0})) == 0);
}

TEST_CASE("tone mapping keeps the order of luminances and the colours, and makes the brightest white") {
    std::vector<float> nits;
    for (int i = 0; i < 4000; ++i) nits.push_back(float(std::pow(10, -3 + 0.002 * i)));
    const Image image = grey_image(4000, nits);
    for (const double exposure : {-6.0, automatic_exposure(image), 20.0}) {
        CAPTURE(exposure);
        const Picture picture = tone_mapped(image, exposure);
        int distinct_count = 1;
        for (int x = 1; x < picture.width; ++x) {
            REQUIRE(pixel(picture, x, 0)[0] >= pixel(picture, x - 1, 0)[0]);
            REQUIRE(pixel(picture, x, 0)[0] == pixel(picture, x, 0)[2]);
            distinct_count += pixel(picture, x, 0)[0] != pixel(picture, x - 1, 0)[0];
        }
        CHECK(distinct_count > 100);
    }
    const Picture automatic = tone_mapped(image, automatic_exposure(image));
    CHECK(pixel(automatic, 0, 0)[0] == 0);
    CHECK(pixel(automatic, 3999, 0)[0] == 255);
    // Two stops more are darker, and what has no red gets none.
    CHECK(pixel(tone_mapped(image, exposure_of(1) + 2), 1500, 0)[0] < pixel(tone_mapped(image, exposure_of(1)), 1500, 0)[0]);
    const Picture cyan = tone_mapped({1, 1, {{0, 5, 5}}}, exposure_of(5));
    CHECK(pixel(cyan, 0, 0)[0] == 0);
    CHECK(pixel(cyan, 0, 0)[1] == pixel(cyan, 0, 0)[2]);
    CHECK(pixel(cyan, 0, 0)[1] > 0);
    CHECK(pixel(tone_mapped(grey_image(1, {0}), 0), 0, 0) == Srgb{0, 0, 0});
}

TEST_CASE("viridis grows brighter all along, from its first colour to its last") {
    CHECK(viridis(0) == Srgb{68, 1, 84});
    CHECK(viridis(1) == Srgb{253, 231, 37});
    CHECK(viridis(-1) == viridis(0));
    CHECK(viridis(2) == viridis(1));
    // In steps that a byte resolves.
    for (int i = 1; i <= 64; ++i) CHECK(brightness(viridis(i / 64.0)) > brightness(viridis((i - 1) / 64.0)));
}

TEST_CASE("the range is of preferred numbers around the luminances") {
    const auto range_of = [](std::vector<float> nits) {
        const LuminanceRange range = luminance_range(grey_image(1, nits));
        return std::pair{range.lower_nt, range.upper_nt};
    };
    CHECK(range_of({3, 30, 300}) == std::pair{2.0, 500.0});
    CHECK(range_of({1, 10}) == std::pair{1.0, 10.0});
    CHECK(range_of({7, 7}) == std::pair{5.0, 10.0});
    CHECK(range_of({1, 1}) == std::pair{0.5, 1.0});
    CHECK(range_of({0, 0}) == std::pair{1.0, 10.0});
    CHECK(range_of({1e-30F, 1e3F}) == std::pair{1e-3, 1e3});
    CHECK(range_of({0.03F, 0.04F}).first == doctest::Approx(0.02));
    CHECK(range_of({3e30F, 4e30F}).second == doctest::Approx(5e30));
}

TEST_CASE("false colours: equal ratios are equal steps, black is darkness, and the legend ends with the range's ends") {
    const Image image = grey_image(400, [] {
        std::vector<float> nits(400 * 300, 10);
        for (int x = 0; x < 400; ++x)
            nits[std::size_t(x)] = x < 200 ? 1.0F : 100.0F;  // a row of each, beyond the outermost thousandth
        nits[400] = 0;
        return nits;
    }());
    const LuminanceRange range = luminance_range(image);
    CHECK(range.lower_nt == 1);
    CHECK(range.upper_nt == 100);
    const Picture picture = false_colored(image);
    CHECK(picture.height == image.height);
    CHECK(picture.width > image.width);
    CHECK(pixel(picture, 0, 0) == viridis(0));
    CHECK(pixel(picture, 399, 0) == viridis(1));
    CHECK(pixel(picture, 5, 5) == viridis(0.5));
    CHECK(pixel(picture, 0, 1) == Srgb{0, 0, 0});
    CHECK(false_color(std::numeric_limits<double>::quiet_NaN(), range) == Srgb{0, 0, 0});

    // The bar: one column to the right of the picture whose colours go from the last to the first.
    const int column = image.width + 12;
    std::vector<Srgb> bar;
    for (int y = 0; y < picture.height; ++y)
        if (pixel(picture, column, y) != Srgb{255, 255, 255}) bar.push_back(pixel(picture, column, y));
    REQUIRE(bar.size() > 200);
    CHECK(bar.front() == viridis(1));
    CHECK(bar.back() == viridis(0));
    CHECK(bar[bar.size() / 2] == viridis(0.5 - 0.5 / double(bar.size() - 1)));
}

TEST_CASE("pictures of one pixel and of none too small have a legend that fits") {
    for (const int height : {1, 2, 10, 30, 2000}) {
        const Picture picture = false_colored(grey_image(1, std::vector<float>(std::size_t(height), 1)));
        CHECK(picture.height == height);
        CHECK(picture.pixels.size() == std::size_t(picture.width) * std::size_t(height));
    }
}

TEST_CASE("text is drawn where it is asked for, and what is outside is left out") {
    Picture picture{40, 12, std::vector<Srgb>(480, Srgb{255, 255, 255})};
    draw_text(picture, 2, 2, 1, "1 nt", {0, 0, 0});
    int ink_count = 0;
    for (int y = 0; y < 12; ++y)
        for (int x = 0; x < 40; ++x) {
            if (pixel(picture, x, y) == Srgb{255, 255, 255}) continue;
            ++ink_count;
            CHECK(x >= 2);
            CHECK(x < 2 + text_width("1 nt"));
        }
    CHECK(ink_count > 15);
    const Picture before = picture;
    draw_text(picture, 1000, -1000, 3, "1 nt", {0, 0, 0});
    draw_text(picture, -1000, 4, 3, "1 nt", {0, 0, 0});
    CHECK(picture.pixels == before.pixels);
}
