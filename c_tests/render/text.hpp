// Words in a picture.
#pragma once

#include <string>

#include "render/png.hpp"

namespace render {

/// Of one line at scale 1, in pixels.
constexpr int text_height = 12;
int text_width(const std::string& text);

/// Its upper left corner at (x, y), each pixel of the font `scale` pixels wide; what lies outside the picture is left out. ASCII.
void draw_text(Picture& picture, int x, int y, int scale, const std::string& text, const Srgb& color);

/// What lies outside the picture is left out.
void fill_rectangle(Picture& picture, int x, int y, int width, int height, const Srgb& color);

}  // namespace render
