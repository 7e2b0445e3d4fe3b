#include "api/fixtures.hpp"

#include <doctest/doctest.h>

#include <cstring>

namespace harness {

const std::vector<Named> kStructures{
    {"auto", GNOMON_STRUCTURE_AUTO},     {"brute_force", GNOMON_STRUCTURE_BRUTE_FORCE}, {"grid", GNOMON_STRUCTURE_GRID},
    {"octree", GNOMON_STRUCTURE_OCTREE}, {"kd_tree", GNOMON_STRUCTURE_KD_TREE},         {"bsp_tree", GNOMON_STRUCTURE_BSP_TREE},
    {"bvh", GNOMON_STRUCTURE_BVH},       {"wide_bvh", GNOMON_STRUCTURE_WIDE_BVH},
};
const std::vector<Named> kQualities{
    {"low", GNOMON_QUALITY_LOW},
    {"medium", GNOMON_QUALITY_MEDIUM},
    {"high", GNOMON_QUALITY_HIGH},
};
const std::vector<Named> kPrecisions{
    {"fast", GNOMON_PRECISION_FAST},
    {"accurate", GNOMON_PRECISION_ACCURATE},
    {"exact", GNOMON_PRECISION_EXACT},
};
const std::vector<Named> kIsas{
    {"auto", GNOMON_ISA_AUTO}, {"scalar", GNOMON_ISA_SCALAR}, {"sse42", GNOMON_ISA_SSE42},
    {"avx2", GNOMON_ISA_AVX2}, {"avx512", GNOMON_ISA_AVX512},
};

GnomonTriangles TriangleMesh::view() const {
    GnomonTriangles triangles{};
    triangles.positions = positions.data();
    triangles.vertex_count = positions.size() / 3;
    triangles.indices = indices.data();
    triangles.index_format = GNOMON_INDEX_U32;
    triangles.triangle_count = indices.size() / 3;
    return triangles;
}

TriangleMesh unit_triangle(float z) { return {{0, 0, z, 1, 0, z, 0, 1, z}, {0, 1, 2}}; }

TriangleMesh flat_grid(std::uint32_t cell_count, float z) {
    TriangleMesh mesh;
    const std::uint32_t row = cell_count + 1;
    for (std::uint32_t y = 0; y < row; ++y) {
        for (std::uint32_t x = 0; x < row; ++x) mesh.positions.insert(mesh.positions.end(), {float(x), float(y), z});
    }
    for (std::uint32_t y = 0; y < cell_count; ++y) {
        for (std::uint32_t x = 0; x < cell_count; ++x) {
            const std::uint32_t corner = y * row + x;
            mesh.indices.insert(mesh.indices.end(), {corner, corner + 1, corner + row});
            mesh.indices.insert(mesh.indices.end(), {corner + row + 1, corner + row, corner + 1});
        }
    }
    return mesh;
}

GnomonRay ray_down(float x, float y) { return {{x, y, 2}, 0, {0, 0, -1}, 10}; }

GnomonBuildOptions default_build_options() {
    GnomonBuildOptions options;
    gnomon_build_options_init(&options);
    return options;
}

GnomonQueryOptions threads_query_options(std::uint32_t thread_count) {
    GnomonQueryOptions options;
    gnomon_query_options_init(&options);
    options.thread_count = thread_count;
    return options;
}

SceneHandle build_scene(const std::vector<TriangleMesh>& meshes, const GnomonBuildOptions& options) {
    const BuilderHandle builder = new_builder();
    for (std::uint32_t i = 0; i < meshes.size(); ++i) {
        const GnomonTriangles triangles = meshes[i].view();
        std::uint32_t geometry_id = GNOMON_INVALID_ID;
        REQUIRE_MESSAGE(gnomon_scene_builder_add_triangles(builder.get(), &triangles, &geometry_id) == GNOMON_OK, last_error());
        REQUIRE(geometry_id == i);
    }
    GnomonScene* scene = nullptr;
    REQUIRE_MESSAGE(gnomon_scene_build(builder.get(), &options, &scene) == GNOMON_OK, last_error());
    REQUIRE(scene != nullptr);
    return SceneHandle(scene);
}

GnomonHit intersect(const SceneHandle& scene, const GnomonRay& ray) {
    GnomonHit hit;
    std::memset(&hit, 0xA5, sizeof hit);
    const bool found = gnomon_intersect(scene.get(), &ray, &hit);
    REQUIRE(found == (hit.geometry_id != GNOMON_INVALID_ID));
    REQUIRE(found == gnomon_occluded(scene.get(), &ray));
    REQUIRE(same_bits(hit, intersect_counted(scene, ray).hit));
    return hit;
}

CountedHit intersect_counted(const SceneHandle& scene, const GnomonRay& ray) {
    CountedHit answer;
    std::memset(&answer, 0xA5, sizeof answer);
    const bool found = gnomon_intersect_counted(scene.get(), &ray, &answer.hit, &answer.counts);
    REQUIRE(found == (answer.hit.geometry_id != GNOMON_INVALID_ID));
    return answer;
}

bool same_bits(const GnomonHit& a, const GnomonHit& b) { return std::memcmp(&a, &b, sizeof a) == 0; }

std::vector<Configuration> all_configurations() {
    std::vector<Configuration> configurations;
    for (const Named& structure : kStructures) {
        for (const Named& quality : kQualities) {
            for (const Named& precision : kPrecisions) {
                for (const Named& isa : kIsas) {
                    GnomonBuildOptions options = default_build_options();
                    options.structure = structure.value;
                    options.quality = quality.value;
                    options.precision = precision.value;
                    options.isa = isa.value;
                    options.thread_count = 1;
                    const std::string name = structure.name + " " + quality.name + " " + precision.name + " " + isa.name;
                    configurations.push_back({name, options});
                    if (structure.value != GNOMON_STRUCTURE_WIDE_BVH) continue;
                    options.compact = 1;
                    configurations.push_back({name + " compact", options});
                }
            }
        }
    }
    return configurations;
}

}  // namespace harness
