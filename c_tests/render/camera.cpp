#include "render/camera.hpp"

#include <algorithm>

#include "rays/rays.hpp"
#include "rays/vector.hpp"

namespace render {

namespace {

constexpr double usual_aspect = 16.0 / 9;

}  // namespace

double aspect_of(const Camera& camera) { return camera.half_width > 0 ? camera.half_width / camera.half_height : usual_aspect; }

Camera fitted(Camera camera, int width, int height) {
    const double aspect = double(width) / height;
    camera.half_height = std::max(camera.half_height, camera.half_width / aspect);
    camera.half_width = aspect * camera.half_height;
    return camera;
}

Camera default_camera(const RenderScene& scene, const std::string& spec) {
    constexpr double margin = 1.06;
    harness::Scene geometry{spec, {}};
    for (const Surface& surface : scene.surfaces) geometry.meshes.push_back(surface.mesh);
    const harness::Camera view = harness::outside_camera(geometry);
    const double half_height = margin * std::max(view.half_height, view.half_width / usual_aspect);
    return {"default", view.position, view.right, view.up, view.forward, half_height, usual_aspect * half_height, false};
}

Camera looking_at(const std::string& name, const Vec3d& position, const Vec3d& target, double half_height, double aspect) {
    using namespace harness;
    harness::Camera view;
    view.aim(target - position);
    return {name, position, view.right, view.up, view.forward, half_height, aspect * half_height, false};
}

}  // namespace render
