#include "render/camera_ray.hpp"

#include <limits>

#include "rays/vector.hpp"

namespace render {

using namespace harness;

GnomonRay camera_ray(const Camera& camera, double x, double y) {
    const Vec3d aside = (2 * x - 1) * camera.half_width * camera.right + (1 - 2 * y) * camera.half_height * camera.up;
    const Vec3d origin = camera.is_orthographic ? camera.position + aside : camera.position;
    const Vec3d direction = camera.is_orthographic ? camera.forward : normalized(camera.forward + aside);
    GnomonRay ray{{}, 0, {}, std::numeric_limits<float>::infinity()};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        ray.origin[axis] = static_cast<float>(origin[axis]);
        ray.direction[axis] = static_cast<float>(direction[axis]);
    }
    return ray;
}

}  // namespace render
