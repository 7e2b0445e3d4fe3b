// What single rays answer on hand-made triangles, in every structure, precision and ISA.
#include <doctest/doctest.h>

#include <cmath>
#include <cstdint>
#include <vector>

#include "api/fixtures.hpp"
#include "harness/rng.hpp"

using namespace harness;

namespace {

/// Runs `check` on the scene of `meshes` built in every configuration.
template <typename Check>
void in_every_configuration(const std::vector<TriangleMesh>& meshes, Check check) {
    for (const Configuration& configuration : all_configurations()) {
        CAPTURE(configuration.name);
        check(build_scene(meshes, configuration.options));
    }
}

bool counts_are(const GnomonRayCounts& counts, std::uint32_t nodes, std::uint32_t primitives) {
    return counts.nodes_visited == nodes && counts.cells_stepped == 0 && counts.primitives_tested == primitives;
}

/// Whether a structure has cells that a ray is led through.
bool has_cells(std::uint32_t structure) {
    return structure == GNOMON_STRUCTURE_GRID || structure == GNOMON_STRUCTURE_KD_TREE || structure == GNOMON_STRUCTURE_BSP_TREE;
}

std::uint32_t structure_of(const SceneHandle& scene) {
    GnomonSceneStats stats;
    REQUIRE(gnomon_scene_stats(scene.get(), sizeof stats, &stats) == GNOMON_OK);
    return stats.structure;
}

bool is_miss(const GnomonHit& hit) {
    return hit.t == kInfinity && hit.geometry_id == GNOMON_INVALID_ID && hit.primitive_id == GNOMON_INVALID_ID &&
           hit.instance_id == GNOMON_INVALID_ID;
}

}  // namespace

TEST_CASE("hit_has_t_barycentrics_normal_and_ids") {
    in_every_configuration({unit_triangle()}, [](const SceneHandle& scene) {
        const GnomonHit hit = intersect(scene, ray_down(0.25f, 0.5f));
        CHECK(hit.t == 2);
        CHECK(hit.u == 0.25f);
        CHECK(hit.v == 0.5f);
        CHECK((hit.normal[0] == 0 && hit.normal[1] == 0 && hit.normal[2] == 1));
        CHECK(hit.primitive_id == 0);
        CHECK(hit.geometry_id == 0);
        CHECK(hit.instance_id == GNOMON_INVALID_ID);
    });
}

TEST_CASE("normal_is_the_cross_product_unnormalised_and_the_same_from_both_sides") {
    const TriangleMesh big{{0, 0, 0, 4, 0, 0, 0, 3, 0}, {0, 1, 2}};
    in_every_configuration({big}, [](const SceneHandle& scene) {
        const GnomonRay ray_up{{1, 1, -2}, 0, {0, 0, 1}, 10};
        for (const GnomonRay& ray : {ray_down(1, 1), ray_up}) {
            const GnomonHit hit = intersect(scene, ray);
            CHECK((hit.normal[0] == 0 && hit.normal[1] == 0 && hit.normal[2] == 12));
        }
    });
}

TEST_CASE("t_counts_in_lengths_of_the_direction") {
    in_every_configuration({unit_triangle()}, [](const SceneHandle& scene) {
        const GnomonRay ray{{0.25f, 0.25f, 2}, 0, {0, 0, -8}, 1};
        CHECK(intersect(scene, ray).t == 0.25f);
    });
}

TEST_CASE("ray_beside_the_triangle_misses") {
    in_every_configuration({unit_triangle()}, [](const SceneHandle& scene) {
        CHECK(is_miss(intersect(scene, ray_down(0.75f, 0.75f))));
        CHECK(is_miss(intersect(scene, ray_down(-0.25f, 0.25f))));
    });
}

TEST_CASE("closest_of_several_hits_wins") {
    in_every_configuration({unit_triangle(-1), unit_triangle(1), unit_triangle(0)}, [](const SceneHandle& scene) {
        const GnomonHit hit = intersect(scene, ray_down(0.25f, 0.25f));
        CHECK(hit.t == 1);
        CHECK(hit.geometry_id == 1);
    });
}

TEST_CASE("equal_t_goes_to_the_lowest_geometry_then_primitive") {
    const TriangleMesh twice{unit_triangle().positions, {0, 1, 2, 0, 1, 2}};
    in_every_configuration({unit_triangle(-1), twice, twice}, [](const SceneHandle& scene) {
        const GnomonHit hit = intersect(scene, ray_down(0.25f, 0.25f));
        CHECK(hit.geometry_id == 1);
        CHECK(hit.primitive_id == 0);
    });
}

TEST_CASE("shared_edges_and_vertices_of_a_grid_are_hit_by_the_lowest_primitive") {
    in_every_configuration({flat_grid(4)}, [](const SceneHandle& scene) {
        CHECK(intersect(scene, ray_down(0.5f, 0.5f)).primitive_id == 0);  // the first cell's diagonal
        CHECK(intersect(scene, ray_down(1, 0.25f)).primitive_id == 1);    // between the first two cells
        CHECK(intersect(scene, ray_down(1, 1)).primitive_id == 1);        // a corner of six triangles
        CHECK(intersect(scene, ray_down(4, 4)).primitive_id == 31);       // the grid's own corner
    });
}

TEST_CASE("interval_is_closed_at_both_ends") {
    in_every_configuration({unit_triangle()}, [](const SceneHandle& scene) {
        GnomonRay ray = ray_down(0.25f, 0.25f);
        ray.t_min = ray.t_max = 2;
        CHECK(intersect(scene, ray).t == 2);
        ray.t_min = std::nextafter(2.0f, 3.0f);
        ray.t_max = 10;
        CHECK(is_miss(intersect(scene, ray)));
        ray.t_min = 0;
        ray.t_max = std::nextafter(2.0f, 1.0f);
        CHECK(is_miss(intersect(scene, ray)));
    });
}

TEST_CASE("origin_on_the_triangle_hits_at_zero") {
    in_every_configuration({unit_triangle()}, [](const SceneHandle& scene) {
        const GnomonHit hit = intersect(scene, {{0.25f, 0.25f, 0}, 0, {0, 0, -1}, kInfinity});
        CHECK(hit.t == 0);
        CHECK(hit.geometry_id == 0);
    });
}

TEST_CASE("infinite_t_max_sees_everything_ahead") {
    in_every_configuration({unit_triangle(-1e6f)}, [](const SceneHandle& scene) {
        GnomonRay ray = ray_down(0.25f, 0.25f);
        ray.t_max = kInfinity;
        CHECK(intersect(scene, ray).t == 1000002);
    });
}

TEST_CASE("negative_t_min_sees_behind_the_origin") {
    in_every_configuration({unit_triangle(5)}, [](const SceneHandle& scene) {
        GnomonRay ray = ray_down(0.25f, 0.25f);
        CHECK(is_miss(intersect(scene, ray)));
        ray.t_min = -4;
        CHECK(intersect(scene, ray).t == -3);
        ray.t_min = -kInfinity;
        CHECK(intersect(scene, ray).t == -3);
    });
}

TEST_CASE("zero_area_and_coplanar_triangles_are_never_hit") {
    const TriangleMesh degenerate{{0, 0, 0, 1, 0, 0, 2, 0, 0, 0.5f, 0.5f, 0}, {0, 1, 2, 0, 0, 1, 3, 3, 3}};
    in_every_configuration({degenerate, unit_triangle(1)}, [](const SceneHandle& scene) {
        const GnomonRay along_the_plane{{-1, 0.25f, 1}, 0, {1, 0, 0}, 10};
        CHECK(is_miss(intersect(scene, along_the_plane)));
        CHECK(intersect(scene, ray_down(0.5f, 0)).geometry_id == 1);
    });
}

TEST_CASE("invalid_rays_miss") {
    in_every_configuration({unit_triangle(), flat_grid(4)}, [](const SceneHandle& scene) {
        std::vector<GnomonRay> invalid;
        for (int axis = 0; axis < 3; ++axis) {
            for (const float value : {kNan, kInfinity, -kInfinity}) {
                invalid.push_back(ray_down(0.25f, 0.25f));
                invalid.back().origin[axis] = value;
                invalid.push_back(ray_down(0.25f, 0.25f));
                invalid.back().direction[axis] = value;
            }
        }
        invalid.push_back({{0.25f, 0.25f, 2}, kNan, {0, 0, -1}, 10});
        invalid.push_back({{0.25f, 0.25f, 2}, 0, {0, 0, -1}, kNan});
        invalid.push_back({{0.25f, 0.25f, 2}, 0, {0, 0, 0}, 10});
        invalid.push_back({{0.25f, 0.25f, 2}, 10, {0, 0, -1}, 0});
        for (std::size_t i = 0; i < invalid.size(); ++i) {
            CAPTURE(i);
            CHECK(is_miss(intersect(scene, invalid[i])));
        }
    });
}

TEST_CASE("empty_scene_takes_nothing") {
    in_every_configuration({}, [](const SceneHandle& scene) {
        const CountedHit answer = intersect_counted(scene, ray_down(0.25f, 0.25f));
        CHECK(is_miss(answer.hit));
        CHECK(counts_are(answer.counts, 0, 0));
    });
}

TEST_CASE("one_triangle_takes_one_test_and_without_cells_no_node_but_a_wide_root") {
    in_every_configuration({unit_triangle()}, [](const SceneHandle& scene) {
        const GnomonRayCounts counts = intersect_counted(scene, ray_down(0.25f, 0.5f)).counts;
        if (has_cells(structure_of(scene))) {
            // A tree may cut off what is empty.
            CHECK((counts.cells_stepped >= 1 && counts.primitives_tested == 1));
        } else {
            CHECK(counts_are(counts, structure_of(scene) == GNOMON_STRUCTURE_WIDE_BVH ? 1 : 0, 1));
        }
    });
}

TEST_CASE("invalid_ray_takes_nothing") {
    in_every_configuration({flat_grid(4)}, [](const SceneHandle& scene) {
        const CountedHit answer = intersect_counted(scene, {{0, 0, 2}, 0, {0, 0, 0}, 10});
        CHECK(is_miss(answer.hit));
        CHECK(counts_are(answer.counts, 0, 0));
    });
}

TEST_CASE("brute_force_tests_every_triangle_and_trees_few") {
    constexpr std::uint32_t cells = 32, triangles = 2 * cells * cells;
    Rng rng(1);
    std::vector<GnomonRay> rays;
    for (int i = 0; i < 200; ++i) rays.push_back(ray_down(float(rng.uniform(0, cells)), float(rng.uniform(0, cells))));
    in_every_configuration({flat_grid(cells)}, [&rays](const SceneHandle& scene) {
        GnomonSceneStats stats;
        REQUIRE(gnomon_scene_stats(scene.get(), sizeof stats, &stats) == GNOMON_OK);
        for (const GnomonRay& ray : rays) {
            CAPTURE(ray.origin[0]);
            CAPTURE(ray.origin[1]);
            const auto [hit, counts] = intersect_counted(scene, ray);
            REQUIRE(same_bits(hit, intersect(scene, ray)));
            REQUIRE(!is_miss(hit));
            if (stats.structure == GNOMON_STRUCTURE_BRUTE_FORCE) {
                REQUIRE(counts_are(counts, 0, triangles));
            } else {
                REQUIRE(counts.nodes_visited <= stats.node_count - stats.leaf_count);
                REQUIRE((counts.nodes_visited >= 1) == (stats.structure != GNOMON_STRUCTURE_GRID));
                REQUIRE((counts.cells_stepped >= 1) == has_cells(stats.structure));
                REQUIRE((counts.primitives_tested >= 1 && counts.primitives_tested <= triangles / 10));
            }
        }
    });
}

TEST_CASE("ray_that_leaves_the_scene_behind_tests_no_triangle_of_a_tree") {
    in_every_configuration({flat_grid(8)}, [](const SceneHandle& scene) {
        GnomonSceneStats stats;
        REQUIRE(gnomon_scene_stats(scene.get(), sizeof stats, &stats) == GNOMON_OK);
        const CountedHit answer = intersect_counted(scene, {{1, 1, 1}, 0, {0.25f, 0.25f, 1}, kInfinity});
        CHECK(is_miss(answer.hit));
        if (stats.structure != GNOMON_STRUCTURE_BRUTE_FORCE) {
            CHECK(answer.counts.nodes_visited <= 1);
            CHECK(answer.counts.primitives_tested == 0);
        }
    });
}

TEST_CASE("all_index_forms_and_strides_answer_alike") {
    const std::vector<float> soup{0, 0, 0, 1, 0, 0, 0, 1, 0};
    const std::vector<float> spaced{0, 0,    0,    kNan, kNan, 1, 0,
                                    0, kNan, kNan, 0,    1,    0};      // 20 bytes a vertex, the last without padding
    const std::vector<std::uint16_t> narrow{0, 1, 2, 0xFFFF, 2, 1, 0};  // 8 bytes a triangle, the last without padding
    GnomonTriangles forms[3]{};
    forms[0].positions = soup.data();
    forms[0].vertex_count = 3;
    forms[0].triangle_count = 1;
    forms[1] = forms[0];
    forms[1].positions = spaced.data();
    forms[1].position_stride = 20;
    forms[2] = forms[0];
    forms[2].indices = narrow.data();
    forms[2].index_format = GNOMON_INDEX_U16;
    forms[2].index_stride = 8;
    forms[2].triangle_count = 2;

    const GnomonHit expected = intersect(build_scene({unit_triangle()}), ray_down(0.25f, 0.5f));
    for (const GnomonTriangles& form : forms) {
        const BuilderHandle builder = new_builder();
        REQUIRE(gnomon_scene_builder_add_triangles(builder.get(), &form, nullptr) == GNOMON_OK);
        GnomonScene* scene = nullptr;
        REQUIRE(gnomon_scene_build(builder.get(), nullptr, &scene) == GNOMON_OK);
        CHECK(same_bits(intersect(SceneHandle(scene), ray_down(0.25f, 0.5f)), expected));
    }
}
