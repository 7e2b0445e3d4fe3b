// A picture that a screen can show, as a PNG file.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace render {

using Srgb = std::array<std::uint8_t, 3>;

struct Picture {
    int width, height;
    std::vector<Srgb> pixels;  // row by row from the top
};

/// IEC 61966-2-1: of linear light, where 1 is the screen's white. What is outside [0, 1] is clamped, NaN is black.
std::uint8_t to_srgb(double linear);

/// The linear light of an sRGB byte.
float from_srgb(std::uint8_t byte);

/// Throws std::runtime_error that names the file.
void write_png(const Picture& picture, const std::string& path);

}  // namespace render
