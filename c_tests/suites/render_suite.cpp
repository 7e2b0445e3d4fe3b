// Pictures whose every pixel is known: the white furnace, a box without light, lamps over a plane; and what must not change them.
#define DOCTEST_CONFIG_IMPLEMENT_WITH_MAIN
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <map>
#include <numbers>
#include <string>

#include "harness/mean.hpp"
#include "rays/vector.hpp"
#include "render/camera_ray.hpp"
#include "render/render.hpp"
#include "render/surface_hit.hpp"
#include "render/traced_scene.hpp"
#include "render/triangle.hpp"
#include "scene/load.hpp"
#include "scene/mesh_parts.hpp"
#include "suites/render_parts.hpp"

using namespace harness;
using render::MaterialKind;
using render::Method;
using render::RenderOptions;
using render::RenderScene;
using render::Rgb;

namespace {

/// Nothing absorbs, and light of 1 nt comes from everywhere: so all there is has 1 nt (Planck's furnace).
RenderScene furnace() {
    RenderScene scene;
    const std::uint32_t diffuse = add_material(scene, MaterialKind::diffuse, 1),
                        mirror = add_material(scene, MaterialKind::mirror, 1),
                        glass = add_material(scene, MaterialKind::glass, 1);
    add_surface(scene, ball({-3, 0, 0}, 1), diffuse);
    Mesh torus;
    add_torus(torus, 48, 24, {-0.6, 0, 0}, 0.8, 0.35);
    add_surface(scene, torus, diffuse);
    add_surface(scene, without_top(inward_box({-2, -3, -2}, {2, 2.5, -1.1})), diffuse);
    add_surface(scene, ball({1.6, 0, 0}, 1), mirror);
    add_surface(scene, ball({4, 0, 0}, 1), glass);
    Mesh block;
    add_box(block, {2.2, -3, -1}, {3.4, -2, 0.5});
    add_surface(scene, block, glass);
    scene.environment_nt = grey(1);
    return scene;
}

/// By what the ray through a pixel's centre hits first.
std::map<std::string, Mean> by_class(const RenderScene& scene, const Sight& sight, const render::Image& image) {
    const char* const names[] = {"diffuse", "mirror", "glass"};
    std::map<std::string, Mean> means;
    for (std::size_t i = 0; i < sight.hits.size(); ++i) {
        const std::uint32_t geometry_id = sight.hits[i].geometry_id;
        const std::string name =
            geometry_id == GNOMON_INVALID_ID
                ? "background"
                : names[static_cast<std::size_t>(scene.materials[scene.surfaces[geometry_id].material_id].kind)];
        means[name].add(image.pixels[i][1]);
        means["all"].add(image.pixels[i][1]);
    }
    return means;
}

std::map<std::string, Mean> furnace_figures(Method method, const char* name) {
    const RenderScene scene = furnace();
    const render::Camera camera = camera_at({0.5, -9, 4}, {0.5, 0, -0.2}, 0.4, 1.6);
    const RenderOptions options{.width = 480, .height = 300, .sample_count = 1, .method = method};
    const auto means = by_class(scene, sight_of(scene, camera, options), picture_of(scene, camera, options).image);
    for (const auto& [kind, mean] : means)
        std::printf("furnace, %-8s %-11s %7zu pixels, %.6f +- %.6f nt\n", name, kind.c_str(), mean.count, mean.mean,
                    mean.standard_error());
    std::fflush(stdout);
    return means;
}

}  // namespace

TEST_CASE("furnace_by_paths_is_one_in_every_class") {
    const auto means = furnace_figures(Method::path, "path");
    CHECK(means.size() == 5);
    for (const auto& [kind, mean] : means) {
        CAPTURE(kind);
        CHECK(mean.count > 1000);
        CHECK(std::abs(mean.mean - 1) <= most_standard_errors * mean.standard_error());
    }
    CHECK(means.at("background").mean == 1);
}

TEST_CASE("furnace_by_whitted_loses_what_diffuse_surfaces_get_from_all_around") {
    auto means = furnace_figures(Method::whitted, "whitted");
    CHECK(means["background"].mean == 1);
    CHECK(means["diffuse"].mean == 0);
    for (const char* kind : {"mirror", "glass"}) {
        CHECK(means[kind].mean > 0);
        CHECK(means[kind].mean < 1);
    }
}

TEST_CASE("direction_along_a_surface_leads_to_no_side") {
    const Vec3d normal = {0, 0, 1};
    for (const double scale : {1e-30, 1.0, 1e30}) {
        CHECK(render::side_of(scale * Vec3d{1, 0, 0x1p-23}, normal) == 1);
        CHECK(render::side_of(scale * Vec3d{1, 0, -0x1p-23}, normal) == -1);
        CHECK(render::side_of(scale * Vec3d{1, 0, 0x1p-25}, normal) == 0);
        CHECK(render::side_of(scale * Vec3d{1, 0, -0x1p-25}, normal) == 0);
    }
    CHECK(render::side_of({0, 0, std::nan("")}, normal) == 0);
}

TEST_CASE("closed_box_is_black_inside_whatever_shines_outside") {
    for (const std::uint32_t precision : {GNOMON_PRECISION_ACCURATE, GNOMON_PRECISION_EXACT}) {
        for (const bool has_lid : {true, false}) {
            RenderScene scene;
            const std::uint32_t white = add_material(scene, MaterialKind::diffuse, 1),
                                mirror = add_material(scene, MaterialKind::mirror, 1),
                                glass = add_material(scene, MaterialKind::glass, 1),
                                lamp = add_material(scene, MaterialKind::diffuse, 0, 1e6F);
            Mesh box = inward_box({-1, -1, -1}, {1, 1, 1});
            if (!has_lid) box = without_top(box);
            // No wall along an axis.
            for (std::size_t i = 0; i < box.positions.size(); i += 3) {
                const Vec3d p = to_double(Vec3f{box.positions[i], box.positions[i + 1], box.positions[i + 2]});
                const Vec3d turned = {0.8 * p[0] - 0.6 * p[1], 0.48 * p[0] + 0.64 * p[1] - 0.6 * p[2],
                                      0.36 * p[0] + 0.48 * p[1] + 0.8 * p[2]};
                for (std::size_t axis = 0; axis < 3; ++axis) box.positions[i + axis] = static_cast<float>(turned[axis] + 0.3);
            }
            add_surface(scene, box, white);
            add_surface(scene, ball({0.1, 0.2, 0}, 0.2), mirror);
            add_surface(scene, ball({0.5, 0.5, 0.5}, 0.2), glass);
            add_surface(scene, square(3, {0, 0, 4}, true), lamp);
            scene.point_lights.push_back({{0.1F, -0.8F, 3}, grey(1e6F), infinity});
            scene.directional_lights.push_back({{0, 0, -1}, grey(1e6F)});
            scene.environment_nt = grey(1e6F);
            const render::Camera camera = camera_at({0.3, -0.3, 0.3}, {0.3, 0.3, 0.3}, 1, 1);
            for (const Method method : {Method::path, Method::whitted}) {
                const auto rendering = picture_of(scene, camera,
                                                  {.width = 256,
                                                   .height = 256,
                                                   .sample_count = method == Method::path ? 1 : 8,
                                                   .method = method,
                                                   .precision = precision});
                CAPTURE(precision);
                CAPTURE(has_lid);
                CAPTURE(static_cast<int>(method));
                const auto lit = std::ranges::count_if(rendering.image.pixels, [](const Rgb& pixel) { return pixel != grey(0); });
                if (has_lid) {
                    CHECK(rendering.ray_count > 1'000'000);
                    CHECK(lit == 0);
                } else {
                    CHECK(lit > 10'000);
                }
            }
        }
    }
}

TEST_CASE("picture_does_not_depend_on_threads") {
    RenderScene scene = furnace();
    const std::uint32_t lamp = add_material(scene, MaterialKind::diffuse, 0.5F, 10);
    add_surface(scene, square(1, {0, 0, 3}, true), lamp);
    scene.point_lights.push_back({{0, -5, 5}, grey(10), infinity});
    const render::Camera camera = camera_at({0.5, -9, 4}, {0.5, 0, -0.2}, 0.4, 1.6);
    for (const Method method : {Method::path, Method::whitted}) {
        RenderOptions options{.width = 100, .height = 70, .sample_count = 5, .method = method, .thread_count = 1, .seed = 7};
        const auto once = picture_of(scene, camera, options);
        options.thread_count = 3;
        const auto again = picture_of(scene, camera, options);
        CHECK(once.image.pixels == again.image.pixels);
        CHECK(once.ray_count == again.ray_count);
        options.seed = 8;
        CHECK(once.image.pixels != picture_of(scene, camera, options).image.pixels);
    }
}

TEST_CASE("stopped_rendering_leaves_a_whole_picture") {
    const RenderScene scene = furnace();
    const render::Camera camera = camera_at({0.5, -9, 4}, {0.5, 0, -0.2}, 0.4, 1.6);
    const RenderOptions options{.width = 100, .height = 70, .sample_count = 1000};
    constexpr std::uint64_t pixel_count = 7000;
    for (const std::uint64_t stop_after : {std::uint64_t{0}, 3 * pixel_count}) {
        std::atomic<bool> stop{stop_after == 0};
        std::atomic<std::uint64_t> taken{0};
        const auto rendering = render::render(
            scene, camera, options,
            [&](std::uint64_t samples) {
                if ((taken += samples) >= stop_after) stop = true;
            },
            stop);
        CHECK_FALSE(rendering.is_complete);
        CHECK(rendering.samples_per_pixel * pixel_count == doctest::Approx(taken));
        CHECK(rendering.samples_per_pixel >= 1);
        CHECK(rendering.samples_per_pixel < 10);
        const auto black = std::ranges::count_if(rendering.image.pixels, [](const Rgb& pixel) { return pixel == grey(0); });
        CHECK(black < 70);  // a path may end by chance before it leaves
    }
}

TEST_CASE("terminator_is_where_facets_turn_from_the_lamp") {
    RenderScene scene;
    add_surface(scene, ball({0, 0, 0}, 1, 60), add_material(scene, MaterialKind::diffuse, 1));  // 72,000 triangles
    const Mesh& mesh = scene.surfaces[0].mesh;
    const render::Camera camera = camera_at({0, -5, 0}, {0, 0, 0}, 0.21, 1);
    for (const std::uint32_t precision : {GNOMON_PRECISION_ACCURATE, GNOMON_PRECISION_EXACT}) {
        for (const float distance : {1.05F, 3.0F, 1000.0F}) {
            scene.point_lights = {{{0.8F * distance, -0.6F * distance, 0}, grey(1), infinity}};
            const Vec3d lamp = to_double(scene.point_lights[0].position);
            for (const Method method : {Method::whitted, Method::path}) {
                const RenderOptions options{
                    .width = 500, .height = 500, .sample_count = 1, .max_depth = 1, .method = method, .precision = precision};
                const auto rendering = picture_of(scene, camera, options);
                const Sight sight = sight_of(scene, camera, options);
                std::size_t lit_count = 0, dark_count = 0, wrong_count = 0;
                for (std::size_t i = 0; i < sight.hits.size(); ++i) {
                    if (sight.hits[i].geometry_id == GNOMON_INVALID_ID) continue;
                    const auto [a, b, c] = render::triangle_of(mesh, sight.hits[i].primitive_id);
                    const Vec3d normal = cross(to_double(b) - to_double(a), to_double(c) - to_double(a));
                    const bool faces_lamp = dot(normal, lamp - to_double(a)) > 0;
                    (faces_lamp ? lit_count : dark_count) += 1;
                    wrong_count += (rendering.image.pixels[i][0] > 0) != faces_lamp;
                }
                CAPTURE(precision);
                CAPTURE(distance);
                CHECK(lit_count > 5'000);
                CHECK(dark_count > 10'000);
                CHECK(wrong_count == 0);
            }
        }
    }
}
