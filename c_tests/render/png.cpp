#include "render/png.hpp"

#define STB_IMAGE_WRITE_IMPLEMENTATION
#define STB_IMAGE_WRITE_STATIC
#include <stb/stb_image_write.h>

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "harness/write_file.hpp"

namespace render {

namespace {

void append_bytes(void* file, void* data, int size) {
    static_cast<std::string*>(file)->append(static_cast<const char*>(data), static_cast<std::size_t>(size));
}

double decoded(double encoded) { return encoded <= 0.04045 ? encoded / 12.92 : std::pow((encoded + 0.055) / 1.055, 2.4); }

}  // namespace

std::uint8_t to_srgb(double linear) {
    if (!(linear > 0)) return 0;
    const double encoded = linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1 / 2.4) - 0.055;
    return static_cast<std::uint8_t>(std::lround(255 * std::min(encoded, 1.0)));
}

float from_srgb(std::uint8_t byte) {
    static const std::array<float, 256> table = [] {
        std::array<float, 256> linear;
        for (std::size_t i = 0; i < linear.size(); ++i) linear[i] = float(decoded(double(i) / 255));
        return linear;
    }();
    return table[byte];
}

void write_png(const Picture& picture, const std::string& path) {
    std::string file;
    stbi_write_png_to_func(append_bytes, &file, picture.width, picture.height, sizeof(Srgb), picture.pixels.data(),
                           picture.width * static_cast<int>(sizeof(Srgb)));
    harness::write_file(path, file);
}

}  // namespace render
