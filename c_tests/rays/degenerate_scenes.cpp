#include "rays/degenerate_scenes.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "harness/rng.hpp"
#include "rays/vector.hpp"
#include "scene/load.hpp"
#include "scene/mesh_parts.hpp"

namespace harness {
namespace {

/// Separate triangles whose corners lie within `side` of a random point of the unit box, both spread over the first `dimensions`
/// axes alone.
Scene scattered(const char* name, std::size_t triangle_count, int dimensions) {
    Rng rng(1);
    const double side = dimensions == 0 ? 0 : std::pow(1 / double(triangle_count), 1.0 / dimensions);
    Mesh mesh{name, {}, {}};
    for (std::size_t i = 0; i < triangle_count; ++i) {
        Vec3d centre{};
        for (int axis = 0; axis < dimensions; ++axis) centre[axis] = rng.uniform();
        const auto corner = [&] {
            Vec3d position = centre;
            for (int axis = 0; axis < dimensions; ++axis) position[axis] += rng.uniform(-side, side);
            return add_vertex(mesh, position);
        };
        const std::uint32_t a = corner(), b = corner(), c = corner();
        add_triangle(mesh, a, b, c);
    }
    return {name, {std::move(mesh)}};
}

Scene in_plane(std::size_t triangle_count) { return scattered("all in a plane", triangle_count, 2); }
Scene on_line(std::size_t triangle_count) { return scattered("all on a line", triangle_count, 1); }
Scene in_point(std::size_t triangle_count) { return scattered("all in a point", triangle_count, 0); }
Scene identical(std::size_t triangle_count) { return generate_scene("identical", triangle_count); }
Scene none(std::size_t) { return {}; }

Scene one(std::size_t) {
    Mesh mesh{"one", {0, 0, 0, 1, 0, 0, 0, 1, 0}, {0, 1, 2}};
    return {"one", {std::move(mesh)}};
}

Scene huge_and_tiny(std::size_t triangle_count) {
    constexpr double huge = 1e4;
    Scene scene = scattered("one huge, the others tiny", triangle_count, 3);
    Mesh& mesh = scene.meshes.front();
    const std::uint32_t a = add_vertex(mesh, {-huge, -huge, 0.5}), b = add_vertex(mesh, {huge, -huge, 0.5});
    add_triangle(mesh, a, b, add_vertex(mesh, {0, huge, 0.5}));
    return scene;
}

/// The box of the scene's triangles, the huge one left out; the unit box where there is none.
Bounds box_of_interest(const Scene& scene) {
    const Bounds bounds = scene.bounds();
    Bounds box{{0, 0, 0}, {1, 1, 1}};
    if (!(bounds.lower[0] <= bounds.upper[0])) return box;
    constexpr double most = 2;  // the tiny ones lie in the unit box
    for (int axis = 0; axis < 3; ++axis) {
        box.lower[axis] = std::max(bounds.lower[axis], -most);
        box.upper[axis] = std::min(bounds.upper[axis], most);
    }
    return box;
}

Vec3d point_in(const Bounds& box, Rng& rng) {
    Vec3d point;
    for (int axis = 0; axis < 3; ++axis) point[axis] = std::lerp(box.lower[axis], box.upper[axis], rng.uniform());
    return point;
}

}  // namespace

const std::vector<DegenerateScene>& degenerate_scenes() {
    static const std::vector<DegenerateScene> scenes = {
        {"all in a plane", in_plane},
        {"all on a line", on_line},
        {"all in a point", in_point},
        {"one huge, the others tiny", huge_and_tiny},
        {"identical", identical},
        {"one", one},
        {"none", none},
    };
    return scenes;
}

std::vector<GnomonRay> degenerate_rays(const Scene& scene, std::size_t count) {
    const Bounds box = box_of_interest(scene), around{{-2, -2, -2}, {3, 3, 3}};
    Rng rng(2);
    std::vector<GnomonRay> rays;
    rays.reserve(count);
    while (rays.size() < count) {
        const bool within = rays.size() % 2 == 1;
        const Vec3d to = point_in(box, rng);
        Vec3d from = point_in(within ? box : around, rng);
        if (from == to) from = point_in(around, rng);  // a point has no two
        const Vec3d direction = to - from;
        GnomonRay ray{};
        for (int axis = 0; axis < 3; ++axis) {
            ray.origin[axis] = static_cast<float>(from[axis]);
            ray.direction[axis] = static_cast<float>(direction[axis]);
        }
        ray.t_max = std::numeric_limits<float>::infinity();
        rays.push_back(ray);
    }
    return rays;
}

}  // namespace harness
