// load_gltf: triangles alone.
#include <filesystem>

#include "scene/gltf_document.hpp"
#include "scene/gltf_expand.hpp"
#include "scene/load.hpp"

namespace harness {

Scene load_gltf(const std::string& path) {
    try {
        const tinygltf::Model model = parse_gltf(read_gltf_chunks(path), path);
        const std::vector<MeshInstance> instances = mesh_instances(model);
        return {std::filesystem::path(path).stem().string(), expand(model, primitive_instances(model, instances))};
    } catch (const std::exception& error) {  // SceneError, and what the JSON parser, the file system and the allocator throw
        throw SceneError(path + ": " + error.what());
    }
}

}  // namespace harness
