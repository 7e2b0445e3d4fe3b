// Spheres, alone and among triangles, in every structure, precision and ISA.
#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "api/fixtures.hpp"
#include "harness/rng.hpp"

using namespace harness;

namespace {

/// x, y, z and radius.
using Ball = std::array<float, 4>;

GnomonSpheres view(const std::vector<Ball>& balls) {
    GnomonSpheres spheres{};
    if (balls.empty()) return spheres;
    spheres.centres = balls[0].data();
    spheres.radii = balls[0].data() + 3;
    spheres.centre_stride = spheres.radius_stride = sizeof(Ball);
    spheres.sphere_count = balls.size();
    return spheres;
}

void add_balls(const BuilderHandle& builder, const std::vector<Ball>& balls) {
    const GnomonSpheres spheres = view(balls);
    REQUIRE_MESSAGE(gnomon_scene_builder_add_spheres(builder.get(), &spheres, nullptr) == GNOMON_OK, last_error());
}

void add_mesh(const BuilderHandle& builder, const TriangleMesh& mesh) {
    const GnomonTriangles triangles = mesh.view();
    REQUIRE_MESSAGE(gnomon_scene_builder_add_triangles(builder.get(), &triangles, nullptr) == GNOMON_OK, last_error());
}

SceneHandle build(const BuilderHandle& builder, const GnomonBuildOptions& options) {
    GnomonScene* scene = nullptr;
    REQUIRE_MESSAGE(gnomon_scene_build(builder.get(), &options, &scene) == GNOMON_OK, last_error());
    return SceneHandle(scene);
}

template <typename Check>
void in_every_configuration(const BuilderHandle& builder, Check check) {
    for (const Configuration& configuration : all_configurations()) {
        CAPTURE(configuration.name);
        check(build(builder, configuration.options));
    }
}

bool is_hit(const GnomonHit& hit, float t, std::uint32_t geometry_id, std::uint32_t primitive_id) {
    return hit.t == t && hit.geometry_id == geometry_id && hit.primitive_id == primitive_id;
}

}  // namespace

TEST_CASE("hit_of_a_sphere_has_t_normal_and_ids_and_zero_u_v") {
    const BuilderHandle builder = new_builder();
    add_balls(builder, {{0, 0, -9, 1}, {0, 0, 0, 1.5f}});
    in_every_configuration(builder, [](const SceneHandle& scene) {
        const GnomonHit hit = intersect(scene, ray_down(0, 0));
        CHECK(is_hit(hit, 0.5f, 0, 1));
        CHECK((hit.u == 0 && hit.v == 0 && hit.instance_id == GNOMON_INVALID_ID));
        CHECK((hit.normal[0] == 0 && hit.normal[1] == 0 && hit.normal[2] == 1.5f));
        CHECK(intersect(scene, ray_down(1.51f, 0)).geometry_id == GNOMON_INVALID_ID);
        // Tangent: it belongs to the surface.
        CHECK(is_hit(intersect(scene, ray_down(1.5f, 0)), 2, 0, 1));
    });
}

TEST_CASE("ray_from_inside_hits_the_far_side_with_an_outward_normal") {
    const BuilderHandle builder = new_builder();
    add_balls(builder, {{0, 0, 2, 4}});
    in_every_configuration(builder, [](const SceneHandle& scene) {
        const GnomonHit hit = intersect(scene, ray_down(0, 0));
        CHECK(is_hit(hit, 4, 0, 0));
        CHECK(hit.normal[2] == -4);
        const GnomonRay shorter{{0, 0, 2}, 0, {0, 0, -1}, std::nextafter(4.0f, 0.0f)};
        CHECK(intersect(scene, shorter).geometry_id == GNOMON_INVALID_ID);
    });
}

TEST_CASE("of_a_sphere_and_a_triangle_the_nearer_is_hit_and_at_one_t_the_lower_id") {
    // The sphere touches the plane z = 0 from below at the origin, the other one stands above the second triangle.
    for (const bool spheres_first : {false, true}) {
        const BuilderHandle builder = new_builder();
        const std::vector<Ball> balls{{0, 0, -1, 1}, {5.25f, 0.25f, 0, 1}};
        const TriangleMesh mesh{{-1, -1, 0, 2, -1, 0, -1, 2, 0, 5, 0, 0, 6, 0, 0, 5, 1, 0}, {0, 1, 2, 3, 4, 5}};
        if (spheres_first) add_balls(builder, balls);
        add_mesh(builder, mesh);
        if (!spheres_first) add_balls(builder, balls);
        const std::uint32_t of_spheres = spheres_first ? 0 : 1, of_triangles = spheres_first ? 1 : 0;
        in_every_configuration(builder, [&](const SceneHandle& scene) {
            CHECK(is_hit(intersect(scene, ray_down(0, 0)), 2, 0, 0));
            CHECK(is_hit(intersect(scene, ray_down(0.25f, 0)), 2, of_triangles, 0));
            CHECK(is_hit(intersect(scene, ray_down(5.25f, 0.25f)), 1, of_spheres, 1));
            const GnomonRay up{{0.25f, 0, -5}, 0, {0, 0, 1}, 10};
            CHECK(intersect(scene, up).geometry_id == of_spheres);
        });
    }
}

TEST_CASE("batches_on_spheres_and_triangles_answer_as_single_calls") {
    Rng rng(3);
    const BuilderHandle builder = new_builder();
    std::vector<Ball> balls(400);
    for (Ball& ball : balls)
        ball = {float(rng.uniform(-9, 9)), float(rng.uniform(-9, 9)), float(rng.uniform(-9, 9)), float(rng.uniform(0, 0.6))};
    add_balls(builder, balls);
    add_mesh(builder, flat_grid(8, -1));
    std::vector<GnomonRay> rays(1000);
    for (GnomonRay& ray : rays) {
        ray = {{0, 0, 0}, 0, {0, 0, 0}, kInfinity};
        for (float& x : ray.origin) x = float(rng.uniform(-12, 12));
        for (float& d : ray.direction) d = float(rng.uniform(-1, 1));
    }
    const GnomonQueryOptions query = threads_query_options(2);
    std::size_t sphere_hits = 0, triangle_hits = 0;
    in_every_configuration(builder, [&](const SceneHandle& scene) {
        std::vector<GnomonHit> hits(rays.size());
        std::vector<std::uint8_t> occluded(rays.size(), 7);
        REQUIRE(gnomon_intersect_n(scene.get(), rays.data(), rays.size(), hits.data(), &query) == GNOMON_OK);
        REQUIRE(gnomon_occluded_n(scene.get(), rays.data(), rays.size(), occluded.data(), &query) == GNOMON_OK);
        std::size_t differences = 0;
        for (std::size_t i = 0; i < rays.size(); ++i) {
            const GnomonHit single = intersect(scene, rays[i]);
            const bool found = single.geometry_id != GNOMON_INVALID_ID;
            differences += !same_bits(single, hits[i]) || occluded[i] != std::uint8_t(found);
            sphere_hits += single.geometry_id == 0;
            triangle_hits += single.geometry_id == 1;
        }
        CHECK(differences == 0);
    });
    CHECK((sphere_hits > 0 && triangle_hits > 0));
}

TEST_CASE("strides_separate_and_packed_arrays_give_the_same_spheres") {
    const float centres[] = {0, 0, 0, 4, 0, 0};
    const float radii[] = {1, 1.25f};
    const GnomonSpheres packed{centres, 0, radii, 0, 2};
    const BuilderHandle builder = new_builder();
    REQUIRE(gnomon_scene_builder_add_spheres(builder.get(), &packed, nullptr) == GNOMON_OK);
    const SceneHandle scene = build(builder, default_build_options());
    CHECK(is_hit(intersect(scene, ray_down(4, 0)), 0.75f, 0, 1));
    float lower[3], upper[3];
    REQUIRE(gnomon_scene_bounds(scene.get(), lower, upper) == GNOMON_OK);
    CHECK((lower[0] <= -1 && lower[0] >= -1.001f && upper[0] >= 5.25f && upper[0] <= 5.251f));
}

TEST_CASE("stats_count_spheres_and_leave_those_of_radius_zero_out_of_leaves") {
    const BuilderHandle builder = new_builder();
    add_balls(builder, {{0, 0, 0, 1}, {3, 0, 0, 0}, {5, 0, 0, 2}});
    add_mesh(builder, unit_triangle());
    const SceneHandle scene = build(builder, default_build_options());
    GnomonSceneStats stats;
    REQUIRE(gnomon_scene_stats(scene.get(), sizeof stats, &stats) == GNOMON_OK);
    CHECK((stats.sphere_count == 3 && stats.triangle_count == 1 && stats.reference_count == 3 && stats.skipped_count == 0));
    CHECK(intersect(scene, ray_down(3, 0)).geometry_id != 1);
}

TEST_CASE("invalid_spheres_are_named_or_skipped") {
    for (const Ball bad : {Ball{kNan, 0, 0, 1}, Ball{0, kInfinity, 0, 1}, Ball{0, 0, 0, kNan}, Ball{0, 0, 0, -0.5f}}) {
        const BuilderHandle builder = new_builder();
        add_mesh(builder, unit_triangle());
        add_balls(builder, {{9, 9, 9, 1}, bad});
        GnomonBuildOptions options = default_build_options();
        GnomonScene* scene = nullptr;
        CHECK(gnomon_scene_build(builder.get(), &options, &scene) == GNOMON_ERROR_INVALID_ARGUMENT);
        const std::string error = last_error();
        CHECK_MESSAGE(error.find("geometry 1, sphere 1") != std::string::npos, error);
        options.invalid_triangles = GNOMON_INVALID_SKIP;
        GnomonSceneStats stats;
        const SceneHandle skipped = build(builder, options);
        REQUIRE(gnomon_scene_stats(skipped.get(), sizeof stats, &stats) == GNOMON_OK);
        CHECK((stats.skipped_count == 1 && stats.sphere_count == 1));
        CHECK(intersect(skipped, ray_down(9, 9)).geometry_id == GNOMON_INVALID_ID);
    }
}

TEST_CASE("bad_arguments_of_add_spheres_are_named_and_leave_the_builder_as_it_was") {
    const BuilderHandle builder = new_builder();
    const float floats[] = {0, 0, 0, 1};
    const auto fails = [&](const GnomonSpheres* spheres, const char* what) {
        std::uint32_t geometry_id = 77;
        CHECK(gnomon_scene_builder_add_spheres(builder.get(), spheres, &geometry_id) == GNOMON_ERROR_INVALID_ARGUMENT);
        const std::string error = last_error();
        CHECK_MESSAGE(error.find(what) != std::string::npos, error);
        CHECK(geometry_id == 77);
    };
    fails(nullptr, "spheres");
    const GnomonSpheres no_centres{nullptr, 0, floats, 0, 1}, no_radii{floats, 0, nullptr, 0, 1};
    fails(&no_centres, "centres");
    fails(&no_radii, "radii");
    const GnomonSpheres close_centres{floats, 8, floats + 3, 0, 1}, close_radii{floats, 0, floats + 3, 2, 1};
    fails(&close_centres, "centre_stride");
    fails(&close_radii, "radius_stride");
    const GnomonSpheres many{floats, 0, floats, 0, SIZE_MAX};
    fails(&many, "centres");
    CHECK(gnomon_scene_builder_add_spheres(nullptr, &no_radii, nullptr) == GNOMON_ERROR_INVALID_ARGUMENT);
    std::uint32_t geometry_id = 77;
    const GnomonSpheres none{};
    CHECK(gnomon_scene_builder_add_spheres(builder.get(), &none, &geometry_id) == GNOMON_OK);
    CHECK(geometry_id == 0);
}

TEST_CASE("overlapping_and_identical_spheres_answer_with_the_lowest_id") {
    const BuilderHandle builder = new_builder();
    add_balls(builder, std::vector<Ball>(100, Ball{0, 0, 0, 1}));
    in_every_configuration(builder, [](const SceneHandle& scene) { CHECK(is_hit(intersect(scene, ray_down(0, 0)), 1, 0, 0)); });
}
