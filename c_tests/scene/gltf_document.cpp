#include "scene/gltf_document.hpp"

#include <filesystem>
#include <fstream>
#include <iterator>
#include <limits>
#include <utility>

#include "scene/gltf_json.hpp"
#include "scene/load.hpp"

namespace harness {

namespace {

std::string read_file(const std::filesystem::path& path) {
    if (!std::filesystem::is_regular_file(path)) throw SceneError("no such file");
    // tinygltf holds some sizes in an int.
    if (std::filesystem::file_size(path) > std::size_t(std::numeric_limits<int>::max())) throw SceneError("larger than 2 GiB");
    std::ifstream file(path, std::ios::binary);
    if (!file) throw SceneError("cannot be opened for reading");
    return {std::istreambuf_iterator<char>(file), {}};
}

/// tinygltf writes several lines, and quotes whole data URIs in them.
std::string first_line(const std::string& message) {
    constexpr std::size_t most_characters = 160;
    const std::string line = message.substr(0, message.find('\n'));
    return line.size() <= most_characters ? line : line.substr(0, most_characters) + "...";
}

}  // namespace

GlbChunks read_gltf_chunks(const std::string& path) {
    std::string file = read_file(path);
    if (path.ends_with(".glb")) return split_glb(file);
    return {std::move(file), {}};
}

tinygltf::Model parse_gltf(GlbChunks chunks, const std::string& path) {
    tinygltf::TinyGLTF parser;
    tinygltf::Model model;
    std::string error, warning;
    const std::string folder = std::filesystem::path(path).parent_path().string();
    chunks.json = geometry_json(chunks.json);
    if (path.ends_with(".glb")) {
        const std::string checked = join_glb(chunks);
        parser.LoadBinaryFromMemory(&model, &error, &warning, reinterpret_cast<const unsigned char*>(checked.data()),
                                    unsigned(checked.size()), folder);
    } else {
        parser.LoadASCIIFromString(&model, &error, &warning, chunks.json.data(), unsigned(chunks.json.size()), folder);
    }
    // Also where tinygltf returns true: it then left something out, a primitive without attributes for one.
    if (!error.empty()) throw SceneError(first_line(error));
    if (!model.asset.version.starts_with("2.")) throw SceneError("glTF version " + model.asset.version + ", not 2");
    return model;
}

}  // namespace harness
