// Builds under a limit on address space: too large a build answers OUT_OF_MEMORY, and the builder stays usable.
#include <doctest/doctest.h>
#include <malloc.h>
#include <sys/resource.h>
#include <unistd.h>

#include <cstdint>
#include <fstream>
#include <string>

#include "api/fixtures.hpp"

using namespace harness;

namespace {

constexpr std::size_t kMebibyte = std::size_t(1) << 20;

/// Address space that malloc keeps for itself would serve a build under the limit: so it gives every large block a mapping of its
/// own, and no thread a reserve of 64 MiB.
const bool kMallocKeepsNoReserve = mallopt(M_MMAP_THRESHOLD, 64 * 1024) == 1 && mallopt(M_ARENA_MAX, 1) == 1;

/// Caps the process's address space at what it has now plus `headroom_bytes`, as `ulimit -v` does, for this object's life.
class AddressSpaceLimit {
public:
    explicit AddressSpaceLimit(std::size_t headroom_bytes) {
        std::size_t used_pages = 0;
        std::ifstream("/proc/self/statm") >> used_pages;
        REQUIRE(getrlimit(RLIMIT_AS, &before_) == 0);
        const rlimit limit{used_pages * std::size_t(sysconf(_SC_PAGESIZE)) + headroom_bytes, before_.rlim_max};
        REQUIRE(setrlimit(RLIMIT_AS, &limit) == 0);
    }
    ~AddressSpaceLimit() { setrlimit(RLIMIT_AS, &before_); }
    AddressSpaceLimit(const AddressSpaceLimit&) = delete;
    AddressSpaceLimit& operator=(const AddressSpaceLimit&) = delete;

private:
    rlimit before_;
};

GnomonStatus build_within(std::size_t headroom_bytes, const BuilderHandle& builder, const GnomonBuildOptions& options,
                          SceneHandle& scene_out) {
    const AddressSpaceLimit limit(headroom_bytes);
    GnomonScene* scene = nullptr;
    const GnomonStatus status = gnomon_scene_build(builder.get(), &options, &scene);
    scene_out.reset(scene);
    return status;
}

}  // namespace

TEST_CASE("build_too_large_for_the_address_space_is_out_of_memory_and_the_builder_stays_usable") {
    REQUIRE(kMallocKeepsNoReserve);
    const TriangleMesh mesh = flat_grid(600);
    const GnomonTriangles triangles = mesh.view();
    const BuilderHandle builder = new_builder();
    REQUIRE(gnomon_scene_builder_add_triangles(builder.get(), &triangles, nullptr) == GNOMON_OK);

    for (const Named& structure : kStructures) {
        for (const std::uint32_t thread_count : {1u, 2u}) {
            CAPTURE(structure.name);
            CAPTURE(thread_count);
            GnomonBuildOptions options = default_build_options();
            options.structure = structure.value;
            options.thread_count = thread_count;
            SceneHandle scene;
            // From far too little to enough, so that the failing allocation is a different one each time; with room for the
            // threads' stacks, without which the system can't start them.
            std::uint32_t refusal_count = 0;
            for (std::size_t headroom = (thread_count == 1 ? 2 : 16) * kMebibyte; headroom <= 1024 * kMebibyte; headroom *= 2) {
                CAPTURE(headroom);
                const GnomonStatus status = build_within(headroom, builder, options, scene);
                if (status == GNOMON_OK) break;
                ++refusal_count;
                CHECK_MESSAGE(status == GNOMON_ERROR_OUT_OF_MEMORY, last_error());
                CHECK(scene == nullptr);
                CHECK(last_error().find("bytes") != std::string::npos);
            }
            CHECK(refusal_count > 0);
            REQUIRE(scene != nullptr);
            CHECK(intersect(scene, ray_down(0.25f, 0.25f)).t == 2);
        }
    }
}

TEST_CASE("table_of_places_too_large_for_the_address_space_is_out_of_memory_and_a_later_call_makes_it") {
    const SceneHandle scene = build_scene({flat_grid(1500)});
    const GnomonRay ray = ray_down(0.25f, 0.25f);
    const GnomonHit hit = intersect(scene, ray);
    GnomonSurfacePoint point;
    {
        const AddressSpaceLimit limit(8 * kMebibyte);
        CHECK(gnomon_surface_point(scene.get(), &ray, &hit, &point) == GNOMON_ERROR_OUT_OF_MEMORY);
        CHECK(last_error().find("18000000 bytes") != std::string::npos);
    }
    CHECK(gnomon_surface_point(scene.get(), &ray, &hit, &point) == GNOMON_OK);
}

TEST_CASE("geometry_too_large_for_the_address_space_is_out_of_memory_and_the_builder_is_as_it_was") {
    const BuilderHandle builder = new_builder();
    const TriangleMesh small = unit_triangle();
    const TriangleMesh large = flat_grid(1500);
    const GnomonTriangles small_triangles = small.view();
    const GnomonTriangles large_triangles = large.view();
    REQUIRE(gnomon_scene_builder_add_triangles(builder.get(), &small_triangles, nullptr) == GNOMON_OK);
    std::uint32_t geometry_id = GNOMON_INVALID_ID;
    {
        const AddressSpaceLimit limit(8 * kMebibyte);
        CHECK(gnomon_scene_builder_add_triangles(builder.get(), &large_triangles, &geometry_id) == GNOMON_ERROR_OUT_OF_MEMORY);
    }
    CHECK(geometry_id == GNOMON_INVALID_ID);
    REQUIRE(gnomon_scene_builder_add_triangles(builder.get(), &small_triangles, &geometry_id) == GNOMON_OK);
    CHECK(geometry_id == 1);
}

TEST_CASE("samples_that_no_memory_can_hold_are_out_of_memory") {
    const SceneHandle scene = build_scene({unit_triangle(1)});
    const GnomonSphereSource sphere{{0, 0, 2}, 0.5f, 100};
    GnomonSources sources{};
    sources.struct_size = sizeof sources;
    sources.spheres = &sphere, sources.sphere_count = 1;
    const float point[3] = {0, 0, 0}, up[3] = {0, 0, 1};
    GnomonIrradianceOptions options;
    gnomon_irradiance_options_init(&options);
    options.sample_count = UINT64_MAX;
    GnomonIrradiance answer{7, 7, 7};
    CHECK(gnomon_irradiance(scene.get(), &sources, point, up, &options, &answer) == GNOMON_ERROR_OUT_OF_MEMORY);
    CHECK(last_error() == "there is no memory for 18446744073709551615 samples");
    CHECK((answer.illuminance_lx == 7 && answer.standard_error_lx == 7 && answer.ray_count == 7));
}
