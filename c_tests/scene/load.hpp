// Where scenes come from: a glTF file, or one of our generators.
#pragma once

#include <stdexcept>
#include <string>
#include <vector>

#include "scene/scene.hpp"

namespace harness {

/// What is wrong with the input, in one line that names the culprit: the file, and the mesh, accessor, node or option.
struct SceneError : std::runtime_error {
    using std::runtime_error::runtime_error;
};

/// `spec` is a path to a .glb or .gltf file, or `gen:NAME[:TRIANGLES]`. Throws SceneError.
Scene load_scene(const std::string& spec);

/// The default scene of a glTF file: each triangle primitive of each node instance becomes a mesh, transformed in double and
/// rounded once. Coordinates that are not finite are passed on. Throws SceneError, for all that is wrong with the file.
Scene load_gltf(const std::string& path);

/// A generated scene with about `triangle_count` triangles (0: the generator's own default). Throws SceneError that lists the
/// names.
Scene generate_scene(const std::string& name, std::size_t triangle_count);

struct GeneratorInfo {
    std::string name, what;
    bool closed;  // a closed mesh: no ray from inside may escape
};
const std::vector<GeneratorInfo>& generators();

/// Writes a scene as a binary glTF file, one node and mesh each. Throws SceneError.
void write_glb(const Scene& scene, const std::string& path);

}  // namespace harness
