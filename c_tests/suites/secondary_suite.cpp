// Rays that leave a surface where gnomon_offset_origin says do not hit it again, and stay inside what is closed: the 41st of the
// hard cases of accuracy.md. Beside it what happens to origin + t * direction.
#define DOCTEST_CONFIG_IMPLEMENT_WITH_MAIN
#include <doctest/doctest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <limits>
#include <numbers>
#include <optional>

#include "api/handles.hpp"
#include "backend/names.hpp"
#include "compare/describe.hpp"
#include "harness/ray_count.hpp"
#include "harness/rng.hpp"
#include "harness/triangles.hpp"
#include "rays/vector.hpp"
#include "scene/load.hpp"

using namespace harness;

namespace {

constexpr float infinity = std::numeric_limits<float>::infinity();

/// Where rays begin: inside a closed mesh, or anywhere before a triangle.
struct Place {
    Scene scene;
    std::optional<Vec3d> inside;
    /// Hits lie within the band of an edge again and again: only EXACT then is sure to take the right neighbour across it, and
    /// the leaks of others are printed alone.
    bool has_hits_in_bands = false;
};

Place closed(const char* name, std::size_t triangle_count, const Vec3d& inside) {
    return {generate_scene(name, triangle_count), inside, false};
}

Place open(const char* name, std::size_t triangle_count) { return {generate_scene(name, triangle_count), {}, false}; }

Place moved(Place place, double scale, double offset) {
    for (Mesh& mesh : place.scene.meshes)
        for (float& coordinate : mesh.positions) coordinate = static_cast<float>(scale * coordinate + offset);
    if (place.inside)
        for (double& coordinate : *place.inside) coordinate = scale * coordinate + offset;
    return place;
}

Place with_hits_in_bands(Place place) {
    place.has_hits_in_bands = true;
    return place;
}

struct Engine {
    std::uint32_t structure, precision, compact;
    std::string name() const {
        return std::string(name_of(structure_names, structure)) + (compact != 0 ? " compact " : " ") +
               name_of(precision_names, precision);
    }
};

std::vector<Engine> engines() {
    std::vector<Engine> all;
    for (const NamedValue& structure : structure_names)
        if (structure.value != GNOMON_STRUCTURE_AUTO) all.push_back({structure.value, GNOMON_PRECISION_ACCURATE, 0});
    all.push_back({GNOMON_STRUCTURE_WIDE_BVH, GNOMON_PRECISION_ACCURATE, 1});
    for (const std::uint32_t precision : {GNOMON_PRECISION_FAST, GNOMON_PRECISION_EXACT})
        all.push_back({GNOMON_STRUCTURE_WIDE_BVH, precision, 0});
    return all;
}

SceneHandle build(const Scene& scene, const Engine& engine) {
    const BuilderHandle builder = new_builder();
    for (const Mesh& mesh : scene.meshes) {
        const GnomonTriangles triangles = triangles_of(mesh);
        REQUIRE(gnomon_scene_builder_add_triangles(builder.get(), &triangles, nullptr) == GNOMON_OK);
    }
    GnomonBuildOptions options;
    gnomon_build_options_init(&options);
    options.structure = engine.structure;
    options.precision = engine.precision;
    options.compact = engine.compact;
    GnomonScene* built = nullptr;
    REQUIRE_MESSAGE(gnomon_scene_build(builder.get(), &options, &built) == GNOMON_OK, gnomon_last_error());
    return SceneHandle(built);
}

Vec3d unit_direction(Rng& rng) {
    const double z = rng.uniform(-1, 1), angle = rng.uniform(0, 2 * std::numbers::pi), radius = std::sqrt(1 - z * z);
    return {radius * std::cos(angle), radius * std::sin(angle), z};
}

GnomonRay ray_of(const Vec3d& origin, const Vec3d& direction) {
    GnomonRay ray{{}, 0, {}, infinity};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        ray.origin[axis] = static_cast<float>(origin[axis]);
        ray.direction[axis] = static_cast<float>(direction[axis]);
    }
    return ray;
}

GnomonRay first_ray(const Place& place, Rng& rng) {
    if (place.inside) return ray_of(*place.inside, unit_direction(rng));
    const Mesh& mesh = place.scene.meshes[rng.below(place.scene.meshes.size())];
    const auto geometry_id = static_cast<std::uint32_t>(&mesh - place.scene.meshes.data());
    const auto [a, b, c] = place.scene.triangle(geometry_id, static_cast<std::uint32_t>(rng.below(mesh.triangle_count())));
    const double u = rng.uniform(), v = rng.uniform() * (1 - u);
    const Vec3d target = (1 - u - v) * to_double(a) + u * to_double(b) + v * to_double(c);
    const double distance = length(to_double(b) - to_double(a)) + length(to_double(c) - to_double(a));
    const Vec3d direction = unit_direction(rng);
    return ray_of(target - distance * direction, direction);
}

/// To the side that the ray came from; now and then hardly off the surface, but not so little that rounding the normal and the
/// direction to float could change the side.
Vec3d next_direction(const GnomonRay& ray, const GnomonSurfacePoint& point, Rng& rng) {
    constexpr double least = 0x1p-20;
    const Vec3d normal = to_double(point.normal);
    Vec3d direction = unit_direction(rng);
    const double along = dot(direction, normal);
    const double kept = rng.below(4) == 0 ? std::pow(10, rng.uniform(-8, -1)) : 1;
    const double wanted = std::copysign(std::max(least, kept * std::abs(along)), -dot(to_double(ray.direction), normal));
    return direction + (wanted - along) * normal;
}

bool same_surface(const GnomonHit& a, const GnomonHit& b) {
    return a.geometry_id == b.geometry_id && a.primitive_id == b.primitive_id;
}

struct Tally {
    std::size_t rays = 0, self_hits = 0, leaks = 0, leaks_in_bands = 0, naive_self_hits = 0, within_roundoff = 0, coordinates = 0;
};

bool naive_hits_itself(const SceneHandle& scene, const GnomonRay& ray, const GnomonHit& hit, GnomonRay next) {
    for (int axis = 0; axis < 3; ++axis) next.origin[axis] = ray.origin[axis] + hit.t * ray.direction[axis];
    GnomonHit again;
    return gnomon_intersect(scene.get(), &next, &again) && same_surface(hit, again);
}

/// Paths of some bounces, until `count` rays have left a surface. The first faults are printed, and fail the test.
void follow(const SceneHandle& scene, const Place& place, const Engine& engine, std::size_t count, Tally& tally) {
    // FAST computes t in float: a surface that is nearer than that rounds may be passed.
    const bool may_leak =
        engine.precision == GNOMON_PRECISION_FAST || (place.has_hits_in_bands && engine.precision != GNOMON_PRECISION_EXACT);
    constexpr int most_bounces = 8;
    constexpr std::size_t printed = 3;
    Rng rng(1);
    const std::size_t end = tally.rays + count;
    while (tally.rays < end) {
        GnomonRay ray = first_ray(place, rng);
        GnomonHit hit;
        bool is_hit = gnomon_intersect(scene.get(), &ray, &hit);
        for (int bounce = 0; is_hit && bounce < most_bounces; ++bounce) {
            GnomonSurfacePoint point;
            REQUIRE_MESSAGE(gnomon_surface_point(scene.get(), &ray, &hit, &point) == GNOMON_OK, gnomon_last_error()
                                                                                                    << ": " << ray_text(ray));
            for (int axis = 0; axis < 3; ++axis)
                tally.within_roundoff += point.error[axis] <= 0x1p-24f * std::abs(point.position[axis]);
            tally.coordinates += 3;
            GnomonRay next = ray_of({0, 0, 0}, next_direction(ray, point, rng));
            REQUIRE_MESSAGE(gnomon_offset_origin(&point, next.direction, next.origin) == GNOMON_OK, gnomon_last_error()
                                                                                                        << ": " << ray_text(ray));
            tally.naive_self_hits += naive_hits_itself(scene, ray, hit, next);

            GnomonHit next_hit;
            is_hit = gnomon_intersect(scene.get(), &next, &next_hit);
            const bool hits_itself = is_hit && same_surface(hit, next_hit), leaves = !is_hit && place.inside,
                       leaks = leaves && !may_leak;
            ++tally.rays;
            tally.self_hits += hits_itself;
            tally.leaks += leaks;
            tally.leaks_in_bands += leaves && may_leak;
            if ((hits_itself || leaks) && tally.self_hits + tally.leaks <= printed)
                FAIL_CHECK(engine.name() << (leaks ? " leaks in " : " hits itself in ") << place.scene.name << ": "
                                         << ray_text(ray) << " was " << hit_text(hit) << ", then " << ray_text(next) << " was "
                                         << hit_text(next_hit));
            // At t = 0 the origin is on another surface, and which side of that it came from has no answer.
            is_hit = is_hit && next_hit.t > 0;
            ray = next, hit = next_hit;
        }
    }
}

void check_class(const char* name, const std::vector<Place>& places) {
    constexpr std::size_t most_for_brute_force = 200, most_for_bsp_tree = 10'000;
    const std::size_t ray_count = ray_count_or(1'000'000);
    std::printf("%-10s %-26s %10s %10s %10s %10s %16s %18s\n", name, "engine", "rays", "self-hits", "leaks", "in bands",
                "self-hits, O+tD", "error <= u |P|, %");
    for (const Engine& engine : engines()) {
        Tally tally;
        for (const Place& place : places) {
            const std::size_t triangle_count = place.scene.triangle_count();
            if (engine.structure == GNOMON_STRUCTURE_BRUTE_FORCE && triangle_count > most_for_brute_force) continue;
            if (engine.structure == GNOMON_STRUCTURE_BSP_TREE && triangle_count > most_for_bsp_tree) continue;
            follow(build(place.scene, engine), place, engine, ray_count / places.size() + 1, tally);
        }
        if (tally.rays == 0) continue;
        std::printf("%-10s %-26s %10zu %10zu %10zu %10zu %16zu %18.3f\n", "", engine.name().c_str(), tally.rays, tally.self_hits,
                    tally.leaks, tally.leaks_in_bands, tally.naive_self_hits,
                    100 * static_cast<double>(tally.within_roundoff) / static_cast<double>(tally.coordinates));
        std::fflush(stdout);
        CAPTURE(engine.name());
        CHECK(tally.self_hits == 0);
        CHECK(tally.leaks == 0);
    }
}

template <typename Call>
double nanoseconds(std::size_t count, Call call) {
    const auto start = std::chrono::steady_clock::now();
    for (std::size_t i = 0; i < count; ++i) call(i);
    return std::chrono::duration<double, std::nano>(std::chrono::steady_clock::now() - start).count() /
           static_cast<double>(count);
}

std::uint64_t bytes_of(const SceneHandle& scene) {
    GnomonSceneStats stats;
    REQUIRE(gnomon_scene_stats(scene.get(), sizeof stats, &stats) == GNOMON_OK);
    return stats.bytes;
}

}  // namespace

TEST_CASE("paths_inside_closed_meshes_never_hit_what_they_leave_nor_leak") {
    check_class("closed",
                {closed("icosphere", 80, {0, 0, 0}), closed("icosphere", 5'000, {0, 0, 0}), closed("uv_sphere", 5'000, {0, 0, 0}),
                 closed("cube_grid", 100, {0, 0, 0}), closed("cube_grid", 5'000, {0, 0, 0}), closed("torus", 5'000, {1, 0, 0})});
}

TEST_CASE("paths_among_needles_never_hit_what_they_leave_nor_leak") {
    check_class("needles", {open("needles", 200), open("needles", 5'000), closed("fan_valence", 2'000, {0, 0, 0})});
}

TEST_CASE("paths_among_huge_triangles_never_hit_what_they_leave_nor_leak") {
    check_class("huge", {moved(closed("cube_grid", 12, {0, 0, 0}), 1e6, 0),
                         with_hits_in_bands(moved(closed("cube_grid", 12, {0, 0, 0}), 1e6, 1e6 - 1)),
                         moved(closed("icosphere", 80, {0, 0, 0}), 1e6, 1234), open("teapot_in_stadium", 2'000)});
}

TEST_CASE("paths_far_from_the_origin_and_in_tiny_meshes_never_hit_what_they_leave_nor_leak") {
    check_class("far, tiny",
                {moved(closed("icosphere", 80, {0, 0, 0}), 1, 1e3), moved(closed("cube_grid", 100, {0, 0, 0}), 1, 1e5),
                 moved(closed("icosphere", 1'000, {0, 0, 0}), 1e3, 1e6), moved(open("soup", 1'000), 1, 1e5),
                 moved(closed("icosphere", 1'000, {0, 0, 0}), 1e-30, 0)});
}

TEST_CASE("table_of_places_takes_four_bytes_a_triangle") {
    const std::size_t ray_count = ray_count_or(1'000'000);
    const Place place = closed("icosphere", 300'000, {0, 0, 0});
    for (const Engine& engine : {Engine{GNOMON_STRUCTURE_WIDE_BVH, GNOMON_PRECISION_ACCURATE, 0},
                                 Engine{GNOMON_STRUCTURE_BVH, GNOMON_PRECISION_ACCURATE, 0}}) {
        const SceneHandle scene = build(place.scene, engine);
        Rng rng(7);
        std::vector<GnomonRay> rays(ray_count);
        std::vector<GnomonHit> hits(ray_count);
        std::vector<GnomonSurfacePoint> points(ray_count);
        for (GnomonRay& ray : rays) ray = ray_of(0.5 * unit_direction(rng), unit_direction(rng));
        const double of_ray = nanoseconds(ray_count, [&](std::size_t i) { gnomon_intersect(scene.get(), &rays[i], &hits[i]); });

        const std::uint64_t bytes = bytes_of(scene);
        const double first =
            nanoseconds(1, [&](std::size_t) { gnomon_surface_point(scene.get(), &rays[0], &hits[0], &points[0]); });
        const double table_bytes =
            static_cast<double>(bytes_of(scene) - bytes) / static_cast<double>(place.scene.triangle_count());
        const double of_point =
            nanoseconds(ray_count, [&](std::size_t i) { gnomon_surface_point(scene.get(), &rays[i], &hits[i], &points[i]); });
        std::vector<Vec3f> origins(ray_count);
        const double of_origin = nanoseconds(ray_count, [&](std::size_t i) {
            const float back[3] = {-rays[i].direction[0], -rays[i].direction[1], -rays[i].direction[2]};
            gnomon_offset_origin(&points[i], back, origins[i].data());
        });
        // The other way to the triangle: the ray again, for its hit alone.
        GnomonHit again;
        const double of_retrace = nanoseconds(ray_count, [&](std::size_t i) {
            GnomonRay ray = rays[i];
            ray.t_min = ray.t_max = hits[i].t;
            gnomon_intersect(scene.get(), &ray, &again);
        });
        std::printf(
            "%-26s ns: ray %.0f, ray again for [t, t] %.0f, point %.0f, origin %.0f; first point %.1f ms, table %.2f bytes a "
            "triangle\n",
            engine.name().c_str(), of_ray, of_retrace, of_point, of_origin, first / 1e6, table_bytes);
        CHECK(table_bytes < 4.01);
    }
}
