// PNG and JPEG files.
#pragma once

#include <cstddef>
#include <span>

#include "render/render_scene.hpp"

namespace render {

/// The texels of an image in sRGB, linear; grey becomes RGB, alpha and what 16 bits have beyond 8 are dropped. Throws SceneError,
/// also for an image of more than `most_texels`, before there is memory for it.
Texture decode_image(std::span<const unsigned char> file, std::size_t most_texels);

}  // namespace render
