// Light of lamps: what closed forms say of a plane below them, and that all strategies have the same mean.
#define DOCTEST_CONFIG_IMPLEMENT_WITH_MAIN
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <string>
#include <vector>

#include "harness/mean.hpp"
#include "harness/triangles.hpp"
#include "render/camera_ray.hpp"
#include "render/traced_scene.hpp"
#include "suites/render_parts.hpp"

using namespace harness;
using render::MaterialKind;
using render::Method;
using render::RenderOptions;
using render::RenderScene;
using render::Strategy;

namespace {

constexpr double unit_roundoff = 0x1p-24;
constexpr float reflectance = 0.5F;

/// A diffuse floor at z = 0.
RenderScene floor_scene() {
    RenderScene scene;
    add_surface(scene, square(100, {0, 0, 0}, false), add_material(scene, MaterialKind::diffuse, reflectance));
    return scene;
}

const render::Camera camera = camera_at({1, -3, 4}, {0, 0, 0}, 0.4, 1);

/// Where the ray through a pixel's centre meets the floor.
Vec3d floor_point(const RenderOptions& options, std::size_t pixel) {
    const auto width = static_cast<std::size_t>(options.width);
    const double x = static_cast<double>(pixel % width) + 0.5, y = static_cast<double>(pixel / width) + 0.5;
    const GnomonRay ray = camera_ray(camera, x / options.width, y / options.height);
    const Vec3d origin = to_double(ray.origin), direction = to_double(ray.direction);
    return origin - (origin[2] / direction[2]) * direction;
}

/// What a lamp gives a place of the floor, and how much of that an end of its range or of its cone leaves.
struct Expected {
    double illuminance_lx, attenuation;
};

/// Every pixel is what `expected` says of its place, to float precision. The place is off by u |P| along each axis: that moves
/// the cosine and the square of the distance by 3 u |P| / d, and the attenuation by `slope` times |P| u / d; ten roundings are on
/// the way to the pixel.
template <typename At>
void check_floor(const RenderScene& scene, double least_distance, double slope, At expected_at) {
    for (const Method method : {Method::whitted, Method::path}) {
        const RenderOptions options{.width = 200, .height = 200, .sample_count = 1, .max_depth = 1, .method = method};
        const auto rendering = picture_of(scene, camera, options);
        double worst = 0;
        for (std::size_t pixel = 0; pixel < rendering.image.pixels.size(); ++pixel) {
            const Vec3d point = floor_point(options, pixel);
            const auto [illuminance, attenuation] = expected_at(point);
            const double full = illuminance * reflectance / std::numbers::pi, off = length(point) / least_distance;
            const double bound = unit_roundoff * full * ((10 + 3 * off) * attenuation + slope * off);
            const double error = std::abs(rendering.image.pixels[pixel][0] - full * attenuation);
            if (error > 0) worst = std::max(worst, error / bound);
        }
        std::printf("floor: worst error is %.2f of the bound\n", worst);
        CHECK(worst <= 1);
    }
}

}  // namespace

TEST_CASE("point_lamp_over_a_plane_is_intensity_cosine_over_square_of_the_distance") {
    RenderScene scene = floor_scene();
    const Vec3f lamp = {0.5F, 0.25F, 2};
    add_surface(scene, ball({0.5, 0.25, 2.6}, 0.3), add_material(scene, MaterialKind::diffuse, 0));  // behind it: hides nothing
    for (const float range : {infinity, 3.0F}) {
        scene.point_lights = {{lamp, grey(70), range}};
        // 1 - (d / range)^4 has a slope of 4 / range at the end.
        check_floor(scene, lamp[2], std::isinf(range) ? 0 : 4, [&](const Vec3d& point) -> Expected {
            const Vec3d way = to_double(lamp) - point;
            const double distance = length(way);
            return {70 * way[2] / (distance * distance * distance), gnomon_range_attenuation(distance, range)};
        });
    }
}

TEST_CASE("spot_lamp_over_a_plane_ends_at_its_cone") {
    RenderScene scene = floor_scene();
    const Vec3f lamp = {0, 0, 2};
    const float inner = 0.2F, outer = 0.4F;
    scene.spot_lights = {{lamp, {0, 0, -1}, grey(50), infinity, inner, outer}};
    // The square of a share that goes from 0 to 1 as the cosine does between the cones.
    const double slope = 2 / (std::cos(inner) - std::cos(outer));
    check_floor(scene, lamp[2], slope, [&](const Vec3d& point) -> Expected {
        const Vec3d way = to_double(lamp) - point;
        const double distance = length(way), cosine = way[2] / distance;
        return {50 * cosine / (distance * distance), gnomon_spot_attenuation(std::acos(cosine), inner, outer)};
    });
}

TEST_CASE("directional_lamp_over_a_plane_is_its_illuminance_times_the_cosine") {
    RenderScene scene = floor_scene();
    scene.directional_lights = {{{0.6F, 0, -0.8F}, grey(100)}};
    check_floor(scene, 1, 0, [](const Vec3d&) { return Expected{100 * double{0.8F}, 1}; });
    scene.directional_lights[0].direction[2] = 0.8F;
    check_floor(scene, 1, 0, [](const Vec3d&) { return Expected{0, 1}; });
}

namespace {

/// What a square of 1 nt at a height gives a plane below its centre: Lambert's polygon, four sides alike.
double illuminance_below_square(double half_side, double height) {
    const double slant = std::hypot(half_side, height), angle = 2 * std::atan(half_side / slant);
    return 0.5 * 4 * angle * half_side / slant;
}

/// What gnomon_irradiance says of the floor below a lamp, in lx; `blockers` may be null. With one seed for all places they would
/// be off together.
GnomonIrradiance floor_irradiance(const Mesh& lamp, float luminance_nt, const GnomonScene* blockers, const Vec3d& point,
                                  std::uint64_t seed) {
    const GnomonAreaSource source = {triangles_of(lamp), luminance_nt, 0};
    GnomonSources sources{};
    sources.struct_size = sizeof sources;
    sources.areas = &source, sources.area_count = 1;
    GnomonIrradianceOptions options;
    gnomon_irradiance_options_init(&options);
    options.thread_count = 1, options.sample_count = 64, options.seed = seed;
    const float normal[3] = {0, 0, 1};
    GnomonIrradiance irradiance;
    REQUIRE_MESSAGE(gnomon_irradiance(blockers, &sources, to_float(point).data(), normal, &options, &irradiance) == GNOMON_OK,
                    gnomon_last_error());
    return irradiance;
}

struct Way {
    const char* name;
    Method method;
    Strategy strategy;
};
constexpr Way ways[] = {{"whitted", Method::whitted, Strategy::multiple_importance},
                        {"both", Method::path, Strategy::multiple_importance},
                        {"lamps", Method::path, Strategy::lamps},
                        {"material", Method::path, Strategy::material}};

}  // namespace

TEST_CASE("area_lamp_over_a_plane_is_what_gnomon_irradiance_says") {
    constexpr double half_side = 0.7, height = 1.5;
    constexpr float luminance_nt = 20;
    const Mesh lamp = square(half_side, {0, 0, height}, true);
    CHECK(floor_irradiance(lamp, luminance_nt, nullptr, {0, 0, 0}, 0).illuminance_lx ==
          doctest::Approx(luminance_nt * illuminance_below_square(half_side, height)).epsilon(1e-6));

    for (const bool has_blocker : {false, true}) {
        RenderScene scene = floor_scene();
        add_surface(scene, lamp, add_material(scene, MaterialKind::diffuse, 0, luminance_nt));
        if (has_blocker) add_surface(scene, ball({0.4, 0.3, 0.9}, 0.3), add_material(scene, MaterialKind::diffuse, 0));
        const RenderOptions view{.width = 100, .height = 100, .sample_count = 1, .max_depth = 1};
        const Sight sight = sight_of(scene, camera, view);
        const render::TracedScene traced(scene, GNOMON_PRECISION_ACCURATE, 1);
        const Vec3d above_floor = {0, 0, 0x1p-30};  // so that the floor is not in its own way
        std::vector<std::size_t> floor_pixels;
        std::vector<double> expected;
        Mean all;
        double variance = 0;  // of the sum of what is expected
        for (std::size_t pixel = 0; pixel < sight.hits.size(); ++pixel) {
            if (sight.hits[pixel].geometry_id != 0) continue;
            const auto irradiance = floor_irradiance(lamp, luminance_nt, has_blocker ? traced.handle.get() : nullptr,
                                                     floor_point(view, pixel) + above_floor, pixel);
            floor_pixels.push_back(pixel);
            expected.push_back(irradiance.illuminance_lx * reflectance / std::numbers::pi);
            all.add(expected.back());
            variance += std::pow(irradiance.standard_error_lx * reflectance / std::numbers::pi, 2);
        }
        for (const Way& way : ways) {
            RenderOptions options = view;
            options.method = way.method, options.strategy = way.strategy;
            const auto pixels = picture_of(scene, camera, options).image.pixels;
            Mean difference;
            for (std::size_t i = 0; i < expected.size(); ++i) difference.add(pixels[floor_pixels[i]][0] - expected[i]);
            const double standard_error =
                std::hypot(difference.standard_error(), std::sqrt(variance) / static_cast<double>(difference.count));
            std::printf("area lamp%s, %-8s %.6f nt, off by %.6f +- %.6f\n", has_blocker ? " behind a ball" : "", way.name,
                        all.mean, difference.mean, standard_error);
            CAPTURE(way.name);
            CHECK(difference.count > 1'000);
            CHECK(std::abs(difference.mean) <= most_standard_errors * standard_error);
        }
    }
}

TEST_CASE("lamp_shines_to_its_front_alone_unless_double_sided") {
    RenderScene scene = floor_scene();
    const std::uint32_t lamp = add_material(scene, MaterialKind::diffuse, 0, 20);
    add_surface(scene, square(1, {0, 0, 1.5}, false), lamp);
    const render::Camera below = camera_at({0.01, -0.01, 1}, {0, 0, 0}, 0.1, 1);
    for (const Method method : {Method::whitted, Method::path}) {
        for (const bool is_double_sided : {false, true}) {
            scene.materials[lamp].is_double_sided = is_double_sided;
            const auto rendering = picture_of(scene, below, {.width = 32, .height = 32, .sample_count = 16, .method = method});
            const auto lit = std::ranges::count_if(rendering.image.pixels, [](const auto& pixel) { return pixel[0] > 0; });
            CHECK(lit == (is_double_sided ? 32 * 32 : 0));
        }
    }
}

TEST_CASE("all_strategies_have_the_same_mean") {
    RenderScene scene = floor_scene();
    const std::uint32_t grey_wall = add_material(scene, MaterialKind::diffuse, 0.7F);
    add_surface(scene, ball({0.3, 0.2, 0.3}, 0.3), grey_wall);
    add_surface(scene, ball({-0.8, 0, 0.4}, 0.4), add_material(scene, MaterialKind::mirror, 0.9F));
    add_surface(scene, ball({0.9, -0.6, 0.3}, 0.3), add_material(scene, MaterialKind::glass, 1));
    // A large lamp near by, where the material is the better strategy; a small and bright one; one of both sides.
    add_surface(scene, square(1, {0, 2, 0.8}, true), add_material(scene, MaterialKind::diffuse, 0.5F, 5));
    add_surface(scene, ball({-1, -1, 1.5}, 0.15, 3), add_material(scene, MaterialKind::diffuse, 0, 40));
    add_surface(scene, square(0.4, {0.8, 0.8, 0.6}, false), add_material(scene, MaterialKind::diffuse, 0.2F, 10));
    scene.materials.back().is_double_sided = true;
    scene.point_lights = {{{1, -2, 2}, grey(5), infinity}};
    scene.environment_nt = grey(0.3F);

    constexpr int side = 96, block = 32;  // so that rare finds of the small lamp are many in each
    const auto picture = [&](Strategy strategy, std::uint64_t seed) {
        return picture_of(scene, camera,
                          {.width = side, .height = side, .sample_count = 64, .max_depth = 6, .seed = seed, .strategy = strategy})
            .image.pixels;
    };
    const auto both = picture(Strategy::multiple_importance, 1);
    const std::pair<std::string, std::vector<render::Rgb>> others[] = {{"lamps", picture(Strategy::lamps, 2)},
                                                                       {"material", picture(Strategy::material, 3)}};
    for (const auto& [name, other] : others) {
        // The means of differences are 0 everywhere, so that pixels of a block are samples of the same.
        Mean all, blocks[side / block][side / block];
        for (int y = 0; y < side; ++y) {
            for (int x = 0; x < side; ++x) {
                const auto pixel = static_cast<std::size_t>(y * side + x);
                const double difference = both[pixel][0] - double{other[pixel][0]};
                all.add(difference);
                blocks[y / block][x / block].add(difference);
            }
        }
        std::printf("both strategies less %-8s %.6f +- %.6f nt\n", name.c_str(), all.mean, all.standard_error());
        CAPTURE(name);
        CHECK(std::abs(all.mean) <= most_standard_errors * all.standard_error());
        for (const auto& row : blocks) {
            for (const Mean& mean : row) {
                CAPTURE(&row - blocks);
                CAPTURE(&mean - row);
                CHECK(std::abs(mean.mean) <= most_standard_errors * mean.standard_error());
            }
        }
    }
}
