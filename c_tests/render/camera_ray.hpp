// Rays through an image.
#pragma once

#include "gnomon.h"
#include "render/render_scene.hpp"

namespace render {

/// x and y in [0, 1], from the left and from the top. Of unit length but for rounding.
GnomonRay camera_ray(const Camera& camera, double x, double y);

}  // namespace render
