#include "render/text.hpp"

#include <stb/stb_easy_font.h>

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace render {

namespace {

/// As stb_easy_font lays it out. Four vertices are an upright rectangle.
struct Vertex {
    float x, y, z;
    unsigned char color[4];
};

}  // namespace

int text_width(const std::string& text) {
    return stb_easy_font_width(const_cast<char*>(text.c_str()));  // reads only
}

void draw_text(Picture& picture, int x, int y, int scale, const std::string& text, const Srgb& color) {
    constexpr std::size_t most_vertices_a_letter = 4 * 24;
    std::vector<Vertex> vertices(text.size() * most_vertices_a_letter);
    const int quad_count = stb_easy_font_print(0, 0, const_cast<char*>(text.c_str()), nullptr, vertices.data(),
                                               static_cast<int>(vertices.size() * sizeof(Vertex)));
    for (std::size_t quad = 0; quad < static_cast<std::size_t>(quad_count); ++quad) {
        const Vertex &first = vertices[4 * quad], &opposite = vertices[4 * quad + 2];
        const auto left = static_cast<int>(first.x), top = static_cast<int>(first.y);
        fill_rectangle(picture, x + scale * left, y + scale * top, scale * (static_cast<int>(opposite.x) - left),
                       scale * (static_cast<int>(opposite.y) - top), color);
    }
}

void fill_rectangle(Picture& picture, int x, int y, int width, int height, const Srgb& color) {
    for (int row = std::max(y, 0); row < std::min(y + height, picture.height); ++row) {
        for (int column = std::max(x, 0); column < std::min(x + width, picture.width); ++column) {
            picture.pixels[static_cast<std::size_t>(row) * static_cast<std::size_t>(picture.width) +
                           static_cast<std::size_t>(column)] = color;
        }
    }
}

}  // namespace render
