// Where a node puts a camera or a lamp, and where that looks.
#pragma once

#include "render/render_scene.hpp"
#include "scene/gltf_nodes.hpp"

namespace render {

struct Frame {
    Vec3d position, right, up, forward;  // orthonormal
};

/// Cameras and lamps look along the node's -z, with its y up. Scales do not matter, and a mirroring node does not mirror what its
/// camera sees. Throws SceneError that names the node where no direction is left.
Frame frame_of(int node_id, const harness::Affine& transform);

}  // namespace render
