// Rays from inside closed meshes: each must hit something. The classes are those of accuracy.md.
#define DOCTEST_CONFIG_IMPLEMENT_WITH_MAIN
#include <doctest/doctest.h>

#include <algorithm>
#include <cstdio>

#include "backend/backend.hpp"
#include "compare/describe.hpp"
#include "hard/room.hpp"
#include "harness/ray_count.hpp"

using namespace harness;

namespace {

std::unique_ptr<Backend> gnomon_backend(const Scene& scene, std::uint32_t structure, std::uint32_t quality,
                                        std::uint32_t precision) {
    GnomonBuildOptions options;
    gnomon_build_options_init(&options);
    options.structure = structure;
    options.quality = quality;
    options.precision = precision;
    return make_gnomon(scene, options);
}

std::vector<std::unique_ptr<Backend>> backends(const Scene& scene) {
    constexpr std::size_t brute_force_triangles = 200;  // more would take most of the suite's time
    std::vector<std::unique_ptr<Backend>> made;
    for (const std::uint32_t precision : {GNOMON_PRECISION_FAST, GNOMON_PRECISION_ACCURATE, GNOMON_PRECISION_EXACT}) {
        for (const std::uint32_t quality : {GNOMON_QUALITY_LOW, GNOMON_QUALITY_MEDIUM, GNOMON_QUALITY_HIGH}) {
            if (precision == GNOMON_PRECISION_EXACT && quality != GNOMON_QUALITY_MEDIUM) continue;  // ties take long
            made.push_back(gnomon_backend(scene, GNOMON_STRUCTURE_BVH, quality, precision));
            made.push_back(gnomon_backend(scene, GNOMON_STRUCTURE_WIDE_BVH, quality, precision));
        }
        if (scene.triangle_count() <= brute_force_triangles)
            made.push_back(gnomon_backend(scene, GNOMON_STRUCTURE_BRUTE_FORCE, GNOMON_QUALITY_MEDIUM, precision));
    }
    for (const bool robust : {false, true})
        if (auto embree = make_embree(scene, robust, GNOMON_QUALITY_MEDIUM, 1)) made.push_back(std::move(embree));
    return made;
}

struct Leaks {
    std::string engine;
    std::size_t ray_count = 0, intersect = 0, occluded = 0;
};

std::string label(const BuildReport& report) {
    return report.engine == "gnomon" ? "gnomon " + report.structure + " " + report.quality + " " + report.precision
                                     : report.engine;
}

/// Counts the misses of one engine; the first few of gnomon's are printed, and fail the test.
void trace(Backend& backend, const Room& room, const std::vector<GnomonRay>& rays, Leaks& leaks) {
    constexpr std::size_t printed = 3;
    std::vector<GnomonHit> hits(rays.size());
    std::vector<std::uint8_t> occluded(rays.size());
    backend.prepare(rays);
    backend.intersect(CallForm::prefilled, hits, 1);
    backend.occluded(CallForm::prefilled, occluded, 1);
    leaks.ray_count += rays.size();
    for (std::size_t i = 0; i < rays.size(); ++i) {
        const bool intersect_leaks = hits[i].geometry_id == GNOMON_INVALID_ID;
        if (!intersect_leaks && occluded[i] != 0) continue;
        leaks.intersect += intersect_leaks;
        leaks.occluded += occluded[i] == 0;
        if (backend.report().engine == "gnomon" && leaks.intersect + leaks.occluded <= 2 * printed)
            FAIL_CHECK(leaks.engine << " leaks in " << room.scene().name << ": " << ray_text(rays[i]));
    }
}

void print(const std::string& name, const std::vector<Leaks>& all) {
    std::printf("%-56s %-32s %10s %12s %12s\n", name.c_str(), "engine", "rays", "intersect", "occluded");
    for (const Leaks& leaks : all)
        std::printf("%-56s %-32s %10zu %12zu %12zu\n", "", leaks.engine.c_str(), leaks.ray_count, leaks.intersect,
                    leaks.occluded);
    std::fflush(stdout);
}

/// Shares the rays of a class among its meshes; 0 leaks of gnomon's is what passes.
void check_class(int number) {
    const auto room_class = std::ranges::find(room_classes(), number, &RoomClass::number);
    REQUIRE(room_class != room_classes().end());
    const std::vector<Scene> meshes = room_class->make_meshes();
    const std::size_t ray_count = ray_count_or(1'000'000);
    std::vector<Leaks> all;
    for (std::size_t mesh = 0; mesh < meshes.size(); ++mesh) {
        Rng rng(mesh);
        const Room room(meshes[mesh], rng);
        const std::vector<GnomonRay> rays = aim_all(room, room_class->aim, ray_count / meshes.size() + 1, rng);
        for (const auto& backend : backends(room.scene())) {
            const std::string engine = label(backend->report());
            auto leaks = std::find_if(all.begin(), all.end(), [&](const Leaks& known) { return known.engine == engine; });
            if (leaks == all.end()) leaks = all.insert(all.end(), {engine});
            trace(*backend, room, rays, *leaks);
        }
    }
    print(std::to_string(number) + " " + room_class->name, all);
    for (const Leaks& leaks : all) {
        if (!leaks.engine.starts_with("gnomon")) continue;
        CAPTURE(leaks.engine);
        CHECK(leaks.intersect == 0);
        CHECK(leaks.occluded == 0);
    }
}

}  // namespace

TEST_CASE("class_1_random_directions_never_leak") { check_class(1); }

TEST_CASE("class_2_rays_at_vertices_never_leak") { check_class(2); }

TEST_CASE("class_3_rays_at_shared_edges_never_leak") { check_class(3); }

TEST_CASE("class_4_rays_at_dyadic_edge_midpoints_never_leak") { check_class(4); }

TEST_CASE("class_5_vertices_of_valence_3_to_1000_never_leak") { check_class(5); }

TEST_CASE("class_8_meshes_far_from_the_origin_never_leak") { check_class(8); }

TEST_CASE("class_9_small_meshes_far_from_the_origin_never_leak") { check_class(9); }

TEST_CASE("class_10_meshes_at_surveyed_coordinates_never_leak") { check_class(10); }
