// A camera of a glTF file.
#pragma once

#include "render/frame.hpp"
#include "render/json_object.hpp"

namespace render {

/// An object of the list "cameras" at a place. Near and far planes are for rasterisers: not looked at. half_width is 0 where the
/// file leaves the aspect ratio open. Throws SceneError: for angles outside (0, pi), sizes that are not positive, unknown types.
Camera read_camera(const JsonObject& camera, const Frame& frame);

}  // namespace render
