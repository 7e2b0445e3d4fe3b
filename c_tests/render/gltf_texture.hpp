// Textures of a glTF file: each is read when the first material asks for it.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "render/json_object.hpp"
#include "render/render_scene.hpp"
#include "scene/tinygltf.hpp"

namespace render {

class TextureReader {
public:
    /// All must outlive it. `path` is the glTF file's, which the images' paths are relative to.
    TextureReader(const tinygltf::Model& model, const JsonObject& root, const std::string& path, RenderScene& scene,
                  std::vector<std::string>& remarks);

    /// The index in the scene's textures of what the textureInfo `key` of `owner` refers to; -1 where there is none, and, with a
    /// remark, where its image cannot be had. Throws SceneError for references that lead nowhere.
    int read(const JsonObject& owner, const char* key);

private:
    int read_texture(const JsonObject& texture);
    std::optional<Texture> read_image(const JsonObject& texture);

    const tinygltf::Model& model_;
    std::vector<JsonObject> textures_, images_, samplers_;
    std::string folder_;
    RenderScene& scene_;
    std::vector<std::string>& remarks_;
    std::vector<std::optional<int>> read_;  // by texture
    std::size_t texels_left_;
};

}  // namespace render
