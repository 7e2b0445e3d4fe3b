// A picture in nt, to the bit, as an OpenEXR file.
#pragma once

#include <string>

#include "render/image.hpp"

namespace render {

/// R, G and B as 32-bit floats in nt: the attribute whiteLuminance, "the luminance of the RGB value (1, 1, 1) in nits", is 1.
/// Throws std::runtime_error that names the file.
void write_exr(const Image& image, const std::string& path);

}  // namespace render
