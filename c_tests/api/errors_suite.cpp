// Every misuse is answered with its status, one sentence that names the culprit, and untouched outputs.
#include <doctest/doctest.h>

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>
#include <utility>
#include <vector>

#include "api/fixtures.hpp"

using namespace harness;

namespace {

constexpr std::uint32_t kUntouchedId = 0xA5A5A5A5u;

/// Checks gnomon_last_error(): one line that holds each of the words.
void check_error_names(const std::vector<std::string>& words) {
    const std::string message = last_error();
    CAPTURE(message);
    CHECK(message.size() > 10);
    CHECK(message.find('\n') == std::string::npos);
    for (const std::string& word : words) {
        CAPTURE(word);
        CHECK(message.find(word) != std::string::npos);
    }
}

void add_fails(const GnomonTriangles& triangles, const std::vector<std::string>& words,
               GnomonStatus status = GNOMON_ERROR_INVALID_ARGUMENT) {
    const BuilderHandle builder = new_builder();
    std::uint32_t geometry_id = kUntouchedId;
    CHECK(gnomon_scene_builder_add_triangles(builder.get(), &triangles, &geometry_id) == status);
    CHECK(geometry_id == kUntouchedId);
    check_error_names(words);
}

/// Builds `mesh` as geometry 1 behind a good one; the status says whether add or build found the fault.
GnomonStatus build_behind_a_good_one(const TriangleMesh& mesh, const GnomonBuildOptions& options,
                                     SceneHandle* scene_out = nullptr) {
    const BuilderHandle builder = new_builder();
    for (const TriangleMesh& each : {unit_triangle(), mesh}) {
        const GnomonTriangles triangles = each.view();
        const GnomonStatus status = gnomon_scene_builder_add_triangles(builder.get(), &triangles, nullptr);
        if (status != GNOMON_OK) return status;
    }
    GnomonScene* scene = nullptr;
    const GnomonStatus status = gnomon_scene_build(builder.get(), &options, &scene);
    CHECK((scene != nullptr) == (status == GNOMON_OK));
    SceneHandle handle(scene);
    if (scene_out) *scene_out = std::move(handle);
    return status;
}

void build_fails(const GnomonBuildOptions& options, GnomonStatus status, const std::vector<std::string>& words) {
    CHECK(build_behind_a_good_one(unit_triangle(1), options) == status);
    check_error_names(words);
}

}  // namespace

TEST_CASE("null_builder_or_description_is_named") {
    const BuilderHandle builder = new_builder();
    const TriangleMesh mesh = unit_triangle();
    const GnomonTriangles triangles = mesh.view();
    std::uint32_t geometry_id = kUntouchedId;
    CHECK(gnomon_scene_builder_add_triangles(nullptr, &triangles, &geometry_id) == GNOMON_ERROR_INVALID_ARGUMENT);
    check_error_names({"builder", "null"});
    CHECK(gnomon_scene_builder_add_triangles(builder.get(), nullptr, &geometry_id) == GNOMON_ERROR_INVALID_ARGUMENT);
    check_error_names({"triangles", "null"});
    CHECK(geometry_id == kUntouchedId);
}

TEST_CASE("null_pointers_of_build_are_named") {
    const BuilderHandle builder = new_builder();
    GnomonScene* scene = nullptr;
    CHECK(gnomon_scene_build(nullptr, nullptr, &scene) == GNOMON_ERROR_INVALID_ARGUMENT);
    check_error_names({"builder", "null"});
    CHECK(scene == nullptr);
    CHECK(gnomon_scene_build(builder.get(), nullptr, nullptr) == GNOMON_ERROR_INVALID_ARGUMENT);
    check_error_names({"scene_out", "null"});
}

TEST_CASE("null_pointers_of_queries_are_named") {
    const SceneHandle scene = build_scene({unit_triangle()});
    const GnomonRay ray = ray_down(0.25f, 0.25f);
    GnomonHit hit;
    std::uint8_t occluded = 0xA5;
    CHECK(gnomon_intersect_n(nullptr, &ray, 1, &hit, nullptr) == GNOMON_ERROR_INVALID_ARGUMENT);
    check_error_names({"scene", "null"});
    CHECK(gnomon_intersect_n(scene.get(), nullptr, 1, &hit, nullptr) == GNOMON_ERROR_INVALID_ARGUMENT);
    check_error_names({"rays", "null"});
    CHECK(gnomon_intersect_n(scene.get(), &ray, 1, nullptr, nullptr) == GNOMON_ERROR_INVALID_ARGUMENT);
    check_error_names({"hits_out", "null"});
    CHECK(gnomon_occluded_n(nullptr, &ray, 1, &occluded, nullptr) == GNOMON_ERROR_INVALID_ARGUMENT);
    check_error_names({"scene", "null"});
    CHECK(gnomon_occluded_n(scene.get(), nullptr, 1, &occluded, nullptr) == GNOMON_ERROR_INVALID_ARGUMENT);
    check_error_names({"rays", "null"});
    CHECK(gnomon_occluded_n(scene.get(), &ray, 1, nullptr, nullptr) == GNOMON_ERROR_INVALID_ARGUMENT);
    check_error_names({"occluded_out", "null"});
    CHECK(occluded == 0xA5);
}

TEST_CASE("null_pointers_of_single_queries_answer_false") {
    const SceneHandle scene = build_scene({unit_triangle()});
    const GnomonRay ray = ray_down(0.25f, 0.25f);
    GnomonHit hit;
    CHECK_FALSE(gnomon_intersect(nullptr, &ray, &hit));
    CHECK_FALSE(gnomon_intersect(scene.get(), nullptr, &hit));
    CHECK_FALSE(gnomon_intersect(scene.get(), &ray, nullptr));
    GnomonRayCounts counts;
    CHECK_FALSE(gnomon_intersect_counted(nullptr, &ray, &hit, &counts));
    CHECK_FALSE(gnomon_intersect_counted(scene.get(), nullptr, &hit, &counts));
    CHECK_FALSE(gnomon_occluded(nullptr, &ray));
    CHECK_FALSE(gnomon_occluded(scene.get(), nullptr));
}

TEST_CASE("null_output_of_a_counted_query_is_named_and_leaves_the_other_one_untouched") {
    const SceneHandle scene = build_scene({unit_triangle()});
    const GnomonRay ray = ray_down(0.25f, 0.25f);
    GnomonHit hit{};
    GnomonRayCounts counts{kUntouchedId, kUntouchedId, kUntouchedId};
    hit.primitive_id = kUntouchedId;
    CHECK_FALSE(gnomon_intersect_counted(scene.get(), &ray, nullptr, &counts));
    check_error_names({"hit_out", "null"});
    CHECK(counts.primitives_tested == kUntouchedId);
    CHECK_FALSE(gnomon_intersect_counted(scene.get(), &ray, &hit, nullptr));
    check_error_names({"counts_out", "null"});
    CHECK(hit.primitive_id == kUntouchedId);
}

TEST_CASE("null_pointers_of_bounds_and_stats_are_named") {
    const SceneHandle scene = build_scene({unit_triangle()});
    float corner[3];
    GnomonSceneStats stats{};
    CHECK(gnomon_scene_bounds(nullptr, corner, corner) == GNOMON_ERROR_INVALID_ARGUMENT);
    check_error_names({"scene", "null"});
    CHECK(gnomon_scene_bounds(scene.get(), nullptr, corner) == GNOMON_ERROR_INVALID_ARGUMENT);
    check_error_names({"lower_out", "null"});
    CHECK(gnomon_scene_bounds(scene.get(), corner, nullptr) == GNOMON_ERROR_INVALID_ARGUMENT);
    check_error_names({"upper_out", "null"});
    CHECK(gnomon_scene_stats(nullptr, sizeof stats, &stats) == GNOMON_ERROR_INVALID_ARGUMENT);
    check_error_names({"scene", "null"});
    CHECK(gnomon_scene_stats(scene.get(), sizeof stats, nullptr) == GNOMON_ERROR_INVALID_ARGUMENT);
    check_error_names({"stats_out", "null"});
}

TEST_CASE("zero_rays_need_no_arrays") {
    const SceneHandle scene = build_scene({unit_triangle()});
    CHECK(gnomon_intersect_n(scene.get(), nullptr, 0, nullptr, nullptr) == GNOMON_OK);
    CHECK(gnomon_occluded_n(scene.get(), nullptr, 0, nullptr, nullptr) == GNOMON_OK);
}

TEST_CASE("null_positions_with_vertices_are_named") {
    GnomonTriangles triangles{};
    triangles.vertex_count = 7;
    add_fails(triangles, {"positions", "null", "7"});
}

TEST_CASE("unknown_index_format_is_named") {
    const TriangleMesh mesh = unit_triangle();
    GnomonTriangles triangles = mesh.view();
    triangles.index_format = 77;
    add_fails(triangles, {"index_format", "77"});
}

TEST_CASE("index_out_of_range_is_named_with_its_triangle_and_the_vertex_count") {
    TriangleMesh mesh = flat_grid(2);
    for (const std::uint32_t index : {9u, 0xFFFFFFFFu}) {
        mesh.indices[3 * 5 + 1] = index;
        add_fails(mesh.view(), {"geometry 0", "triangle 5", std::to_string(index), "9"});
    }
    const GnomonBuildOptions options = default_build_options();
    CHECK(build_behind_a_good_one(mesh, options) == GNOMON_ERROR_INVALID_ARGUMENT);
    check_error_names({"geometry 1", "triangle 5"});
}

TEST_CASE("vertices_three_by_three_must_suffice_for_the_triangles") {
    const TriangleMesh mesh = unit_triangle();
    GnomonTriangles triangles = mesh.view();
    triangles.indices = nullptr;
    triangles.triangle_count = 2;
    add_fails(triangles, {"geometry 0", "2 triangles", "6 vertices", "there are 3"});
}

TEST_CASE("overflowing_counts_and_strides_are_refused_before_a_read") {
    const TriangleMesh mesh = unit_triangle();
    GnomonTriangles triangles = mesh.view();
    triangles.vertex_count = SIZE_MAX / 4;
    add_fails(triangles, {std::to_string(SIZE_MAX / 4)});
    triangles = mesh.view();
    triangles.triangle_count = SIZE_MAX / 4;
    add_fails(triangles, {std::to_string(SIZE_MAX / 4)});
    triangles = mesh.view();
    triangles.position_stride = SIZE_MAX / 2;
    add_fails(triangles, {"positions", std::to_string(SIZE_MAX / 2)});
}

TEST_CASE("strides_smaller_than_an_element_are_named") {
    const TriangleMesh mesh = unit_triangle();
    GnomonTriangles triangles = mesh.view();
    triangles.position_stride = 8;
    add_fails(triangles, {"position_stride", "8", "12"});
    triangles = mesh.view();
    triangles.index_stride = 4;
    add_fails(triangles, {"index_stride", "4", "12"});
}

TEST_CASE("non_finite_vertices_are_rejected_by_name_or_skipped_and_counted") {
    for (const float value : {kNan, kInfinity, -kInfinity}) {
        CAPTURE(value);
        TriangleMesh mesh = flat_grid(2, 1);
        mesh.positions[3 * 8 + 1] = value;  // the last corner: one triangle, number 7

        GnomonBuildOptions options = default_build_options();
        CHECK(build_behind_a_good_one(mesh, options) == GNOMON_ERROR_INVALID_ARGUMENT);
        check_error_names({"geometry 1", "triangle 7", "vertex 8"});

        options.invalid_triangles = GNOMON_INVALID_SKIP;
        SceneHandle scene;
        REQUIRE(build_behind_a_good_one(mesh, options, &scene) == GNOMON_OK);
        GnomonSceneStats stats{};
        REQUIRE(gnomon_scene_stats(scene.get(), sizeof stats, &stats) == GNOMON_OK);
        CHECK(stats.skipped_count == 1);
        CHECK(stats.triangle_count == 8);
        CHECK(intersect(scene, ray_down(1.75f, 1.75f)).t == kInfinity);
        CHECK(intersect(scene, ray_down(1.25f, 1.25f)).primitive_id == 6);
    }
}

TEST_CASE("non_finite_vertex_that_no_triangle_uses_is_fine") {
    TriangleMesh mesh = unit_triangle();
    mesh.positions.insert(mesh.positions.end(), {kNan, kNan, kNan});
    CHECK(intersect(build_scene({mesh}), ray_down(0.25f, 0.25f)).t == 2);
}

TEST_CASE("unknown_enums_of_the_build_options_are_named") {
    const struct {
        const char* name;
        std::uint32_t GnomonBuildOptions::*field;
    } fields[] = {
        {"structure", &GnomonBuildOptions::structure},
        {"quality", &GnomonBuildOptions::quality},
        {"precision", &GnomonBuildOptions::precision},
        {"isa", &GnomonBuildOptions::isa},
        {"invalid_triangles", &GnomonBuildOptions::invalid_triangles},
        {"compact", &GnomonBuildOptions::compact},
    };
    for (const auto& each : fields) {
        GnomonBuildOptions options = default_build_options();
        options.*each.field = 4242;
        build_fails(options, GNOMON_ERROR_INVALID_ARGUMENT, {each.name, "4242"});
    }
}

TEST_CASE("grid_cells_per_triangle_that_is_no_number_of_cells_is_named") {
    const std::pair<float, const char*> cases[] = {{kNan, "NaN"}, {-1.5f, "-1.5"}, {kInfinity, "inf"}};
    for (const auto& [cells, name] : cases) {
        GnomonBuildOptions options = default_build_options();
        options.grid_cells_per_triangle = cells;
        build_fails(options, GNOMON_ERROR_INVALID_ARGUMENT, {"grid_cells_per_triangle", name});
    }
}

TEST_CASE("build_options_never_initialised_are_named") {
    for (const std::uint32_t struct_size : {0u, 3u, 24u}) {
        GnomonBuildOptions options = default_build_options();
        options.struct_size = struct_size;
        build_fails(options, GNOMON_ERROR_INVALID_ARGUMENT, {"struct_size", std::to_string(struct_size)});
    }
}

TEST_CASE("query_options_never_initialised_are_named") {
    const SceneHandle scene = build_scene({unit_triangle()});
    const GnomonRay ray = ray_down(0.25f, 0.25f);
    GnomonHit hit, untouched;
    std::memset(&hit, 0xA5, sizeof hit);
    untouched = hit;
    GnomonQueryOptions options = threads_query_options(1);
    options.struct_size = 0;
    CHECK(gnomon_intersect_n(scene.get(), &ray, 1, &hit, &options) == GNOMON_ERROR_INVALID_ARGUMENT);
    check_error_names({"struct_size", "0"});
    CHECK(same_bits(hit, untouched));
}

TEST_CASE("build_options_of_an_older_header_keep_the_defaults_of_what_it_lacks") {
    GnomonBuildOptions older = default_build_options();
    older.struct_size = offsetof(GnomonBuildOptions, compact);
    older.structure = GNOMON_STRUCTURE_WIDE_BVH;
    // Not there for whoever states that size.
    older.compact = 4242;
    older.grid_cells_per_triangle = kNan;
    const SceneHandle scene = build_scene({unit_triangle()}, older);
    CHECK(intersect(scene, ray_down(0.25f, 0.25f)).t == 2);
}

TEST_CASE("build_options_of_a_newer_header_are_refused_where_they_ask_for_what_is_unknown") {
    struct {
        GnomonBuildOptions known;
        std::uint64_t unknown;
    } newer{default_build_options(), 0};
    newer.known.struct_size = sizeof newer;
    const BuilderHandle builder = new_builder();
    GnomonScene* scene = nullptr;
    REQUIRE_MESSAGE(gnomon_scene_build(builder.get(), &newer.known, &scene) == GNOMON_OK, last_error());
    SceneHandle(scene).reset();

    scene = nullptr;
    newer.unknown = 1;
    CHECK(gnomon_scene_build(builder.get(), &newer.known, &scene) == GNOMON_ERROR_INVALID_ARGUMENT);
    check_error_names({"GnomonBuildOptions", std::to_string(sizeof newer)});
    CHECK(scene == nullptr);
}

TEST_CASE("arrays_misaligned_or_larger_than_memory_are_named") {
    const SceneHandle scene = build_scene({unit_triangle()});
    alignas(GnomonRay) char bytes[2 * sizeof(GnomonRay)] = {};
    const auto* misaligned = reinterpret_cast<const GnomonRay*>(bytes + 1);
    const auto* rays = reinterpret_cast<const GnomonRay*>(bytes);
    GnomonHit hit;
    CHECK(gnomon_intersect_n(scene.get(), misaligned, 1, &hit, nullptr) == GNOMON_ERROR_INVALID_ARGUMENT);
    check_error_names({"rays", "multiple of 4"});
    CHECK(gnomon_intersect_n(scene.get(), rays, SIZE_MAX, &hit, nullptr) == GNOMON_ERROR_INVALID_ARGUMENT);
    check_error_names({"rays", std::to_string(SIZE_MAX)});
}
