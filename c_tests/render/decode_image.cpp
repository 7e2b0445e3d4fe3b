#include "render/decode_image.hpp"

#define STB_IMAGE_IMPLEMENTATION
#define STB_IMAGE_STATIC
#define STBI_ONLY_PNG
#define STBI_ONLY_JPEG
#define STBI_NO_STDIO
#define STBI_NO_LINEAR
#include <stb/stb_image.h>

#include <limits>
#include <memory>
#include <string>

#include "render/png.hpp"
#include "scene/load.hpp"

namespace render {

namespace {

struct Free {
    void operator()(unsigned char* pixels) const { stbi_image_free(pixels); }
};

[[noreturn]] void fail() {
    throw harness::SceneError("neither PNG nor JPEG that can be decoded: " + std::string(stbi_failure_reason()));
}

}  // namespace

Texture decode_image(std::span<const unsigned char> file, std::size_t most_texels) {
    if (file.size() > std::size_t(std::numeric_limits<int>::max())) throw harness::SceneError("larger than 2 GiB");
    const auto file_bytes = static_cast<int>(file.size());
    Texture texture{0, 0, {}, true, true};
    int channel_count = 0;
    if (!stbi_info_from_memory(file.data(), file_bytes, &texture.width, &texture.height, &channel_count)) fail();
    const std::size_t texel_count = std::size_t(texture.width) * std::size_t(texture.height);
    if (texel_count > most_texels)
        throw harness::SceneError(std::to_string(texture.width) + " x " + std::to_string(texture.height) +
                                  " texels, of which there is room for " + std::to_string(most_texels));
    const std::unique_ptr<unsigned char, Free> bytes(
        stbi_load_from_memory(file.data(), file_bytes, &texture.width, &texture.height, &channel_count, 3));
    if (!bytes) fail();
    texture.texels.resize(texel_count);
    for (std::size_t i = 0; i < texel_count; ++i)
        for (std::size_t channel = 0; channel < 3; ++channel)
            texture.texels[i][channel] = from_srgb(bytes.get()[3 * i + channel]);
    return texture;
}

}  // namespace render
