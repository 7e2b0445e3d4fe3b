// All hits of a ray, page by page, and points inside of what is closed, in every structure, precision and ISA.
#include <doctest/doctest.h>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

#include "api/fixtures.hpp"

using namespace harness;

namespace {

/// Layers of the same grid, one geometry each, at z = 0, -1, -2, ...
std::vector<TriangleMesh> layers(std::uint32_t count) {
    std::vector<TriangleMesh> meshes;
    for (std::uint32_t i = 0; i < count; ++i) meshes.push_back(flat_grid(4, -float(i)));
    return meshes;
}

/// The cube [0, 4]^3, closed: each face is a flat_grid.
TriangleMesh closed_cube() {
    TriangleMesh cube;
    for (int axis = 0; axis < 3; ++axis) {
        for (const float side : {0.0f, 4.0f}) {
            const TriangleMesh face = flat_grid(4, side);
            const auto first = std::uint32_t(cube.positions.size() / 3);
            for (std::size_t at = 0; at < face.positions.size(); at += 3)
                for (int i = 0; i < 3; ++i) cube.positions.push_back(face.positions[at + std::size_t((i + axis) % 3)]);
            for (const std::uint32_t index : face.indices) cube.indices.push_back(first + index);
        }
    }
    return cube;
}

std::vector<GnomonHit> all_hits(const SceneHandle& scene, const GnomonRay& ray, std::size_t capacity) {
    std::vector<GnomonHit> all;
    // Exactly as large as is said, so that sanitizers see a write beyond.
    std::vector<GnomonHit> page(capacity);
    std::size_t count = capacity;
    while (count == capacity) {
        const GnomonHit* after = all.empty() ? nullptr : &page.back();
        REQUIRE(gnomon_intersect_all(scene.get(), &ray, after, capacity, page.data(), &count) == GNOMON_OK);
        REQUIRE(count <= capacity);
        all.insert(all.end(), page.begin(), page.begin() + std::ptrdiff_t(count));
    }
    return all;
}

bool contains(const SceneHandle& scene, float x, float y, float z) {
    const float point[] = {x, y, z};
    bool inside = false;
    REQUIRE_MESSAGE(gnomon_contains_point(scene.get(), point, &inside) == GNOMON_OK, last_error());
    return inside;
}

template <typename Check>
void in_every_configuration(const std::vector<TriangleMesh>& meshes, Check check) {
    for (const Configuration& configuration : all_configurations()) {
        CAPTURE(configuration.name);
        check(build_scene(meshes, configuration.options));
    }
}

}  // namespace

TEST_CASE("all_hits_come_in_order_whatever_the_capacity") {
    in_every_configuration(layers(9), [](const SceneHandle& scene) {
        const GnomonRay ray{{1.25f, 2.25f, 1}, 0, {0, 0, -1}, kInfinity};
        for (const std::size_t capacity : {1, 2, 4, 8, 9, 10, 100}) {
            const std::vector<GnomonHit> hits = all_hits(scene, ray, capacity);
            REQUIRE(hits.size() == 9);
            for (std::size_t i = 0; i < hits.size(); ++i)
                CHECK((hits[i].t == float(i + 1) && hits[i].geometry_id == i && hits[i].primitive_id == 18));
            CHECK(same_bits(hits[0], intersect(scene, ray)));
        }
    });
}

TEST_CASE("triangles_at_a_shared_vertex_are_each_given_once_in_the_order_of_their_ids") {
    in_every_configuration(layers(2), [](const SceneHandle& scene) {
        const GnomonRay ray{{1, 1, 1}, 0, {0, 0, -1}, kInfinity};
        for (const std::size_t capacity : {1, 5, 12, 13}) {
            std::vector<std::uint32_t> ids[2];
            for (const GnomonHit& hit : all_hits(scene, ray, capacity)) ids[hit.geometry_id].push_back(hit.primitive_id);
            const std::vector<std::uint32_t> around{1, 2, 3, 8, 9, 10};
            CHECK((ids[0] == around && ids[1] == around));
        }
    });
}

TEST_CASE("copies_are_each_given") {
    in_every_configuration(std::vector<TriangleMesh>(30, unit_triangle()), [](const SceneHandle& scene) {
        for (const std::size_t capacity : {1, 7, 64}) {
            const std::vector<GnomonHit> hits = all_hits(scene, ray_down(0.25f, 0.25f), capacity);
            REQUIRE(hits.size() == 30);
            for (std::size_t i = 0; i < hits.size(); ++i) CHECK((hits[i].t == 2 && hits[i].geometry_id == i));
        }
    });
}

TEST_CASE("interval_is_closed_at_both_ends") {
    const SceneHandle scene = build_scene(layers(5));
    GnomonRay ray{{1.25f, 2.25f, 1}, 2, {0, 0, -1}, 4};
    CHECK(all_hits(scene, ray, 10).size() == 3);
    ray.t_min = std::nextafter(2.0f, 3.0f);
    CHECK(all_hits(scene, ray, 10).size() == 2);
    ray.t_max = std::nextafter(4.0f, 3.0f);
    CHECK(all_hits(scene, ray, 10).size() == 1);
}

TEST_CASE("sphere_is_given_where_it_is_entered_and_where_it_is_left") {
    const BuilderHandle builder = new_builder();
    const float balls[] = {0, 0, 0, 1, 0, 0, -5, 2};
    const GnomonSpheres spheres{balls, 16, balls + 3, 16, 2};
    REQUIRE(gnomon_scene_builder_add_spheres(builder.get(), &spheres, nullptr) == GNOMON_OK);
    const TriangleMesh floor = flat_grid(4, -1);
    const GnomonTriangles triangles = floor.view();
    REQUIRE(gnomon_scene_builder_add_triangles(builder.get(), &triangles, nullptr) == GNOMON_OK);
    for (const Configuration& configuration : all_configurations()) {
        CAPTURE(configuration.name);
        GnomonScene* built = nullptr;
        REQUIRE(gnomon_scene_build(builder.get(), &configuration.options, &built) == GNOMON_OK);
        const SceneHandle scene(built);
        const GnomonRay ray{{0, 0, 2}, 0, {0, 0, -1}, kInfinity};
        for (const std::size_t capacity : {1, 2, 3, 5, 9}) {
            const std::vector<GnomonHit> hits = all_hits(scene, ray, capacity);
            // At z = -1 the sphere is left where the floor is: the sphere has the lower id.
            const float t[] = {1, 3, 3, 5, 9};
            const std::uint32_t geometry_ids[] = {0, 0, 1, 0, 0}, primitive_ids[] = {0, 0, 0, 1, 1};
            REQUIRE(hits.size() == 5);
            for (std::size_t i = 0; i < 5; ++i) {
                CHECK(hits[i].t == t[i]);
                CHECK((hits[i].geometry_id == geometry_ids[i] && hits[i].primitive_id == primitive_ids[i]));
            }
            CHECK((hits[0].normal[2] == 1 && hits[1].normal[2] == -1));
        }
        // Tangent.
        const GnomonRay beside{{1, 0, 2}, 0, {0, 0, -1}, 2.5f};
        CHECK(all_hits(scene, beside, 4).size() == 1);
        CHECK(contains(scene, 0.5f, 0.5f, 0.5f));
        CHECK_FALSE(contains(scene, 0.75f, 0.75f, 0.75f));
    }
}

TEST_CASE("contains_point_is_right_in_line_with_edges_and_vertices_and_on_faces") {
    in_every_configuration({closed_cube()}, [](const SceneHandle& scene) {
        const float inside[] = {1, 2, 2.5f, std::nextafter(4.0f, 0.0f)};
        for (const float x : inside)
            for (const float y : inside)
                for (const float z : inside) CHECK(contains(scene, x, y, z));
        const float on_side[] = {0, 4};
        for (const float side : on_side) {
            CHECK((contains(scene, side, 1, 2) && contains(scene, 1, side, 2.5f) && contains(scene, 3, 3, side)));
            CHECK((contains(scene, side, side, 2) && contains(scene, side, side, side)));
        }
        const float outside[] = {-1, std::nextafter(0.0f, -1.0f), std::nextafter(4.0f, 5.0f), 7};
        for (const float x : outside)
            for (const float y : {0.0f, 1.0f, 2.5f, 4.0f})
                CHECK((!contains(scene, x, y, 2) && !contains(scene, 2, x, y) && !contains(scene, y, 0, x)));
        CHECK_FALSE(contains(scene, kNan, 1, 1));
        CHECK_FALSE(contains(scene, 1, kInfinity, 1));
    });
}

TEST_CASE("shells_count_by_parity") {
    TriangleMesh outer = closed_cube(), inner = closed_cube();
    for (float& coordinate : outer.positions) coordinate = coordinate * 4 - 6;
    const SceneHandle scene = build_scene({outer, inner});
    CHECK_FALSE(contains(scene, 2, 2, 2));
    CHECK(contains(scene, -2, 2, 2));
    CHECK(contains(scene, 6, 3, 1));
    CHECK_FALSE(contains(scene, 11, 2, 2));
}

TEST_CASE("empty_scene_has_no_hits_and_contains_nothing") {
    const SceneHandle scene = build_scene({});
    CHECK(all_hits(scene, ray_down(0, 0), 3).empty());
    CHECK_FALSE(contains(scene, 0, 0, 0));
}

TEST_CASE("capacity_of_zero_needs_no_array") {
    const SceneHandle scene = build_scene({unit_triangle()});
    const GnomonRay ray = ray_down(0.25f, 0.25f);
    std::size_t count = 77;
    CHECK(gnomon_intersect_all(scene.get(), &ray, nullptr, 0, nullptr, &count) == GNOMON_OK);
    CHECK(count == 0);
}

TEST_CASE("invalid_rays_have_no_hits") {
    const SceneHandle scene = build_scene({unit_triangle()});
    const GnomonRay rays[] = {{{0.25f, 0.25f, 2}, 0, {0, 0, 0}, 10},
                              {{kNan, 0.25f, 2}, 0, {0, 0, -1}, 10},
                              {{0.25f, 0.25f, 2}, 5, {0, 0, -1}, 1},
                              {{0.25f, 0.25f, 2}, 0, {0, 0, -1}, kNan}};
    for (const GnomonRay& ray : rays) CHECK(all_hits(scene, ray, 2).empty());
}

TEST_CASE("bad_arguments_are_named_and_leave_outputs_untouched") {
    const SceneHandle scene = build_scene({unit_triangle()});
    const GnomonRay ray = ray_down(0.25f, 0.25f);
    GnomonHit hit, untouched;
    std::memset(&untouched, 0xA5, sizeof untouched);
    hit = untouched;
    std::size_t count = 77;
    const auto fails = [&](GnomonStatus status, const char* what) {
        CHECK(status == GNOMON_ERROR_INVALID_ARGUMENT);
        const std::string error = last_error();
        CHECK_MESSAGE(error.find(what) != std::string::npos, error);
        CHECK((count == 77 && same_bits(hit, untouched)));
    };
    fails(gnomon_intersect_all(nullptr, &ray, nullptr, 1, &hit, &count), "scene is null");
    fails(gnomon_intersect_all(scene.get(), nullptr, nullptr, 1, &hit, &count), "ray is null");
    fails(gnomon_intersect_all(scene.get(), &ray, nullptr, 1, nullptr, &count), "hits_out is null");
    fails(gnomon_intersect_all(scene.get(), &ray, nullptr, 1, &hit, nullptr), "count_out is null");
    fails(gnomon_intersect_all(scene.get(), &ray, nullptr, SIZE_MAX, &hit, &count), std::to_string(SIZE_MAX).c_str());

    const float point[] = {0, 0, 0};
    bool inside = true;
    fails(gnomon_contains_point(nullptr, point, &inside), "scene is null");
    fails(gnomon_contains_point(scene.get(), nullptr, &inside), "point is null");
    fails(gnomon_contains_point(scene.get(), point, nullptr), "inside_out is null");
    CHECK(inside);
}
