// Scenes are queried from many threads, batches answer as single calls do, and each thread has its own last error.
#include <doctest/doctest.h>

#include <atomic>
#include <cstdint>
#include <string>
#include <thread>
#include <vector>

#include "api/fixtures.hpp"
#include "harness/rng.hpp"

using namespace harness;

namespace {

constexpr std::uint32_t kCells = 16;

std::vector<GnomonRay> slanted_rays(std::size_t count, std::uint64_t seed) {
    Rng rng(seed);
    std::vector<GnomonRay> rays(count);
    for (GnomonRay& ray : rays) {
        for (float& origin : ray.origin) origin = float(rng.uniform(-2, kCells + 2));
        for (float& direction : ray.direction) direction = float(rng.uniform(-1, 1));
        ray.t_min = 0;
        ray.t_max = kInfinity;
    }
    return rays;
}

std::vector<GnomonHit> intersect_each(const SceneHandle& scene, const std::vector<GnomonRay>& rays) {
    std::vector<GnomonHit> hits;
    for (const GnomonRay& ray : rays) hits.push_back(intersect(scene, ray));
    return hits;
}

std::size_t difference_count(const std::vector<GnomonHit>& a, const std::vector<GnomonHit>& b) {
    std::size_t count = 0;
    for (std::size_t i = 0; i < a.size(); ++i) count += !same_bits(a[i], b[i]);
    return count;
}

}  // namespace

TEST_CASE("batch_on_any_thread_count_equals_single_calls_to_the_bit") {
    const std::vector<GnomonRay> rays = slanted_rays(1000, 1);
    for (const Configuration& configuration : all_configurations()) {
        CAPTURE(configuration.name);
        const SceneHandle scene = build_scene({flat_grid(kCells, 3), flat_grid(kCells, 9)}, configuration.options);
        const std::vector<GnomonHit> expected = intersect_each(scene, rays);
        for (const std::uint32_t thread_count : {0u, 1u, 2u}) {
            CAPTURE(thread_count);
            const GnomonQueryOptions options = threads_query_options(thread_count);
            std::vector<GnomonHit> hits(rays.size());
            std::vector<std::uint8_t> occluded(rays.size(), 0xA5);
            REQUIRE(gnomon_intersect_n(scene.get(), rays.data(), rays.size(), hits.data(), &options) == GNOMON_OK);
            REQUIRE(gnomon_occluded_n(scene.get(), rays.data(), rays.size(), occluded.data(), &options) == GNOMON_OK);
            CHECK(difference_count(hits, expected) == 0);
            std::size_t occlusion_differences = 0;
            for (std::size_t i = 0; i < rays.size(); ++i) {
                occlusion_differences += occluded[i] != (expected[i].geometry_id != GNOMON_INVALID_ID);
            }
            CHECK(occlusion_differences == 0);
        }
    }
}

TEST_CASE("two_threads_query_while_a_third_builds") {
    const std::vector<GnomonRay> rays = slanted_rays(2000, 2);
    const SceneHandle scene = build_scene({flat_grid(kCells, 3)});
    const std::vector<GnomonHit> expected = intersect_each(scene, rays);

    std::atomic<bool> building = true;
    std::atomic<std::size_t> difference_total = 0, round_total = 0;
    const auto query = [&] {
        do {
            std::vector<GnomonHit> hits(rays.size());
            for (std::size_t i = 0; i < rays.size(); ++i) gnomon_intersect(scene.get(), &rays[i], &hits[i]);
            difference_total += difference_count(hits, expected);
            ++round_total;
        } while (building);
    };
    std::thread first(query), second(query);
    for (int i = 0; i < 5; ++i) build_scene({flat_grid(60)});
    building = false;
    first.join();
    second.join();
    CHECK(round_total >= 2);
    CHECK(difference_total == 0);
}

TEST_CASE("last_error_belongs_to_its_thread") {
    const GnomonTriangles seven_vertices{nullptr, 0, 7, nullptr, 0, 0, 0};
    const BuilderHandle builder = new_builder();
    REQUIRE(gnomon_scene_builder_add_triangles(builder.get(), &seven_vertices, nullptr) != GNOMON_OK);
    const std::string mine = last_error();

    std::string others_before, others_after;
    std::thread([&] {
        others_before = last_error();
        GnomonScene* scene = nullptr;
        if (gnomon_scene_build(nullptr, nullptr, &scene) != GNOMON_OK) others_after = last_error();
    }).join();
    CHECK(others_before == "");
    CHECK(others_after != "");
    CHECK(others_after != mine);
    CHECK(last_error() == mine);
}
