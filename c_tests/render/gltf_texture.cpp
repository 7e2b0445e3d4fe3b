#include "render/gltf_texture.hpp"

#include <charconv>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <span>

#include "render/decode_image.hpp"
#include "scene/gltf_accessor.hpp"
#include "scene/load.hpp"

namespace render {

namespace {

using harness::SceneError;
using Bytes = std::vector<unsigned char>;

/// 1.5 GiB in floats: an image of one colour can ask for that in a few kilobytes.
constexpr std::size_t most_texels = std::size_t(1) << 27;

/// "a%20b" is "a b" (RFC 3986, section 2.1); a percent sign without two digits stands for itself.
std::string percent_decoded(const std::string& text) {
    std::string decoded;
    for (std::size_t i = 0; i < text.size(); ++i) {
        unsigned char byte = 0;
        const char* digits = text.data() + i + 1;
        if (text[i] == '%' && i + 2 < text.size() && std::from_chars(digits, digits + 2, byte, 16).ptr == digits + 2) {
            decoded += static_cast<char>(byte);
            i += 2;
        } else {
            decoded += text[i];
        }
    }
    return decoded;
}

Bytes read_file(const std::filesystem::path& path) {
    if (!std::filesystem::is_regular_file(path)) throw SceneError("no such file");
    std::ifstream file(path, std::ios::binary);
    if (!file) throw SceneError("cannot be opened for reading");
    return {std::istreambuf_iterator<char>(file), {}};
}

Bytes read_uri(const std::string& uri, const std::filesystem::path& folder) {
    if (!tinygltf::IsDataURI(uri)) return read_file(folder / percent_decoded(uri));
    Bytes bytes;
    std::string media_type;
    if (!tinygltf::DecodeDataURI(&bytes, media_type, uri, 0, false)) throw SceneError("a data URI that cannot be decoded");
    return bytes;
}

/// What an image is called in a remark: its file, if it has one.
std::string name_of(const JsonObject& image) {
    const std::string uri = image.text("uri", "");
    return uri.empty() || tinygltf::IsDataURI(uri) ? image.path() : image.path() + " (" + uri + ")";
}

constexpr int clamp_to_edge = 33071, mirrored_repeat = 33648, repeat = 10497;
constexpr Interval wrap_modes{repeat, mirrored_repeat, false, "33071, 33648 or 10497"};

int wrap_of(const JsonObject& sampler, const char* key) {
    const auto value = static_cast<int>(sampler.number(key, repeat, wrap_modes));
    if (value != repeat && value != clamp_to_edge && value != mirrored_repeat) sampler.fail(key, wrap_modes.what);
    return value;
}

/// Beside its mirror image, which repeated is MIRRORED_REPEAT.
Texture with_mirror_image(const Texture& texture, bool across_u) {
    Texture wide = texture;
    (across_u ? wide.width : wide.height) *= 2;
    wide.texels.clear();
    wide.texels.reserve(2 * texture.texels.size());
    const auto folded = [](int i, int size) { return std::size_t(i < size ? i : 2 * size - 1 - i); };
    for (int row = 0; row < wide.height; ++row)
        for (int column = 0; column < wide.width; ++column)
            wide.texels.push_back(
                texture.texels[folded(row, texture.height) * std::size_t(texture.width) + folded(column, texture.width)]);
    return wide;
}

}  // namespace

TextureReader::TextureReader(const tinygltf::Model& model, const JsonObject& root, const std::string& path, RenderScene& scene,
                             std::vector<std::string>& remarks)
    : model_(model),
      textures_(root.objects("textures")),
      images_(root.objects("images")),
      samplers_(root.objects("samplers")),
      folder_(std::filesystem::path(path).parent_path().string()),
      scene_(scene),
      remarks_(remarks),
      read_(textures_.size()),
      texels_left_(most_texels) {}

int TextureReader::read(const JsonObject& owner, const char* key) {
    if (!owner.has(key)) return -1;
    const JsonObject info = owner.object(key);
    const std::optional<std::size_t> id = info.id("index", textures_.size(), "textures");
    if (!id) throw SceneError(info.path() + " has no index");
    if (!read_[*id]) read_[*id] = read_texture(textures_[*id]);
    return *read_[*id];
}

int TextureReader::read_texture(const JsonObject& texture) {
    const std::optional<std::size_t> sampler_id = texture.id("sampler", samplers_.size(), "samplers");
    const int wrap_u = sampler_id ? wrap_of(samplers_[*sampler_id], "wrapS") : repeat;
    const int wrap_v = sampler_id ? wrap_of(samplers_[*sampler_id], "wrapT") : repeat;
    std::optional<Texture> result = read_image(texture);
    if (!result) return -1;
    if (wrap_u == mirrored_repeat) result = with_mirror_image(*result, true);
    if (wrap_v == mirrored_repeat) result = with_mirror_image(*result, false);
    result->repeats_u = wrap_u != clamp_to_edge;
    result->repeats_v = wrap_v != clamp_to_edge;
    scene_.textures.push_back(*std::move(result));
    return static_cast<int>(scene_.textures.size() - 1);
}

std::optional<Texture> TextureReader::read_image(const JsonObject& texture) {
    const std::optional<std::size_t> id = texture.id("source", images_.size(), "images");
    if (!id) {
        remarks_.push_back(texture.path() + " has no source that is known here: it is left out");
        return {};
    }
    const JsonObject& image = images_[*id];
    const std::optional<std::size_t> view = image.id("bufferView", model_.bufferViews.size(), "bufferViews");
    try {
        // A mirror image doubles it, in both directions twice.
        const std::size_t room = texels_left_ / 4;
        Texture decoded = view ? decode_image(harness::view_bytes(model_, static_cast<int>(*view)), room)
                               : decode_image(read_uri(image.text("uri", ""), folder_), room);
        texels_left_ -= 4 * decoded.texels.size();
        return decoded;
    } catch (const std::exception& error) {
        remarks_.push_back(name_of(image) + ": " + error.what() + ": the texture is left out");
        return {};
    }
}

}  // namespace render
