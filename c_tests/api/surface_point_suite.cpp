// Points of surfaces and where rays leave them, in every structure, precision and ISA.
#include <doctest/doctest.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <string>
#include <thread>
#include <vector>

#include "api/fixtures.hpp"

using namespace harness;

namespace {

GnomonSurfacePoint surface_point(const SceneHandle& scene, const GnomonRay& ray) {
    const GnomonHit hit = intersect(scene, ray);
    GnomonSurfacePoint point;
    std::memset(&point, 0xA5, sizeof point);
    REQUIRE_MESSAGE(gnomon_surface_point(scene.get(), &ray, &hit, &point) == GNOMON_OK, last_error());
    return point;
}

/// The ray from where `point` is left in that direction.
GnomonRay leave(const GnomonSurfacePoint& point, float x, float y, float z) {
    GnomonRay ray{{kNan, kNan, kNan}, 0, {x, y, z}, kInfinity};
    REQUIRE_MESSAGE(gnomon_offset_origin(&point, ray.direction, ray.origin) == GNOMON_OK, last_error());
    return ray;
}

bool is(const float (&vector)[3], float x, float y, float z) { return vector[0] == x && vector[1] == y && vector[2] == z; }

bool is_miss(const GnomonHit& hit) { return hit.geometry_id == GNOMON_INVALID_ID; }

GnomonSpheres spheres(const float* balls, std::size_t count) { return {balls, 16, balls + 3, 16, count}; }

SceneHandle build(const BuilderHandle& builder, const GnomonBuildOptions& options) {
    GnomonScene* scene = nullptr;
    REQUIRE_MESSAGE(gnomon_scene_build(builder.get(), &options, &scene) == GNOMON_OK, last_error());
    return SceneHandle(scene);
}

}  // namespace

TEST_CASE("point_of_a_triangle_has_position_error_and_unit_normal") {
    const TriangleMesh big{{0, 0, 1, 4, 0, 1, 0, 4, 1}, {0, 1, 2}};
    for (const Configuration& configuration : all_configurations()) {
        CAPTURE(configuration.name);
        const SceneHandle scene = build_scene({unit_triangle(-1), big}, configuration.options);
        const GnomonSurfacePoint point = surface_point(scene, {{0.1f, 1, 2}, 0, {0, 0, -1}, 10});
        CHECK(is(point.position, 0.1f, 1, 1));
        for (const float error : point.error) CHECK((error >= 0 && error < 1e-12f));
        CHECK(is(point.normal, 0, 0, 1));
        CHECK((point.surface == GNOMON_SURFACE_TRIANGLE && point.precision == configuration.options.precision));
        CHECK(is_miss(intersect(scene, leave(point, 0.5f, 0, 1e-6f))));
        CHECK(intersect(scene, leave(point, 0, 0, -3)).geometry_id != 1);
    }
}

TEST_CASE("every_triangle_of_every_structure_is_found_again") {
    const TriangleMesh low = flat_grid(6, 0), high = flat_grid(5, 1);
    for (const Configuration& configuration : all_configurations()) {
        CAPTURE(configuration.name);
        const SceneHandle scene = build_scene({low, high}, configuration.options);
        std::size_t wrong = 0;
        for (int x = 0; x < 6; ++x) {
            for (int y = 0; y < 6; ++y) {
                for (const float share : {0.25f, 0.75f}) {
                    const GnomonRay ray = ray_down(float(x) + share, float(y) + share);
                    const GnomonSurfacePoint point = surface_point(scene, ray);
                    const float height = x < 5 && y < 5 ? 1 : 0;
                    wrong += !is(point.position, ray.origin[0], ray.origin[1], height);
                }
            }
        }
        CHECK(wrong == 0);
    }
}

TEST_CASE("point_of_a_sphere_is_left_to_the_outside_and_to_the_inside") {
    const float balls[] = {9, 9, 9, 1, 0, 0, 0, 1.5f};
    const TriangleMesh floor = flat_grid(2, -4);
    for (const bool has_triangles : {false, true}) {
        const BuilderHandle builder = new_builder();
        const GnomonTriangles triangles = floor.view();
        const GnomonSpheres both = spheres(balls, 2);
        if (has_triangles) REQUIRE(gnomon_scene_builder_add_triangles(builder.get(), &triangles, nullptr) == GNOMON_OK);
        REQUIRE(gnomon_scene_builder_add_spheres(builder.get(), &both, nullptr) == GNOMON_OK);
        for (const Configuration& configuration : all_configurations()) {
            CAPTURE(configuration.name);
            const SceneHandle scene = build(builder, configuration.options);
            const GnomonSurfacePoint point = surface_point(scene, ray_down(0, 0));
            CHECK((is(point.position, 0, 0, 1.5f) && is(point.normal, 0, 0, 1) && point.surface == GNOMON_SURFACE_SPHERE));
            CHECK(is_miss(intersect(scene, leave(point, 0, 0.5f, 1e-5f))));
            CHECK(is_miss(intersect(scene, leave(point, 1, 0, 0))));
            const GnomonRay inward = leave(point, 0, 0, -1);
            const GnomonHit far_side = intersect(scene, inward);
            CHECK((far_side.primitive_id == 1 && std::abs(far_side.t - 3) < 1e-6f));
            GnomonSurfacePoint leaving;
            REQUIRE(gnomon_surface_point(scene.get(), &inward, &far_side, &leaving) == GNOMON_OK);
            CHECK((is(leaving.position, 0, 0, -1.5f) && is(leaving.normal, 0, 0, -1)));
            if (has_triangles) {
                const GnomonSurfacePoint below = surface_point(scene, {{0.25f, 0.25f, -2}, 0, {0, 0, -1}, kInfinity});
                CHECK((is(below.position, 0.25f, 0.25f, -4) && below.surface == GNOMON_SURFACE_TRIANGLE));
            }
        }
    }
}

TEST_CASE("ray_along_a_surface_leaves_it_to_the_normals_side") {
    const SceneHandle scene = build_scene({unit_triangle(1)});
    const GnomonSurfacePoint point = surface_point(scene, ray_down(0.25f, 0.25f));
    const GnomonRay along = leave(point, -1, 0.5f, 0);
    CHECK(along.origin[2] > 1);
    CHECK(is_miss(intersect(scene, along)));
}

TEST_CASE("long_and_short_directions_leave_a_plane_through_zero") {
    const SceneHandle scene = build_scene({flat_grid(3)});
    const GnomonSurfacePoint point = surface_point(scene, ray_down(1.25f, 1.5f));
    for (const float length : {1e-38f, 1e-20f, 1.0f, 1e20f, 1e38f}) {
        for (const float slope : {1.0f, 1e-6f}) {
            CAPTURE(length);
            CAPTURE(slope);
            CHECK(is_miss(intersect(scene, leave(point, length, 0, slope * length))));
            CHECK(is_miss(intersect(scene, leave(point, length, 0, -slope * length))));
        }
    }
}

TEST_CASE("threads_that_ask_first_at_the_same_time_get_the_same_points") {
    const SceneHandle scene = build_scene({flat_grid(200)});
    std::atomic<std::size_t> differences = 0;
    const auto ask = [&] {
        for (int i = 0; i < 200; ++i) {
            const GnomonRay ray = ray_down(float(i) + 0.25f, 199.5f - float(i));
            GnomonHit hit;
            GnomonSurfacePoint point{};
            const bool is_found =
                gnomon_intersect(scene.get(), &ray, &hit) && gnomon_surface_point(scene.get(), &ray, &hit, &point) == GNOMON_OK;
            differences += !is_found || !is(point.position, ray.origin[0], ray.origin[1], 0);
        }
    };
    std::vector<std::thread> threads;
    for (int i = 0; i < 4; ++i) threads.emplace_back(ask);
    for (std::thread& thread : threads) thread.join();
    CHECK(differences == 0);
}

TEST_CASE("table_is_made_by_the_first_point_and_counts_among_the_bytes") {
    const SceneHandle scene = build_scene({flat_grid(100)});
    const auto bytes = [&] {
        GnomonSceneStats stats;
        REQUIRE(gnomon_scene_stats(scene.get(), sizeof stats, &stats) == GNOMON_OK);
        return stats.bytes;
    };
    const std::uint64_t before = bytes();
    surface_point(scene, ray_down(0.25f, 0.5f));
    const std::uint64_t after = bytes();
    CHECK((after >= before + 4 * 20'000 && after <= before + 4 * 20'000 + 64));
    surface_point(scene, ray_down(50.25f, 0.5f));
    CHECK(bytes() == after);
}

TEST_CASE("what_names_no_surface_is_an_error_that_says_so") {
    const SceneHandle scene = build_scene({unit_triangle(), TriangleMesh{{0, 0, 0, 1, 0, 0, 2, 0, 0}, {0, 1, 2}}});
    const GnomonRay ray = ray_down(0.25f, 0.25f);
    const GnomonHit hit = intersect(scene, ray);
    const auto fails = [&](const GnomonRay& asked, const GnomonHit& answered, const std::string& words) {
        GnomonSurfacePoint point{};
        CHECK(gnomon_surface_point(scene.get(), &asked, &answered, &point) == GNOMON_ERROR_INVALID_ARGUMENT);
        CHECK_MESSAGE(last_error().find(words) != std::string::npos, last_error());
        CHECK(is(point.position, 0, 0, 0));
    };
    fails(ray_down(3, 3), intersect(scene, ray_down(3, 3)), "hit is a miss");
    const auto named = [&](std::uint32_t geometry_id, std::uint32_t primitive_id) {
        GnomonHit other = hit;
        other.geometry_id = geometry_id, other.primitive_id = primitive_id;
        return other;
    };
    fails(ray, named(0, 1), "geometry 0, primitive 1");
    fails(ray, named(1, 0), "geometry 1, primitive 0");
    fails(ray, named(2, 0), "geometry 2, primitive 0");
    fails(ray, named(0xFFFF'FFFE, 0xFFFF'FFFE), "geometry 4294967294, primitive 4294967294");
    fails(ray_down(3, 3), hit, "the ray passes it");
    GnomonRay invalid = ray;
    invalid.direction[2] = kNan;
    fails(invalid, hit, "ray is not valid");
}

TEST_CASE("null_pointers_of_points_and_origins_are_named") {
    const SceneHandle scene = build_scene({unit_triangle()});
    const GnomonRay ray = ray_down(0.25f, 0.25f);
    const GnomonHit hit = intersect(scene, ray);
    GnomonSurfacePoint point = surface_point(scene, ray);
    float origin[3] = {7, 7, 7};
    const auto names = [](GnomonStatus status, const std::string& name) {
        CHECK(status == GNOMON_ERROR_INVALID_ARGUMENT);
        CHECK_MESSAGE(last_error() == name + " is null", last_error());
    };
    names(gnomon_surface_point(nullptr, &ray, &hit, &point), "scene");
    names(gnomon_surface_point(scene.get(), nullptr, &hit, &point), "ray");
    names(gnomon_surface_point(scene.get(), &ray, nullptr, &point), "hit");
    names(gnomon_surface_point(scene.get(), &ray, &hit, nullptr), "point_out");
    names(gnomon_offset_origin(nullptr, ray.direction, origin), "point");
    names(gnomon_offset_origin(&point, nullptr, origin), "direction");
    names(gnomon_offset_origin(&point, ray.direction, nullptr), "origin_out");
    CHECK(is(origin, 7, 7, 7));
}

TEST_CASE("directions_and_points_that_can_not_be_used_are_errors") {
    const SceneHandle scene = build_scene({unit_triangle()});
    const GnomonSurfacePoint point = surface_point(scene, ray_down(0.25f, 0.25f));
    const auto fails = [](const GnomonSurfacePoint& from, std::vector<float> direction, const std::string& words) {
        float origin[3] = {7, 7, 7};
        CHECK(gnomon_offset_origin(&from, direction.data(), origin) == GNOMON_ERROR_INVALID_ARGUMENT);
        CHECK_MESSAGE(last_error().find(words) != std::string::npos, last_error());
        CHECK(is(origin, 7, 7, 7));
    };
    fails(point, {0, 0, 0}, "direction (0, 0, 0)");
    fails(point, {0, kNan, 1}, "direction (0, NaN, 1)");
    fails(point, {0, kInfinity, 1}, "direction (0, inf, 1)");
    GnomonSurfacePoint bad = point;
    bad.surface = 7;
    fails(bad, {0, 0, 1}, "surface is 7");
    bad = point;
    bad.precision = 9;
    fails(bad, {0, 0, 1}, "precision is 9");
    for (const float value : {kNan, kInfinity, 0.0f}) {
        bad = point;
        std::fill(std::begin(bad.shape), std::end(bad.shape), value);
        fails(bad, {0, 0, 1}, "point is not as");
        bad.surface = GNOMON_SURFACE_SPHERE;
        if (value != 0) fails(bad, {0, 0, 1}, "point is not as");
    }
    bad = point;
    bad.position[1] = kNan;
    fails(bad, {0, 0, 1}, "point is not as");
}
