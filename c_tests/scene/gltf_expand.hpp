// From nodes and primitives to world-space meshes. Bind pose: skins, morph targets and animations are not applied.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "scene/gltf_nodes.hpp"
#include "scene/load.hpp"

namespace harness {

/// One primitive at one place.
struct PrimitiveInstance {
    const MeshInstance* instance;
    std::size_t primitive_id;  // exists in its mesh
};

/// All primitives that have triangles, in the order of `instances`, which must outlive the result. Throws SceneError when
/// together they pass the limits, before any of them is read.
std::vector<PrimitiveInstance> primitive_instances(const tinygltf::Model& model, const std::vector<MeshInstance>& instances);

/// One mesh for each of them, transformed in double and rounded once. Throws SceneError.
std::vector<Mesh> expand(const tinygltf::Model& model, const std::vector<PrimitiveInstance>& instances);

/// Runs `act` and puts the primitive's name before what it throws.
template <typename Act>
auto naming_primitive(int mesh_id, std::size_t primitive_id, Act act) {
    try {
        return act();
    } catch (const SceneError& error) {
        throw SceneError("mesh " + std::to_string(mesh_id) + " primitive " + std::to_string(primitive_id) + ": " + error.what());
    }
}

}  // namespace harness
