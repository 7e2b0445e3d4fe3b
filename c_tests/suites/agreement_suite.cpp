// Every structure, quality, thread count and call form gives the hits of the wide BVH, to the bit, on every scene there is.
#define DOCTEST_CONFIG_IMPLEMENT_WITH_MAIN
#include <doctest/doctest.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <string>
#include <vector>

#include "backend/backend.hpp"
#include "harness/ray_count.hpp"
#include "harness/rng.hpp"
#include "rays/aim.hpp"
#include "rays/rays.hpp"
#include "scene/load.hpp"

using namespace harness;

namespace {

/// Of more triangles a BSP tree takes too long.
constexpr std::size_t most_for_bsp_tree = 30'000;

struct Variant {
    std::string name;
    GnomonBuildOptions options;
};

std::vector<Variant> variants(std::size_t triangle_count) {
    const std::vector<std::pair<std::string, std::uint32_t>> structures{
        {"grid", GNOMON_STRUCTURE_GRID},         {"octree", GNOMON_STRUCTURE_OCTREE}, {"kd_tree", GNOMON_STRUCTURE_KD_TREE},
        {"bsp_tree", GNOMON_STRUCTURE_BSP_TREE}, {"bvh", GNOMON_STRUCTURE_BVH},       {"wide_bvh", GNOMON_STRUCTURE_WIDE_BVH}};
    std::vector<Variant> variants;
    for (const auto& [name, structure] : structures) {
        if (structure == GNOMON_STRUCTURE_BSP_TREE && triangle_count > most_for_bsp_tree) continue;
        for (const std::uint32_t quality : {GNOMON_QUALITY_LOW, GNOMON_QUALITY_MEDIUM, GNOMON_QUALITY_HIGH}) {
            GnomonBuildOptions options;
            gnomon_build_options_init(&options);
            options.structure = structure;
            options.quality = quality;
            options.thread_count = 1 + quality % 2;
            variants.push_back({name + " " + std::to_string(quality), options});
        }
    }
    return variants;
}

void print_difference(const std::string& scene, const std::string& variant, const GnomonRay& ray, const GnomonHit& hit,
                      const GnomonHit& expected) {
    std::printf("%s, %s: %u/%u at %a, not %u/%u at %a; ray", scene.c_str(), variant.c_str(), hit.geometry_id, hit.primitive_id,
                double(hit.t), expected.geometry_id, expected.primitive_id, double(expected.t));
    for (const float x : {ray.origin[0], ray.origin[1], ray.origin[2], ray.t_min, ray.direction[0], ray.direction[1],
                          ray.direction[2], ray.t_max})
        std::printf(" %a", double(x));
    std::printf("\n");
}

/// Returns how many answers were compared.
std::size_t check_scene(const std::string& spec, std::size_t ray_count) {
    CAPTURE(spec);
    const Scene scene = load_scene(spec);
    Rng rng(5);
    GnomonBuildOptions options;
    gnomon_build_options_init(&options);
    options.structure = GNOMON_STRUCTURE_WIDE_BVH;
    const auto reference = make_gnomon(scene, options);
    const Tracer trace = [&](const std::vector<GnomonRay>& rays) {
        std::vector<GnomonHit> hits(rays.size());
        reference->prepare(rays);
        reference->intersect(CallForm::prefilled, hits, 1);
        return hits;
    };
    const RaySet primary = primary_rays(outside_camera(scene), ray_count / 4);
    std::vector<GnomonRay> rays = primary.rays;
    for (const RaySet& set :
         {bounce_rays(scene, primary, trace(primary.rays), ray_count / 4, 1), random_rays(scene, ray_count / 4, 2)})
        rays.insert(rays.end(), set.rays.begin(), set.rays.end());
    const std::vector<GnomonRay> aimed = aimed_rays(scene, ray_count / 4, rng);
    rays.insert(rays.end(), aimed.begin(), aimed.end());
    const std::vector<GnomonHit> expected = trace(rays);

    std::size_t compared = 0;
    std::vector<GnomonHit> hits(rays.size());
    std::vector<std::uint8_t> occluded(rays.size());
    for (const Variant& variant : variants(scene.triangle_count())) {
        CAPTURE(variant.name);
        const auto backend = make_gnomon(scene, variant.options);
        backend->prepare(rays);
        // The forms by turns: others have suites of their own.
        const bool is_batch = variant.options.quality == GNOMON_QUALITY_MEDIUM;
        const CallForm form = is_batch ? CallForm::batch : CallForm::prefilled;
        backend->intersect(form, hits, 2);
        backend->occluded(form, occluded, 2);
        std::size_t differences = 0;
        for (std::size_t i = 0; i < rays.size(); ++i) {
            const bool found = expected[i].geometry_id != GNOMON_INVALID_ID;
            if (std::memcmp(&hits[i], &expected[i], sizeof hits[i]) == 0 && (occluded[i] != 0) == found) continue;
            if (differences++ < 3) print_difference(scene.name, variant.name, rays[i], hits[i], expected[i]);
        }
        CHECK(differences == 0);
        compared += rays.size();
    }
    std::printf("%-24s %9zu triangles %10zu answers\n", scene.name.c_str(), scene.triangle_count(), compared);
    std::fflush(stdout);
    return compared;
}

}  // namespace

TEST_CASE("structures_agree_on_generated_scenes") {
    const std::size_t ray_count = ray_count_or(2'000);
    for (const std::string name :
         {"soup:20000", "needles:5000", "height_field:5000", "interior", "hair:20000", "shells:20000", "teapot_in_stadium:20000"})
        CHECK(check_scene("gen:" + name, ray_count) > 0);
}

TEST_CASE("structures_agree_on_scene_files") {
    const std::filesystem::path folder = GNOMON_SHARED_SCENES;
    std::vector<std::string> files;
    if (std::filesystem::is_directory(folder))
        for (const auto& entry : std::filesystem::directory_iterator(folder))
            if (entry.path().extension() == ".glb") files.push_back(entry.path().string());
    std::sort(files.begin(), files.end());
    if (files.empty()) {
        MESSAGE("skipped: no .glb file in \"" GNOMON_SHARED_SCENES "\"");
        return;
    }
    // The large ones take most of the time to build: few of the rays need them.
    constexpr std::uintmax_t largest_usual = 4'000'000;
    std::size_t compared = 0;
    for (const std::string& file : files) {
        if (std::getenv("GNOMON_RAYS") == nullptr && std::filesystem::file_size(file) > largest_usual) continue;
        compared += check_scene(file, ray_count_or(2'000));
    }
    std::printf("%zu answers compared\n", compared);
    CHECK(compared > 0);
}
