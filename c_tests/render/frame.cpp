#include "render/frame.hpp"

#include <cmath>
#include <limits>

#include "rays/vector.hpp"
#include "scene/load.hpp"

namespace render {

namespace {

using namespace harness;

Vec3d column(const Affine& transform, std::size_t i) {
    return {transform.linear[0][i], transform.linear[1][i], transform.linear[2][i]};
}

/// NaN is not.
bool fits_float(const Vec3d& v) {
    constexpr double most = std::numeric_limits<float>::max();
    return std::abs(v[0]) <= most && std::abs(v[1]) <= most && std::abs(v[2]) <= most;
}

}  // namespace

Frame frame_of(int node_id, const Affine& transform) {
    Frame frame;
    frame.position = transform.translation;
    frame.forward = normalized(-column(transform, 2));
    frame.right = normalized(cross(frame.forward, normalized(column(transform, 1))));
    frame.up = cross(frame.right, frame.forward);
    const std::string node = "node " + std::to_string(node_id);
    if (!fits_float(frame.position)) throw SceneError(node + ": its place is beyond the range of floats");
    if (!fits_float(frame.right)) throw SceneError(node + ": its matrix leaves no direction for a camera or lamp to look in");
    return frame;
}

}  // namespace render
