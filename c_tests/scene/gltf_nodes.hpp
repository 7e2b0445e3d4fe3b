// The node walk: which mesh stands where.
#pragma once

#include <array>
#include <functional>
#include <string>
#include <vector>

#include "scene/scene.hpp"
#include "scene/tinygltf.hpp"

namespace harness {

/// x -> linear * x + translation, in double.
struct Affine {
    std::array<Vec3d, 3> linear{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};  // rows
    Vec3d translation{0, 0, 0};

    bool operator==(const Affine&) const = default;
    Vec3d apply(const Vec3d& point) const;
};

/// First `inner`, then `outer`.
Affine operator*(const Affine& outer, const Affine& inner);

struct MeshInstance {
    int node_id, mesh_id;  // both exist
    Affine transform;      // from the mesh to the world; finite
};

/// Told of a node and of its transform to the world, which is finite.
using NodeVisitor = std::function<void(int node_id, const Affine& transform)>;

/// Every node that the default scene reaches, depth first, children in their order. A node with two parents stands at both
/// places.
///
/// The default scene is the one that "scene" names, else the first; a file without scenes is read as one scene of the nodes that
/// are nobody's child.
///
/// Throws SceneError for a reference to a node that leads nowhere, a cycle, a transform that is not finite or not affine, and
/// trees beyond the limits in the code.
void walk_nodes(const tinygltf::Model& model, const NodeVisitor& visitor);

/// Those with a mesh, in that order. Throws SceneError, also for a mesh that does not exist.
std::vector<MeshInstance> mesh_instances(const tinygltf::Model& model);

}  // namespace harness
