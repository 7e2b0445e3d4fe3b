// Colours from textures.
#pragma once

#include "render/render_scene.hpp"

namespace render {

/// Bilinear between the centres of texels; v goes down, as glTF has it. Black at coordinates that are not finite.
Rgb texel_color(const Texture& texture, double u, double v);

}  // namespace render
