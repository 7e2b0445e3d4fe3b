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

TEST_CASE("sources_and_lamps_are_read_to_their_end_alone") {
    const SceneHandle scene = build_scene({unit_triangle(9)});
    const GuardedArray point(std::vector<float>{0, 0, 0}), normal(std::vector<float>{0, 0, 1});
    const GuardedArray points(std::vector<GnomonPointSource>(3, {{0, 0, 1}, 1, 0}));
    const GuardedArray spots(std::vector<GnomonSpotSource>(3, {{0, 0, 1}, 1, {0, 0, -1}, 0, 0, 1}));
    const GuardedArray directionals(std::vector<GnomonDirectionalSource>(3, {{0, 0, -1}, 1}));
    const GuardedArray spheres(std::vector<GnomonSphereSource>(3, {{0, 0, 2}, 1, 1}));
    // 16 bytes a vertex and 8 a triangle, but for the last ones.
    const GuardedArray positions(std::vector<float>{0, 0, 1, kNan, 1, 0, 1, kNan, 0, 1, 1});
    const GuardedArray indices(std::vector<std::uint16_t>{0, 2, 1, 0xFFFF, 0, 2, 1});
    const GuardedArray areas(
        std::vector<GnomonAreaSource>(3, {{positions.data(), 16, 3, indices.data(), GNOMON_INDEX_U16, 8, 2}, 1, 0}));
    const GuardedArray sources(std::vector<GnomonSources>(1, {sizeof(GnomonSources), points.data(), 3, spots.data(), 3,
                                                              directionals.data(), 3, spheres.data(), 3, areas.data(), 3}));
    const GuardedArray options(std::vector<GnomonIrradianceOptions>(1, {sizeof(GnomonIrradianceOptions), 1, 64, 0}));
    const GuardedArray answer(std::vector<GnomonIrradiance>(1));
    REQUIRE_MESSAGE(
        gnomon_irradiance(scene.get(), sources.data(), point.data(), normal.data(), options.data(), answer.data()) == GNOMON_OK,
        last_error());
    CHECK((answer.data()->illuminance_lx > 9 && answer.data()->ray_count == 9 + 64));
}

TEST_CASE("polygons_spectra_and_samples_are_touched_to_their_end_alone") {
    const GuardedArray point(std::vector<float>{0, 0, 0}), normal(std::vector<float>{0, 0, 1});
    const GuardedArray vertices(std::vector<float>{1, 0, 0, 0, 1, 0, 0, 0, 1});
    const GuardedArray number(std::vector<double>{7});
    REQUIRE(gnomon_polygon_solid_angle_sr(point.data(), vertices.data(), 3, number.data()) == GNOMON_OK);
    CHECK(*number.data() ==
          gnomon_triangle_solid_angle_sr(point.data(), vertices.data(), vertices.data() + 3, vertices.data() + 6));
    const GuardedArray wavelengths(std::vector<double>{500, 600}), powers(std::vector<double>{1, 2});
    REQUIRE(gnomon_luminous_efficacy_lm_per_w(wavelengths.data(), powers.data(), 2, number.data()) == GNOMON_OK);
    CHECK(*number.data() > 100);
    const GuardedArray sample(std::vector<GnomonDirectionSample>(1));
    REQUIRE(gnomon_sample_cosine_hemisphere(normal.data(), 0, 0, sample.data()) == GNOMON_OK);
    CHECK(sample.data()->direction[2] == 1);
}
