// Who owns what and for how long: builders, scenes, callers' arrays, callbacks.
#include <doctest/doctest.h>

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

#include "api/fixtures.hpp"

using namespace harness;

namespace {

/// Every progress report of a build, in order; the first that reaches `cancel_at` cancels it.
struct ProgressLog {
    std::vector<double> reports;
    double cancel_at = 2;  // never

    static bool report(void* user, double done) {
        auto& log = *static_cast<ProgressLog*>(user);
        log.reports.push_back(done);
        return done < log.cancel_at;
    }
    GnomonBuildOptions options() {
        GnomonBuildOptions options = default_build_options();
        options.progress = report;
        options.progress_user = this;
        return options;
    }
};

BuilderHandle builder_of(const TriangleMesh& mesh) {
    BuilderHandle builder = new_builder();
    const GnomonTriangles triangles = mesh.view();
    REQUIRE(gnomon_scene_builder_add_triangles(builder.get(), &triangles, nullptr) == GNOMON_OK);
    return builder;
}

SceneHandle build(const BuilderHandle& builder, const GnomonBuildOptions* options = nullptr) {
    GnomonScene* scene = nullptr;
    REQUIRE_MESSAGE(gnomon_scene_build(builder.get(), options, &scene) == GNOMON_OK, last_error());
    return SceneHandle(scene);
}

std::uint64_t triangle_count(const SceneHandle& scene) {
    GnomonSceneStats stats{};
    REQUIRE(gnomon_scene_stats(scene.get(), sizeof stats, &stats) == GNOMON_OK);
    return stats.triangle_count;
}

}  // namespace

TEST_CASE("free_of_null_is_fine") {
    gnomon_scene_builder_free(nullptr);
    gnomon_scene_free(nullptr);
}

TEST_CASE("one_builder_builds_twice") {
    const BuilderHandle builder = builder_of(flat_grid(4));
    const SceneHandle first = build(builder);
    const SceneHandle second = build(builder);
    CHECK(first != second);
    CHECK(same_bits(intersect(first, ray_down(1.25f, 2.5f)), intersect(second, ray_down(1.25f, 2.5f))));
}

TEST_CASE("geometry_added_after_a_build_is_in_the_next_scene_alone") {
    const BuilderHandle builder = builder_of(unit_triangle());
    const SceneHandle first = build(builder);
    const TriangleMesh above = unit_triangle(1);
    const GnomonTriangles triangles = above.view();
    std::uint32_t geometry_id = GNOMON_INVALID_ID;
    REQUIRE(gnomon_scene_builder_add_triangles(builder.get(), &triangles, &geometry_id) == GNOMON_OK);
    CHECK(geometry_id == 1);
    const SceneHandle second = build(builder);
    CHECK(intersect(first, ray_down(0.25f, 0.25f)).t == 2);
    CHECK(intersect(second, ray_down(0.25f, 0.25f)).t == 1);
}

TEST_CASE("scene_outlives_its_builder") {
    BuilderHandle builder = builder_of(unit_triangle());
    const SceneHandle scene = build(builder);
    builder.reset();
    CHECK(intersect(scene, ray_down(0.25f, 0.25f)).t == 2);
}

TEST_CASE("callers_arrays_are_copied_by_add") {
    TriangleMesh mesh = unit_triangle();
    const BuilderHandle builder = builder_of(mesh);
    std::fill(mesh.positions.begin(), mesh.positions.end(), kNan);
    std::fill(mesh.indices.begin(), mesh.indices.end(), 0xFFFFFFFFu);
    mesh = {};
    CHECK(intersect(build(builder), ray_down(0.25f, 0.25f)).t == 2);
}

TEST_CASE("empty_scene_misses_and_has_an_inverted_box") {
    for (const Configuration& configuration : all_configurations()) {
        CAPTURE(configuration.name);
        const SceneHandle scene = build_scene({}, configuration.options);
        CHECK(intersect(scene, ray_down(0, 0)).t == kInfinity);
        CHECK(triangle_count(scene) == 0);
        float lower[3], upper[3];
        REQUIRE(gnomon_scene_bounds(scene.get(), lower, upper) == GNOMON_OK);
        for (int axis = 0; axis < 3; ++axis) CHECK(lower[axis] > upper[axis]);
    }
}

TEST_CASE("empty_geometry_takes_an_id_and_is_never_hit") {
    const SceneHandle scene = build_scene({{}, unit_triangle()});
    CHECK(triangle_count(scene) == 1);
    CHECK(intersect(scene, ray_down(0.25f, 0.25f)).geometry_id == 1);
}

TEST_CASE("progress_rises_from_0_to_1") {
    ProgressLog log;
    const GnomonBuildOptions options = log.options();
    build(builder_of(flat_grid(100)), &options);
    REQUIRE(log.reports.size() >= 2);
    CHECK(std::is_sorted(log.reports.begin(), log.reports.end()));
    CHECK(log.reports.front() >= 0);
    CHECK(log.reports.back() == 1);
}

TEST_CASE("progress_cancels_at_any_report_is_told_no_more_and_the_builder_stays_usable") {
    const BuilderHandle builder = builder_of(flat_grid(200));
    for (const double cancel_at : {0.0, 0.25, 1.0}) {
        CAPTURE(cancel_at);
        ProgressLog log;
        log.cancel_at = cancel_at;
        const GnomonBuildOptions options = log.options();
        GnomonScene* scene = nullptr;
        CHECK(gnomon_scene_build(builder.get(), &options, &scene) == GNOMON_ERROR_CANCELLED);
        CHECK(scene == nullptr);
        CHECK(log.reports.back() >= cancel_at);
        CHECK(std::count_if(log.reports.begin(), log.reports.end(), [&](double done) { return done >= cancel_at; }) == 1);
        CHECK(intersect(build(builder), ray_down(0.25f, 0.25f)).t == 2);
    }
}

TEST_CASE("exception_thrown_by_progress_passes_through_and_the_builder_stays_usable") {
    struct Stop {};
    const BuilderHandle builder = builder_of(flat_grid(40));
    for (const std::uint32_t thread_count : {1u, 2u}) {
        CAPTURE(thread_count);
        GnomonBuildOptions options = default_build_options();
        options.thread_count = thread_count;
        options.progress = [](void*, double) -> bool { throw Stop(); };
        GnomonScene* scene = nullptr;
        CHECK_THROWS_AS(static_cast<void>(gnomon_scene_build(builder.get(), &options, &scene)), Stop);
        CHECK(scene == nullptr);
        CHECK(intersect(build(builder), ray_down(0.25f, 0.25f)).t == 2);
    }
}

TEST_CASE("memory_limit_refuses_the_build_that_would_pass_it") {
    const BuilderHandle builder = builder_of(flat_grid(200));
    GnomonBuildOptions options = default_build_options();
    const SceneHandle unlimited = build(builder, &options);
    GnomonSceneStats stats{};
    REQUIRE(gnomon_scene_stats(unlimited.get(), sizeof stats, &stats) == GNOMON_OK);

    options.memory_limit_bytes = stats.bytes / 2;
    GnomonScene* scene = nullptr;
    CHECK(gnomon_scene_build(builder.get(), &options, &scene) == GNOMON_ERROR_OUT_OF_MEMORY);
    CHECK(scene == nullptr);
    CHECK(last_error().find(std::to_string(options.memory_limit_bytes)) != std::string::npos);

    options.memory_limit_bytes = 1u << 30;
    const SceneHandle limited = build(builder, &options);
    REQUIRE(gnomon_scene_stats(limited.get(), sizeof stats, &stats) == GNOMON_OK);
    CHECK(stats.peak_build_bytes <= options.memory_limit_bytes);
}
