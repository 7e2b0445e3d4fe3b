// Callers' buffers that end right before unreadable memory: a read or write past the stated size ends the process.
#include <doctest/doctest.h>
#include <sys/mman.h>
#include <unistd.h>

#include <cstdint>
#include <cstring>
#include <vector>

#include "api/fixtures.hpp"

using namespace harness;

namespace {

/// A copy of `values` whose last byte is the last of a page; the next page has no access rights.
template <typename T>
class GuardedArray {
public:
    explicit GuardedArray(const std::vector<T>& values) {
        const std::size_t page_bytes = std::size_t(sysconf(_SC_PAGESIZE));
        const std::size_t data_bytes = values.size() * sizeof(T);
        const std::size_t used_bytes = (data_bytes + page_bytes - 1) / page_bytes * page_bytes;
        mapped_bytes_ = used_bytes + page_bytes;
        mapping_ = mmap(nullptr, mapped_bytes_, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
        REQUIRE(mapping_ != MAP_FAILED);
        std::uint8_t* const guard = static_cast<std::uint8_t*>(mapping_) + used_bytes;
        REQUIRE(mprotect(guard, page_bytes, PROT_NONE) == 0);
        std::memcpy(guard - data_bytes, values.data(), data_bytes);
        data_ = reinterpret_cast<T*>(guard - data_bytes);
    }
    ~GuardedArray() { munmap(mapping_, mapped_bytes_); }
    GuardedArray(const GuardedArray&) = delete;
    GuardedArray& operator=(const GuardedArray&) = delete;

    T* data() const { return data_; }

private:
    void* mapping_;
    std::size_t mapped_bytes_;
    T* data_;
};

SceneHandle build(const GnomonTriangles& triangles, const GnomonBuildOptions& options) {
    const BuilderHandle builder = new_builder();
    REQUIRE(gnomon_scene_builder_add_triangles(builder.get(), &triangles, nullptr) == GNOMON_OK);
    GnomonScene* scene = nullptr;
    REQUIRE(gnomon_scene_build(builder.get(), &options, &scene) == GNOMON_OK);
    return SceneHandle(scene);
}

}  // namespace

TEST_CASE("packed_positions_and_32_bit_indices_are_read_to_their_end_alone") {
    const TriangleMesh mesh = flat_grid(7);
    const GuardedArray positions(mesh.positions);
    const GuardedArray indices(mesh.indices);
    GnomonTriangles triangles = mesh.view();
    triangles.positions = positions.data();
    triangles.indices = indices.data();
    for (const Configuration& configuration : all_configurations()) {
        CAPTURE(configuration.name);
        CHECK(intersect(build(triangles, configuration.options), ray_down(6.75f, 6.75f)).primitive_id == 97);
    }
}

TEST_CASE("strided_positions_and_16_bit_indices_are_read_to_their_last_element_alone") {
    const GuardedArray positions(
        std::vector<float>{0, 0, 0, kNan, 1, 0, 0, kNan, 0, 1, 0});                    // 16 bytes a vertex but for the last
    const GuardedArray indices(std::vector<std::uint16_t>{0, 1, 2, 0xFFFF, 2, 1, 0});  // 8 bytes a triangle but for the last
    GnomonTriangles triangles{};
    triangles.positions = positions.data();
    triangles.position_stride = 16;
    triangles.vertex_count = 3;
    triangles.indices = indices.data();
    triangles.index_format = GNOMON_INDEX_U16;
    triangles.index_stride = 8;
    triangles.triangle_count = 2;
    CHECK(intersect(build(triangles, default_build_options()), ray_down(0.25f, 0.25f)).t == 2);
}

TEST_CASE("rays_and_answers_are_touched_to_their_end_alone") {
    for (const Configuration& configuration : all_configurations()) {
        CAPTURE(configuration.name);
        const SceneHandle scene = build_scene({flat_grid(7)}, configuration.options);
        for (const std::size_t count : {1u, 3u, 16u, 37u}) {
            CAPTURE(count);
            const GuardedArray rays(std::vector<GnomonRay>(count, ray_down(0.25f, 0.25f)));
            const GuardedArray hits(std::vector<GnomonHit>(count, GnomonHit{}));
            const GuardedArray occluded(std::vector<std::uint8_t>(count, 0xA5));
            REQUIRE(gnomon_intersect_n(scene.get(), rays.data(), count, hits.data(), nullptr) == GNOMON_OK);
            REQUIRE(gnomon_occluded_n(scene.get(), rays.data(), count, occluded.data(), nullptr) == GNOMON_OK);
            REQUIRE(gnomon_intersect(scene.get(), &rays.data()[count - 1], &hits.data()[count - 1]));
            CHECK(hits.data()[count - 1].t == 2);
            CHECK(occluded.data()[count - 1] == 1);
        }
    }
}
