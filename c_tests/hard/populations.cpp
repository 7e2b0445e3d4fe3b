#include "hard/populations.hpp"

#include <cmath>

#include "rays/aim.hpp"
#include "rays/vector.hpp"
#include "scene/load.hpp"
#include "scene/mesh_parts.hpp"

namespace harness {
namespace {

/// Few enough that the oracle and brute force keep up, enough for every structure to have cells and nodes.
constexpr std::size_t triangle_count = 1'000;

using Corners = std::array<Vec3f, 3>;

Vec3d point_in_cube(double half_side, Rng& rng) {
    Vec3d point;
    for (double& x : point) x = rng.uniform(-half_side, half_side);
    return point;
}

Scene separate_triangles(const char* name, const std::function<std::array<Vec3d, 3>()>& next) {
    Mesh mesh{name, {}, {}};
    for (std::size_t i = 0; i < triangle_count; ++i) {
        const auto [a, b, c] = next();
        const std::uint32_t first = add_vertex(mesh, a);
        add_triangle(mesh, first, add_vertex(mesh, b), add_vertex(mesh, c));
    }
    return {name, {std::move(mesh)}};
}

Scene soup(double size, Rng& rng) {
    return separate_triangles("soup", [&]() -> std::array<Vec3d, 3> {
        const Vec3d centre = point_in_cube(1, rng);
        const Vec3d a = point_in_cube(size, rng), b = point_in_cube(size, rng), c = point_in_cube(size, rng);
        return {centre + a, centre + b, centre + c};
    });
}

/// A ray for each of `count` random triangles; one that rounding left without a direction is made again.
std::vector<GnomonRay> rays_at(const Scene& scene, std::size_t count, Rng& rng,
                               const std::function<GnomonRay(const Corners&)>& make_ray) {
    std::vector<GnomonRay> rays(count);
    for (GnomonRay& ray : rays) {
        do ray = make_ray(scene.triangle(0, static_cast<std::uint32_t>(rng.below(scene.triangle_count()))));
        while (!has_direction(ray));
    }
    return rays;
}

Vec3f inner_point(const Corners& triangle, Rng& rng) {
    const double u = rng.uniform();
    return point_of(triangle, u, (1 - u) * rng.uniform());
}

GnomonRay ray_from(double distance, const Vec3f& target, Rng& rng) {
    return ray_towards(to_float(to_double(target) + distance * unit_direction(rng)), target);
}

/// From between 1 and 3 units away.
GnomonRay ray_at(const Vec3f& target, Rng& rng) { return ray_from(rng.uniform(1, 3), target, rng); }

}  // namespace

Trial soup_trial(double size, std::size_t count, Rng& rng) {
    Scene scene = soup(size, rng);
    auto rays = rays_at(scene, count, rng, [&](const Corners& t) { return ray_at(inner_point(t, rng), rng); });
    return {std::move(scene), std::move(rays)};
}

Trial needle_trial(double width, std::size_t count, Rng& rng) {
    Scene scene = separate_triangles("needles", [&]() -> std::array<Vec3d, 3> {
        const Vec3d tail = point_in_cube(1, rng), along = unit_direction(rng);
        const Vec3d across = normalized(cross(along, unit_direction(rng)));
        const double length = rng.uniform(0.1, 1), foot = rng.uniform();
        return {tail, tail + length * along, tail + (foot * length) * along + (width * length) * across};
    });
    auto rays = rays_at(scene, count, rng, [&](const Corners& t) { return ray_at(inner_point(t, rng), rng); });
    return {std::move(scene), std::move(rays)};
}

Trial grazing_trial(double angle, std::size_t count, Rng& rng) {
    Scene scene = soup(0.1, rng);
    auto rays = rays_at(scene, count, rng, [&](const Corners& t) {
        const Vec3d a = to_double(t[0]);
        const Vec3d normal = normalized(cross(to_double(t[1]) - a, to_double(t[2]) - a));
        const Vec3d in_plane = normalized(cross(normal, unit_direction(rng)));
        const Vec3f target = inner_point(t, rng);
        const Vec3d away = std::cos(angle) * in_plane + std::sin(angle) * normal;
        return ray_towards(to_float(to_double(target) + rng.uniform(1, 3) * away), target);
    });
    return {std::move(scene), std::move(rays)};
}

Trial far_origin_trial(double distance, std::size_t count, Rng& rng) {
    Scene scene = soup(0.1, rng);
    auto rays = rays_at(scene, count, rng, [&](const Corners& t) { return ray_from(distance, inner_point(t, rng), rng); });
    return {std::move(scene), std::move(rays)};
}

Trial far_mesh_trial(double offset, std::size_t count, Rng& rng) {
    Scene scene = generate_scene("icosphere", triangle_count);
    for (float& x : scene.meshes[0].positions) x = static_cast<float>(x + offset);
    auto rays = rays_at(scene, count, rng, [&](const Corners& t) { return ray_at(inner_point(t, rng), rng); });
    return {std::move(scene), std::move(rays)};
}

Trial near_hit_trial(double distance, std::size_t count, Rng& rng) {
    Scene scene = soup(1, rng);
    auto rays = rays_at(scene, count, rng, [&](const Corners& t) {
        const Vec3d away = unit_direction(rng);
        return ray_of(to_float(to_double(inner_point(t, rng)) + distance * away), to_float(-away));
    });
    return {std::move(scene), std::move(rays)};
}

Trial edge_trial(double inside, std::size_t count, Rng& rng) {
    Scene scene = soup(0.1, rng);
    auto rays = rays_at(scene, count, rng,
                        [&](const Corners& t) { return ray_at(point_of(t, (1 - inside) * rng.uniform(), inside), rng); });
    return {std::move(scene), std::move(rays)};
}

const std::vector<Population>& populations() {
    static const std::vector<Population> all = [] {
        std::vector<Population> list;
        const auto add = [&](const char* name, const char* what, Trial (*make)(double, std::size_t, Rng&), double parameter) {
            list.push_back({name, what, [=](std::size_t count, Rng& rng) { return make(parameter, count, rng); }});
        };
        add("soup_1e-1", "triangles of size 0.1", soup_trial, 0.1);
        add("soup_1e-3", "triangles of size 1e-3", soup_trial, 1e-3);
        add("needles_1e-3", "1e-3 as wide as long", needle_trial, 1e-3);
        add("needles_1e-5", "1e-5 as wide as long", needle_trial, 1e-5);
        add("needles_1e-6", "1e-6 as wide as long", needle_trial, 1e-6);
        add("grazing_1e-2", "1e-2 rad above the plane", grazing_trial, 1e-2);
        add("grazing_1e-4", "1e-4 rad above the plane", grazing_trial, 1e-4);
        add("grazing_1e-6", "1e-6 rad above the plane", grazing_trial, 1e-6);
        add("origin_1e3", "from 1e3 away", far_origin_trial, 1e3);
        add("origin_1e5", "from 1e5 away", far_origin_trial, 1e5);
        add("mesh_at_1e3", "a sphere of radius 1, 1e3 from the origin", far_mesh_trial, 1e3);
        add("mesh_at_1e5", "a sphere of radius 1, 1e5 from the origin", far_mesh_trial, 1e5);
        add("near_hit_1e-4", "1e-4 before a triangle of size 1", near_hit_trial, 1e-4);
        add("inside_edge_1e-6", "1e-6 inside an edge", edge_trial, 1e-6);
        add("at_edge", "at an edge", edge_trial, 0);
        return list;
    }();
    return all;
}

}  // namespace harness
