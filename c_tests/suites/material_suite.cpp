// No material returns more than it gets, and glass is as Fresnel and Snell have it.
#define DOCTEST_CONFIG_IMPLEMENT_WITH_MAIN
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>

#include "harness/mean.hpp"
#include "rays/vector.hpp"
#include "render/material.hpp"

using namespace harness;
using render::Material;
using render::MaterialKind;
using render::Rgb;

namespace {

constexpr Vec3d normal = {0, 0, 1};

/// A ray that comes from `side` at an angle to the normal.
Vec3d towards(double angle_rad, int side) { return {std::sin(angle_rad), 0, -side * std::cos(angle_rad)}; }

Material of_kind(MaterialKind kind, const Rgb& base_color) {
    Material material;
    material.kind = kind, material.base_color = base_color;
    return material;
}

/// What Fresnel's amplitudes say passes, from both polarisations (Born and Wolf, 1.5.2): not 1 minus what is reflected.
double fresnel_transmittance(double cosine, double relative_index) {
    const double far_cosine = std::sqrt(1 - (1 - cosine * cosine) / (relative_index * relative_index));
    const double across = 2 * cosine / (cosine + relative_index * far_cosine);
    const double within = 2 * cosine / (relative_index * cosine + far_cosine);
    return relative_index * far_cosine / cosine * 0.5 * (across * across + within * within);
}

}  // namespace

TEST_CASE("reflectance_of_every_material_at_every_angle_is_at_most_one") {
    constexpr int sample_count = 20'000;
    constexpr float share = 0.75F;
    Rng rng(1);
    for (const MaterialKind kind : {MaterialKind::diffuse, MaterialKind::mirror, MaterialKind::glass}) {
        for (const float base_color : {1.0F, share}) {
            for (const int side : {1, -1}) {
                for (const double degrees : {0.0, 10.0, 30.0, 41.0, 42.0, 56.0, 70.0, 85.0, 89.0, 89.999}) {
                    const Vec3d ray = towards(degrees * std::numbers::pi / 180, side);
                    const Material material = of_kind(kind, {base_color, base_color, base_color});
                    Mean weight, passed;
                    for (int i = 0; i < sample_count; ++i) {
                        const auto scatter = sample_material(material, material.base_color, ray, normal, side, rng);
                        weight.add(scatter.weight[0]);
                        passed.add(scatter.side != side ? 1 : 0);
                        REQUIRE(std::max({scatter.weight[0], scatter.weight[1], scatter.weight[2]}) <= 1);
                        REQUIRE(length(scatter.direction) == doctest::Approx(1));
                        REQUIRE(scatter.side * dot(scatter.direction, normal) > 0);
                    }
                    CAPTURE(static_cast<int>(kind));
                    CAPTURE(base_color);
                    CAPTURE(side);
                    CAPTURE(degrees);
                    const double index = side > 0 ? material.index_of_refraction : 1 / material.index_of_refraction;
                    const double reflectance = render::fresnel_reflectance(std::abs(ray[2]), index);
                    const double expected_passed = kind == MaterialKind::glass ? 1 - reflectance : 0;
                    const double expected = kind == MaterialKind::glass ? reflectance + base_color * expected_passed : base_color;
                    CHECK(weight.mean <= 1);
                    const double sure =
                        std::numeric_limits<double>::epsilon() * sample_count;  // of the sum, where nothing is random
                    CHECK(std::abs(weight.mean - expected) <= most_standard_errors * weight.standard_error() + sure);
                    CHECK(std::abs(passed.mean - expected_passed) <= most_standard_errors * passed.standard_error() + sure);
                }
            }
        }
    }
}

TEST_CASE("diffuse_directions_are_distributed_as_their_density_says") {
    Rng rng(2);
    const Material material = of_kind(MaterialKind::diffuse, {1, 1, 1});
    Mean cosine, solid_angle;
    for (int i = 0; i < 200'000; ++i) {
        const auto scatter = sample_material(material, material.base_color, towards(1, -1), normal, -1, rng);
        REQUIRE(scatter.density_per_sr == doctest::Approx(-scatter.direction[2] / std::numbers::pi).epsilon(1e-6));
        cosine.add(-scatter.direction[2]);
        // Where the density is low its inverse has no variance; the cap above is 2 pi (1 - 0.1) sr.
        solid_angle.add(-scatter.direction[2] > 0.1 ? 1 / scatter.density_per_sr : 0);
    }
    CHECK(std::abs(cosine.mean - 2.0 / 3) <= most_standard_errors * cosine.standard_error());
    CHECK(std::abs(solid_angle.mean - 1.8 * std::numbers::pi) <= most_standard_errors * solid_angle.standard_error());
}

TEST_CASE("fresnel_reflected_and_passed_light_are_all_there_is") {
    for (const double index : {1.0, 1.0001, 1.33, 1.5, 2.4, 1 / 1.5, 1 / 2.4}) {
        for (int step = 0; step < 1000; ++step) {
            const double cosine = (step + 1) / 1000.0, far_sine = std::sqrt(1 - cosine * cosine) / index;
            const double reflectance = render::fresnel_reflectance(cosine, index);
            CAPTURE(index);
            CAPTURE(cosine);
            if (far_sine >= 1) {
                CHECK(reflectance == 1);
                continue;
            }
            CHECK(reflectance + fresnel_transmittance(cosine, index) == doctest::Approx(1).epsilon(1e-12));
            // Both ways through the boundary alike.
            const double far_cosine = std::sqrt(1 - far_sine * far_sine);
            CHECK(render::fresnel_reflectance(far_cosine, 1 / index) == doctest::Approx(reflectance).epsilon(1e-9));
        }
        const double straight = (index - 1) / (index + 1);
        CHECK(render::fresnel_reflectance(1, index) == doctest::Approx(straight * straight).epsilon(1e-12));
        CHECK(render::fresnel_reflectance(0, index) == doctest::Approx(1));
    }
}

TEST_CASE("refracted_directions_obey_snell") {
    Rng rng(3);
    for (int i = 0; i < 10'000; ++i) {
        const int side = i % 2 == 0 ? 1 : -1;
        const double index = rng.uniform(1, 3), relative_index = side > 0 ? index : 1 / index;
        const double z = rng.uniform(-1, 1), angle = rng.uniform(0, 2 * std::numbers::pi), radius = std::sqrt(1 - z * z);
        const Vec3d facing = {radius * std::cos(angle), radius * std::sin(angle), z};  // any way at all
        const Vec3d aside = normalized(cross(facing, {0.6, 0, 0.8}));
        const double sine = rng.uniform(0, std::min(1.0, relative_index));
        const Vec3d ray = sine * aside - std::sqrt(1 - sine * sine) * facing;
        const auto ways = render::glass_ways(index, ray, side * facing, side);
        CAPTURE(index);
        CAPTURE(side);
        CAPTURE(sine);
        CHECK(length(ways.refracted) == doctest::Approx(1));
        CHECK(dot(ways.refracted, facing) <= 0);
        CHECK(dot(ways.refracted, aside) == doctest::Approx(sine / relative_index));
        CHECK(dot(ways.reflected, aside) == doctest::Approx(sine));
        CHECK(dot(ways.reflected, facing) == doctest::Approx(std::sqrt(1 - sine * sine)));
    }
}
