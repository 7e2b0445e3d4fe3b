// A view of a scene from outside.
#include <algorithm>
#include <cmath>
#include <limits>

#include "rays/rays.hpp"
#include "rays/vector.hpp"
#include "scene/load.hpp"

namespace harness {
namespace {

constexpr double widest_tangent = 0.36;  // of half the angle of view: about 40 degrees in all, a normal lens

/// Towards the corner of the box from which the orthographic area is largest, kept a three-quarter view: a flat box seen along an
/// axis shows little.
Vec3d viewing_direction(const Vec3d& extent) {
    const Vec3d area = {extent[1] * extent[2], extent[0] * extent[2], extent[0] * extent[1]};
    const double largest = std::max({area[0], area[1], area[2]});
    if (!(largest > 0)) return normalized({1, 1, 1});
    Vec3d towards_eye;
    for (int axis = 0; axis < 3; ++axis) towards_eye[axis] = std::max(area[axis] / largest, 0.5);
    return normalized(-towards_eye);
}

Vec3d corner(const Bounds& bounds, int index) {
    Vec3d point;
    for (int axis = 0; axis < 3; ++axis) point[axis] = (index >> axis & 1) ? bounds.upper[axis] : bounds.lower[axis];
    return point;
}

/// The least distance from `centre` at which all corners are within the angle of view.
double fitting_distance(const Camera& camera, const Bounds& bounds, const Vec3d& centre) {
    double distance = 0;
    for (int index = 0; index < 8; ++index) {
        const Vec3d offset = corner(bounds, index) - centre;
        const double aside = std::max(std::abs(dot(offset, camera.right)), std::abs(dot(offset, camera.up)));
        distance = std::max(distance, aside / widest_tangent - dot(offset, camera.forward));
    }
    return distance;
}

/// Tangents of the angles at which vertices are seen.
struct Window {
    double left = std::numeric_limits<double>::infinity(), right = -left, bottom = left, top = -left;
};

Window seen_window(const Camera& camera, const Scene& scene) {
    Window window;
    for (const Mesh& mesh : scene.meshes) {
        for (const std::uint32_t index : mesh.indices) {
            const float* position = &mesh.positions[3 * std::size_t{index}];
            const Vec3d offset = Vec3d{position[0], position[1], position[2]} - camera.position;
            const double depth = dot(offset, camera.forward);
            if (!(depth > 0 && std::isfinite(depth))) continue;
            const double x = dot(offset, camera.right) / depth, y = dot(offset, camera.up) / depth;
            window.left = std::min(window.left, x);
            window.right = std::max(window.right, x);
            window.bottom = std::min(window.bottom, y);
            window.top = std::max(window.top, y);
        }
    }
    return window;
}

}  // namespace

void Camera::aim(const Vec3d& direction) {
    forward = normalized(direction);
    right = normalized(cross(forward, {0, 1, 0}));
    up = cross(right, forward);
}

GnomonRay Camera::ray(double x, double y) const {
    const Vec3d direction = forward + (2 * x - 1) * half_width * right + (1 - 2 * y) * half_height * up;
    GnomonRay ray{};
    for (int axis = 0; axis < 3; ++axis) {
        ray.origin[axis] = static_cast<float>(position[axis]);
        ray.direction[axis] = static_cast<float>(direction[axis]);
    }
    ray.t_min = 0;
    ray.t_max = std::numeric_limits<float>::infinity();
    return ray;
}

Camera outside_camera(const Scene& scene) {
    const Bounds bounds = scene.bounds();
    if (!(bounds.lower[0] <= bounds.upper[0]))
        throw SceneError(scene.name + ": no triangle has a finite vertex, so there is nothing to look at");
    const Vec3d centre = 0.5 * (bounds.lower + bounds.upper);
    Camera camera;
    camera.aim(viewing_direction(bounds.upper - bounds.lower));
    const double distance = fitting_distance(camera, bounds, centre);
    camera.position = centre - (distance > 0 ? distance : 1.0) * camera.forward;

    // The box is fitted; what is in it is usually smaller and off its centre.
    const Window loose = seen_window(camera, scene);
    camera.aim(camera.forward + 0.5 * (loose.left + loose.right) * camera.right + 0.5 * (loose.bottom + loose.top) * camera.up);
    const Window window = seen_window(camera, scene);
    camera.half_width = std::max({-window.left, window.right, widest_tangent / 16});
    camera.half_height = std::max({-window.bottom, window.top, widest_tangent / 16});
    return camera;
}

}  // namespace harness
