#include "hard/room.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "rays/aim.hpp"
#include "rays/vector.hpp"
#include "scene/load.hpp"

namespace harness {
namespace {

/// The meshes of classes 1 to 5 have a radius of about 1; class 4 moves their vertices to multiples of this.
constexpr double dyadic_step = 0x1p-10;

/// Multiples of the mesh's own step: with them the way to an edge midpoint of class 4 is an exact float.
float snap(double x, double extent) {
    const double step = dyadic_step * std::exp2(std::floor(std::log2(extent / 2)));
    return static_cast<float>(std::round(x / step) * step);
}

/// An odd number of exact hits ahead in each of some directions, and none of the surface near.
bool is_inside(const Oracle& oracle, const Vec3f& point, double extent, Rng& rng) {
    constexpr int direction_count = 8;
    const double clearance = extent / 50;
    for (int i = 0; i < direction_count; ++i) {
        const std::vector<Candidate> candidates = oracle.candidates(ray_of(point, to_float(unit_direction(rng))));
        const bool is_clear = std::all_of(candidates.begin(), candidates.end(), [&](const Candidate& c) {
            return c.exact_hit && !c.in_band && std::abs(c.t_exact) > clearance;
        });
        const auto ahead = std::count_if(candidates.begin(), candidates.end(), [](const Candidate& c) { return c.t > 0; });
        if (!is_clear || ahead % 2 == 0) return false;
    }
    return true;
}

/// The scene with each coordinate scaled, moved along its axis, and rounded once.
Scene moved(const Scene& scene, double scale, const Vec3d& offset) {
    Scene result = scene;
    for (Mesh& mesh : result.meshes)
        for (std::size_t i = 0; i < mesh.positions.size(); ++i)
            mesh.positions[i] = static_cast<float>(scale * mesh.positions[i] + offset[i % 3]);
    char where[96];
    std::snprintf(where, sizeof where, " x %g + (%g, %g, %g)", scale, offset[0], offset[1], offset[2]);
    result.name += where;
    return result;
}

std::vector<Scene> meshes_at_origin() {
    return {generate_scene("icosphere", 80),  generate_scene("icosphere", 5'000), generate_scene("uv_sphere", 5'000),
            generate_scene("cube_grid", 100), generate_scene("cube_grid", 5'000), generate_scene("torus", 5'000)};
}

std::vector<Scene> dyadic_meshes() {
    std::vector<Scene> meshes = meshes_at_origin();
    for (Scene& scene : meshes)
        for (Mesh& mesh : scene.meshes)
            for (float& x : mesh.positions) x = static_cast<float>(std::round(x / dyadic_step) * dyadic_step);
    return meshes;
}

std::vector<Scene> fans() {
    std::vector<Scene> meshes;
    for (const std::size_t valence : {3, 4, 5, 8, 30, 100, 300, 1'000}) {
        Scene& mesh = meshes.emplace_back(generate_scene("fan_valence", 2 * valence));
        mesh.name.append(" ").append(std::to_string(valence));
    }
    return meshes;
}

std::vector<Scene> far_meshes() {
    std::vector<Scene> meshes;
    for (const char* name : {"icosphere", "uv_sphere", "cube_grid", "torus"}) {
        for (const double offset : {1e3, 1e6}) {
            meshes.push_back(moved(generate_scene(name, 1'000), 1, {offset, offset, offset}));
            meshes.push_back(moved(generate_scene(name, 1'000), 1e3, {offset, offset, offset}));
        }
    }
    return meshes;
}

/// Floats are 1 apart at 1e7.
std::vector<Scene> small_far_meshes() {
    std::vector<Scene> meshes;
    for (const char* name : {"icosphere", "cube_grid"})
        for (const double radius : {32, 256}) meshes.push_back(moved(generate_scene(name, 80), radius, {1e7, 1e7, 1e7}));
    return meshes;
}

std::vector<Scene> surveyed_meshes() {
    std::vector<Scene> meshes;
    for (const char* name : {"icosphere", "cube_grid", "torus"})
        meshes.push_back(moved(generate_scene(name, 1'000), 10, {148376, 1234, -223423}));
    return meshes;
}

GnomonRay anywhere(const Room& room, Rng& rng) { return ray_of(room.point(rng), to_float(unit_direction(rng))); }

GnomonRay at_vertex(const Room& room, Rng& rng) { return ray_towards(room.point(rng), room.edge(rng).first); }

GnomonRay at_edge(const Room& room, Rng& rng) { return ray_towards(room.point(rng), between(room.edge(rng), rng.uniform())); }

GnomonRay at_midpoint(const Room& room, Rng& rng) { return ray_towards(room.point(rng), between(room.edge(rng), 0.5)); }

GnomonRay at_any(const Room& room, Rng& rng) {
    constexpr Aim aims[] = {anywhere, at_vertex, at_edge, at_midpoint};
    return aims[rng.below(std::size(aims))](room, rng);
}

}  // namespace

Room::Room(Scene scene, Rng& rng) : scene_(std::move(scene)) {
    const Oracle oracle(scene_);
    const Bounds box = scene_.bounds();
    constexpr std::size_t point_count = 64;
    while (points_.size() < point_count) {
        Vec3f point;
        for (std::size_t axis = 0; axis < 3; ++axis)
            point[axis] = snap(rng.uniform(box.lower[axis], box.upper[axis]), box.upper[axis] - box.lower[axis]);
        if (is_inside(oracle, point, box.upper[0] - box.lower[0], rng)) points_.push_back(point);
    }
}

std::pair<Vec3f, Vec3f> Room::edge(Rng& rng) const {
    const auto triangle = scene_.triangle(0, static_cast<std::uint32_t>(rng.below(scene_.triangle_count())));
    const std::size_t first = rng.below(3);
    return {triangle[first], triangle[(first + 1) % 3]};
}

std::vector<GnomonRay> aim_all(const Room& room, Aim aim, std::size_t count, Rng& rng) {
    std::vector<GnomonRay> rays(count);
    for (GnomonRay& ray : rays) {
        do ray = aim(room, rng);
        while (!has_direction(ray));
    }
    return rays;
}

const std::vector<RoomClass>& room_classes() {
    static const std::vector<RoomClass> classes = {
        {1, "random rays inside closed meshes", meshes_at_origin, anywhere},
        {2, "rays aimed at vertices", meshes_at_origin, at_vertex},
        {3, "rays aimed at shared edges", meshes_at_origin, at_edge},
        {4, "rays aimed at edge midpoints, dyadic coordinates", dyadic_meshes, at_midpoint},
        {5, "vertices of valence 3 to 1000", fans, at_any},
        {8, "closed meshes at 1e3 to 1e6", far_meshes, at_any},
        {9, "closed meshes at 1e7 with an extent of 64 ulp and more", small_far_meshes, at_any},
        {10, "closed meshes at (148376, 1234, -223423)", surveyed_meshes, at_any},
    };
    return classes;
}

}  // namespace harness
