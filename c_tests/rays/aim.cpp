#include "rays/aim.hpp"

#include <cmath>
#include <numbers>

#include "rays/vector.hpp"

namespace harness {
namespace {

constexpr float infinity = std::numeric_limits<float>::infinity();
/// A cell wall or a first split plane is at a multiple of this share of the scene's box.
constexpr int walls = 16;

}  // namespace

// Archimedes' projection.
Vec3d unit_direction(Rng& rng) {
    const double z = rng.uniform(-1, 1), angle = rng.uniform(0, 2 * std::numbers::pi), radius = std::sqrt(1 - z * z);
    return {radius * std::cos(angle), radius * std::sin(angle), z};
}

GnomonRay ray_of(const Vec3f& origin, const Vec3f& direction, float t_min, float t_max) {
    return {{origin[0], origin[1], origin[2]}, t_min, {direction[0], direction[1], direction[2]}, t_max};
}

GnomonRay ray_towards(const Vec3f& origin, const Vec3f& target) {
    return ray_of(origin, {target[0] - origin[0], target[1] - origin[1], target[2] - origin[2]});
}

bool has_direction(const GnomonRay& ray) { return ray.direction[0] != 0 || ray.direction[1] != 0 || ray.direction[2] != 0; }

Vec3f between(const std::pair<Vec3f, Vec3f>& edge, double along) {
    return to_float((1 - along) * to_double(edge.first) + along * to_double(edge.second));
}

Vec3f point_of(const std::array<Vec3f, 3>& triangle, double u, double v) {
    return to_float((1 - u - v) * to_double(triangle[0]) + u * to_double(triangle[1]) + v * to_double(triangle[2]));
}

std::vector<GnomonRay> aimed_rays(const Scene& scene, std::size_t count, Rng& rng) {
    const Bounds box = scene.bounds();
    const auto anywhere = [&](double margin) {
        Vec3d point;
        for (int axis = 0; axis < 3; ++axis) {
            const double reach = margin * (box.upper[axis] - box.lower[axis]);
            point[axis] = rng.uniform(box.lower[axis] - reach, box.upper[axis] + reach);
        }
        return point;
    };
    const auto on_wall = [&] {
        Vec3d point;
        for (int axis = 0; axis < 3; ++axis)
            point[axis] = box.lower[axis] + (box.upper[axis] - box.lower[axis]) * double(rng.below(walls + 1)) / walls;
        return point;
    };
    const auto on_triangle = [&](std::size_t kind) {
        const Mesh* mesh = nullptr;
        do mesh = &scene.meshes[rng.below(scene.meshes.size())];
        while (mesh->indices.empty());
        const std::size_t triangle = rng.below(mesh->triangle_count());
        const auto vertex = [&](std::size_t corner) {
            const std::size_t at = 3 * mesh->indices[3 * triangle + corner];
            return Vec3d{mesh->positions[at], mesh->positions[at + 1], mesh->positions[at + 2]};
        };
        if (kind == 0) return vertex(0);
        const double share = rng.uniform(0, 1);
        const Vec3d on_edge = (1 - share) * vertex(0) + share * vertex(1);
        return kind == 1 ? on_edge : 0.5 * on_edge + 0.5 * vertex(2);
    };
    std::vector<GnomonRay> rays(count);
    for (std::size_t i = 0; i < count; ++i) {
        Vec3d from = i % 7 == 6 ? on_wall() : anywhere(i % 5 == 4 ? 100.0 : 0.5);
        const Vec3d to = i % 7 < 4 ? on_triangle(i % 7 % 3) : on_wall();
        // Some in a plane across an axis, some along an axis.
        for (std::size_t axis = 0; axis < i / 7 % 4 % 3; ++axis) from[axis] = to[axis];
        GnomonRay& ray = rays[i];
        ray.t_min = i % 11 == 10 ? -infinity : 0.0f;
        ray.t_max = infinity;
        for (int axis = 0; axis < 3; ++axis) {
            ray.origin[axis] = static_cast<float>(from[axis]);
            ray.direction[axis] = static_cast<float>(to[axis]) - ray.origin[axis];
        }
    }
    return rays;
}

}  // namespace harness
