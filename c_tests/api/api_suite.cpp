// What the C interface answers: version, defaults, bounds and stats.
#include <doctest/doctest.h>

#include <cstdint>
#include <cstring>
#include <string>

#include "api/fixtures.hpp"

using namespace harness;

TEST_CASE("version_is_that_of_the_manifest") { CHECK(std::string(gnomon_version_string()) == GNOMON_MANIFEST_VERSION); }

TEST_CASE("version_number_packs_the_string") {
    const std::uint32_t version = gnomon_version();
    const std::string unpacked =
        std::to_string(version / 10000) + "." + std::to_string(version / 100 % 100) + "." + std::to_string(version % 100);
    CHECK(unpacked == gnomon_version_string());
}

TEST_CASE("status_names_are_those_of_the_header") {
    CHECK(std::string(gnomon_status_name(GNOMON_OK)) == "GNOMON_OK");
    CHECK(std::string(gnomon_status_name(GNOMON_ERROR_INVALID_ARGUMENT)) == "GNOMON_ERROR_INVALID_ARGUMENT");
    CHECK(std::string(gnomon_status_name(GNOMON_ERROR_OUT_OF_MEMORY)) == "GNOMON_ERROR_OUT_OF_MEMORY");
    CHECK(std::string(gnomon_status_name(GNOMON_ERROR_CANCELLED)) == "GNOMON_ERROR_CANCELLED");
    CHECK(std::string(gnomon_status_name(GNOMON_ERROR_UNSUPPORTED)) == "GNOMON_ERROR_UNSUPPORTED");
    CHECK(std::string(gnomon_status_name(GNOMON_ERROR_INTERNAL)) == "GNOMON_ERROR_INTERNAL");
}

TEST_CASE("status_name_of_an_unknown_number_is_a_string_too") {
    for (const std::uint32_t status : {6u, 1000u, 0xFFFFFFFFu}) {
        REQUIRE(gnomon_status_name(status) != nullptr);
        CHECK(std::string(gnomon_status_name(status)) != "");
        CHECK(std::string(gnomon_status_name(status)) != "GNOMON_OK");
    }
}

TEST_CASE("build_options_init_fills_the_documented_defaults") {
    GnomonBuildOptions options;
    std::memset(&options, 0xA5, sizeof options);
    gnomon_build_options_init(&options);
    CHECK(options.struct_size == sizeof options);
    CHECK(options.structure == GNOMON_STRUCTURE_AUTO);
    CHECK(options.quality == GNOMON_QUALITY_MEDIUM);
    CHECK(options.precision == GNOMON_PRECISION_ACCURATE);
    CHECK(options.isa == GNOMON_ISA_AUTO);
    CHECK(options.thread_count == 0);
    CHECK(options.invalid_triangles == GNOMON_INVALID_REJECT);
    CHECK(options.memory_limit_bytes == 0);
    CHECK((options.progress == nullptr));
    CHECK(options.progress_user == nullptr);
    CHECK(options.compact == 0);
    CHECK(options.grid_cells_per_triangle == 0);
}

TEST_CASE("query_options_init_fills_the_documented_defaults") {
    GnomonQueryOptions options;
    std::memset(&options, 0xA5, sizeof options);
    gnomon_query_options_init(&options);
    CHECK(options.struct_size == sizeof options);
    CHECK(options.thread_count == 0);
}

TEST_CASE("bounds_are_those_of_the_vertices") {
    const SceneHandle scene = build_scene({unit_triangle(-3), flat_grid(4, 7)});
    float lower[3], upper[3];
    REQUIRE(gnomon_scene_bounds(scene.get(), lower, upper) == GNOMON_OK);
    CHECK((lower[0] == 0 && lower[1] == 0 && lower[2] == -3));
    CHECK((upper[0] == 4 && upper[1] == 4 && upper[2] == 7));
}

TEST_CASE("stats_count_what_was_built") {
    for (const Configuration& configuration : all_configurations()) {
        CAPTURE(configuration.name);
        const SceneHandle scene = build_scene({flat_grid(8), unit_triangle(1)}, configuration.options);
        GnomonSceneStats stats{};
        REQUIRE(gnomon_scene_stats(scene.get(), sizeof stats, &stats) == GNOMON_OK);
        CHECK(stats.triangle_count == 129);
        CHECK(stats.skipped_count == 0);
        CHECK(stats.reference_count >= stats.triangle_count);
        CHECK(stats.structure != GNOMON_STRUCTURE_AUTO);
        CHECK(stats.precision == configuration.options.precision);
        CHECK(stats.isa != GNOMON_ISA_AUTO);
        if (configuration.options.isa != GNOMON_ISA_AUTO) CHECK(stats.isa <= configuration.options.isa);
        CHECK(stats.bytes >= stats.node_bytes + stats.leaf_bytes);
        CHECK(stats.peak_build_bytes > 0);
        CHECK(stats.build_seconds >= 0);
    }
}

TEST_CASE("stats_write_no_more_than_the_caller_knows_of") {
    const SceneHandle scene = build_scene({unit_triangle()});
    GnomonSceneStats stats;
    std::memset(&stats, 0xA5, sizeof stats);
    const std::uint64_t untouched = stats.node_count;
    REQUIRE(gnomon_scene_stats(scene.get(), sizeof stats.triangle_count, &stats) == GNOMON_OK);
    CHECK(stats.triangle_count == 1);
    CHECK(stats.node_count == untouched);
}

TEST_CASE("compact_wide_bvh_of_a_mesh_takes_36_bytes_a_triangle_and_answers_the_same") {
    const TriangleMesh mesh = flat_grid(100);
    for (const Named& quality : kQualities) {
        CAPTURE(quality.name);
        GnomonBuildOptions options = default_build_options();
        options.structure = GNOMON_STRUCTURE_WIDE_BVH;
        options.quality = quality.value;
        const SceneHandle ordinary = build_scene({mesh, unit_triangle(1)}, options);
        options.compact = 1;
        const SceneHandle compact = build_scene({mesh, unit_triangle(1)}, options);
        GnomonSceneStats stats{};
        REQUIRE(gnomon_scene_stats(compact.get(), sizeof stats, &stats) == GNOMON_OK);
        CHECK(stats.structure == GNOMON_STRUCTURE_WIDE_BVH);
        CHECK(double(stats.bytes) <= 36 * double(stats.triangle_count));
        for (const float at : {0.25f, 0.5f, 3.75f, 49.0f, 99.875f, 101.0f}) {
            const GnomonRay ray = ray_down(at, at);
            CHECK(same_bits(intersect(compact, ray), intersect(ordinary, ray)));
        }
    }
}

TEST_CASE("compact_changes_no_other_structure") {
    const TriangleMesh mesh = flat_grid(8);
    for (const std::uint32_t structure : {GNOMON_STRUCTURE_BRUTE_FORCE, GNOMON_STRUCTURE_BVH}) {
        GnomonBuildOptions options = default_build_options();
        options.structure = structure;
        GnomonSceneStats stats[2] = {};
        for (options.compact = 0; options.compact < 2; ++options.compact) {
            const SceneHandle scene = build_scene({mesh}, options);
            REQUIRE(gnomon_scene_stats(scene.get(), sizeof stats[0], &stats[options.compact]) == GNOMON_OK);
        }
        CHECK(stats[0].structure == structure);
        CHECK(stats[1].structure == structure);
        CHECK(stats[0].bytes == stats[1].bytes);
    }
}
