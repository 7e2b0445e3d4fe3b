// Cameras for pictures of any shape, and for scenes that have none.
#pragma once

#include "render/render_scene.hpp"

namespace render {

/// width / height of what the camera sees; 16 / 9 where the file leaves it open.
double aspect_of(const Camera& camera);

/// With square pixels: grown to the sides or upwards where the picture's shape is not the camera's.
Camera fitted(Camera camera, int width, int height);

/// Looks at all of the scene from outside; called "default". Throws SceneError, which begins with `spec`, where no vertex is
/// finite.
Camera default_camera(const RenderScene& scene, const std::string& spec);

/// At `position`, looking at `target`, y up in the picture. `half_height` at distance 1.
Camera looking_at(const std::string& name, const Vec3d& position, const Vec3d& target, double half_height, double aspect);

}  // namespace render
