#include <algorithm>
#include <cmath>
#include <cstring>
#include <fstream>
#include <nlohmann/json.hpp>
#include <optional>

#include "scene/glb.hpp"
#include "scene/load.hpp"

namespace harness {

namespace {

using nlohmann::json;

// Numbers that the specification gives a meaning to.
constexpr int float_type = 5126, unsigned_int_type = 5125;
constexpr int array_buffer = 34962, element_array_buffer = 34963;
constexpr int triangles_mode = 4;

/// Appends the bytes of `values` to the buffer and returns the bufferView's id.
template <typename T>
std::size_t append_view(const std::vector<T>& values, int target, json& views, std::string& buffer) {
    const std::size_t offset = buffer.size();
    buffer.append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T));
    views.push_back({{"buffer", 0}, {"byteOffset", offset}, {"byteLength", values.size() * sizeof(T)}, {"target", target}});
    return views.size() - 1;
}

/// The least or greatest finite coordinate of each axis; 0 where there is none, since JSON has no infinities and glTF demands
/// numbers.
template <typename Pick>
std::array<float, 3> extreme(const std::vector<float>& positions, Pick pick) {
    std::array<std::optional<float>, 3> best;
    for (std::size_t i = 0; i < positions.size(); ++i)
        if (std::isfinite(positions[i])) best[i % 3] = best[i % 3] ? pick(*best[i % 3], positions[i]) : positions[i];
    return {best[0].value_or(0), best[1].value_or(0), best[2].value_or(0)};
}

json position_accessor(const Mesh& mesh, std::size_t view_id) {
    return {{"bufferView", view_id},
            {"componentType", float_type},
            {"count", mesh.vertex_count()},
            {"type", "VEC3"},
            {"min", extreme(mesh.positions, [](float a, float b) { return std::min(a, b); })},
            {"max", extreme(mesh.positions, [](float a, float b) { return std::max(a, b); })}};
}

json index_accessor(const Mesh& mesh, std::size_t view_id) {
    return {{"bufferView", view_id}, {"componentType", unsigned_int_type}, {"count", mesh.indices.size()}, {"type", "SCALAR"}};
}

GlbChunks encode(const Scene& scene) {
    GlbChunks chunks;
    json root{{"asset", {{"version", "2.0"}, {"generator", "gnomon c_tests"}}}, {"scene", 0}};
    json& root_nodes = root["scenes"][0]["nodes"] = json::array();
    for (std::size_t i = 0; i < scene.meshes.size(); ++i) {
        const Mesh& mesh = scene.meshes[i];
        if (mesh.triangle_count() == 0)
            throw SceneError("mesh " + std::to_string(i) + " has no triangles: glTF has no empty accessors");
        root["accessors"].push_back(
            position_accessor(mesh, append_view(mesh.positions, array_buffer, root["bufferViews"], chunks.binary)));
        root["accessors"].push_back(
            index_accessor(mesh, append_view(mesh.indices, element_array_buffer, root["bufferViews"], chunks.binary)));
        const json primitive{{"attributes", {{"POSITION", 2 * i}}}, {"indices", 2 * i + 1}, {"mode", triangles_mode}};
        root["meshes"].push_back({{"name", mesh.name}, {"primitives", json::array({primitive})}});
        root["nodes"].push_back({{"mesh", i}});
        root_nodes.push_back(i);
    }
    if (!chunks.binary.empty()) root["buffers"].push_back({{"byteLength", chunks.binary.size()}});
    chunks.json = root.dump();
    return chunks;
}

}  // namespace

void write_glb(const Scene& scene, const std::string& path) {
    try {
        const std::string bytes = join_glb(encode(scene));
        std::ofstream file(path, std::ios::binary);
        file.write(bytes.data(), std::streamsize(bytes.size()));
        file.close();
        if (!file) throw SceneError("cannot be written");
    } catch (const std::exception& error) {
        throw SceneError(path + ": " + error.what());
    }
}

}  // namespace harness
