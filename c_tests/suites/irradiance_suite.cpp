// What arrives at a point, against closed forms and plain Monte Carlo: with nothing in the way, with a screen before part of the
// lamp, with the lamp in the scene; and whether the standard error tells the truth.
#define DOCTEST_CONFIG_IMPLEMENT_WITH_MAIN
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <map>
#include <numbers>
#include <utility>

#include "backend/names.hpp"
#include "harness/ray_count.hpp"
#include "harness/triangles.hpp"
#include "light/closed_forms.hpp"
#include "light/half_hidden.hpp"
#include "light/plain.hpp"
#include "rays/vector.hpp"
#include "scene/load.hpp"

using namespace harness;

namespace {

constexpr double pi = std::numbers::pi;
// The inputs are the same floats on both sides, and both compute in double: some dozen roundings, of differences that lose few
// bits.
constexpr double few_roundings = 0x1p-42;

constexpr LampKind lamp_kinds[] = {LampKind::rectangle, LampKind::rectangle_on_horizon, LampKind::sphere};

GnomonSources no_sources() {
    GnomonSources sources{};
    sources.struct_size = sizeof sources;
    return sources;
}

double lux(const GnomonScene* scene, const GnomonSources& sources, const Vec3f& point, const Vec3f& normal) {
    GnomonIrradiance answer;
    REQUIRE_MESSAGE(gnomon_irradiance(scene, &sources, point.data(), normal.data(), nullptr, &answer) == GNOMON_OK,
                    gnomon_last_error());
    CHECK(answer.standard_error_lx == 0);
    return answer.illuminance_lx;
}

Vec3f random_point(Rng& rng, double size = 1) {
    return to_float({rng.uniform(-size, size), rng.uniform(-size, size), rng.uniform(-size, size)});
}

void copy(const Vec3f& from, float (&to)[3]) { std::copy(from.begin(), from.end(), to); }

struct Engine {
    std::uint32_t structure, precision;
    std::string name() const {
        return std::string(name_of(structure_names, structure)) + " " + name_of(precision_names, precision);
    }
};

std::vector<Engine> engines() {
    std::vector<Engine> all;
    for (const NamedValue& structure : structure_names) {
        if (structure.value == GNOMON_STRUCTURE_AUTO) continue;
        for (const NamedValue& precision : precision_names) all.push_back({structure.value, precision.value});
    }
    return all;
}

/// By how many of its standard errors an estimate is off.
double off_by(const GnomonIrradiance& answer, double truth) { return (answer.illuminance_lx - truth) / answer.standard_error_lx; }

}  // namespace

TEST_CASE("points_and_spots_follow_the_inverse_square_and_cosine_law_and_their_ranges_and_cones") {
    const SceneHandle empty = build_meshes({});
    Rng rng(1);
    for (int i = 0; i < 5'000; ++i) {
        GnomonSpotSource spot{};
        const Vec3f position = random_point(rng, 3), point = random_point(rng, 3), normal = random_point(rng);
        // Towards the point, roughly, so that many see it.
        const Vec3d to_point = to_double(point) - to_double(position);
        const Vec3f axis = to_float(to_point + 0.5 * to_double(random_point(rng)));
        copy(position, spot.position), copy(axis, spot.direction);
        spot.intensity_cd = float(rng.uniform(0, 1000));
        spot.range_m = i % 3 == 0 ? 0 : float(rng.uniform(1, 10));
        spot.inner_cone_rad = float(rng.uniform(0, 0.5)), spot.outer_cone_rad = float(rng.uniform(0.6, pi / 2));
        GnomonPointSource lamp{{}, spot.intensity_cd, spot.range_m};
        copy(position, lamp.position);

        const double distance = length(to_point),
                     cosine = std::max(0.0, -dot(to_point, normalized(to_double(normal))) / distance);
        const double range = spot.range_m > 0 ? std::max(0.0, 1 - std::pow(distance / spot.range_m, 4)) : 1;
        const double expected = spot.intensity_cd * range * cosine / (distance * distance);
        const double inner = std::cos(double(spot.inner_cone_rad)), outer = std::cos(double(spot.outer_cone_rad));
        const double along = dot(to_point, normalized(to_double(axis))) / distance;
        const double cone = std::pow(std::clamp((along - outer) / (inner - outer), 0.0, 1.0), 2);
        GnomonSources points = no_sources(), spots = no_sources();
        points.points = &lamp, points.point_count = 1;
        spots.spots = &spot, spots.spot_count = 1;
        for (const GnomonScene* scene :
             {static_cast<const GnomonScene*>(nullptr), static_cast<const GnomonScene*>(empty.get())}) {
            CAPTURE(i);
            CHECK(std::abs(lux(scene, points, point, normal) - expected) <=
                  few_roundings * spot.intensity_cd / distance / distance);
            CHECK(std::abs(lux(scene, spots, point, normal) - cone * expected) <=
                  few_roundings * spot.intensity_cd / distance / distance);
        }
    }
}

TEST_CASE("directions_follow_the_cosine_law") {
    const SceneHandle empty = build_meshes({});
    Rng rng(2);
    for (int i = 0; i < 2'000; ++i) {
        GnomonDirectionalSource sun{{}, float(rng.uniform(0, 1e5))};
        const Vec3f direction = random_point(rng), normal = random_point(rng);
        copy(direction, sun.direction);
        GnomonSources sources = no_sources();
        sources.directionals = &sun, sources.directional_count = 1;
        const double cosine = -dot(normalized(to_double(direction)), normalized(to_double(normal)));
        for (const GnomonScene* scene : {static_cast<const GnomonScene*>(nullptr), static_cast<const GnomonScene*>(empty.get())})
            CHECK(std::abs(lux(scene, sources, random_point(rng), normal) - sun.illuminance_lx * std::max(0.0, cosine)) <=
                  few_roundings * sun.illuminance_lx);
    }
}

TEST_CASE("lamps_that_nothing_hides_are_exact_and_hidden_ones_dark") {
    const Mesh aside = horizontal_rectangle({9, 9, 1}, {10, 10, 1}, false),
               below = horizontal_rectangle({-64, -64, -9}, {64, 64, -9}, true);
    const Mesh before = horizontal_rectangle({-64, -64, 1}, {64, 64, 1}, false);
    const SceneHandle open = build_meshes({aside, below}), closed = build_meshes({before});
    Rng rng(3);
    for (const LampKind kind : lamp_kinds) {
        CAPTURE(std::string(name_of(kind)));
        for (std::uint64_t seed = 0; seed < 200; ++seed) {
            const HalfHidden place = half_hidden(kind, rng);
            const GnomonIrradiance whole = irradiance_at(place, nullptr, 4096, seed);
            CHECK(std::abs(whole.illuminance_lx / place.whole_lx - 1) <= few_roundings);
            CHECK((whole.standard_error_lx == 0 && whole.ray_count == 0));
            const GnomonIrradiance lit = irradiance_at(place, open.get(), 4096, seed);
            CHECK((lit.illuminance_lx == whole.illuminance_lx && lit.standard_error_lx == 0 && lit.ray_count == 4096));
            const GnomonIrradiance dark = irradiance_at(place, closed.get(), 4096, seed);
            CHECK((dark.illuminance_lx == 0 && dark.standard_error_lx == 0));
        }
    }
}

TEST_CASE("a_sphere_that_the_floor_cuts_is_exact_above_it") {
    // What lies below the horizon is behind the floor, but sends nothing either.
    const SceneHandle floor = build_meshes({horizontal_rectangle({-64, -64, 0}, {64, 64, 0}, true)});
    Rng rng(4);
    for (int i = 0; i < 200; ++i) {
        GnomonSphereSource sphere{{2, 0, float(rng.uniform(-0.9, 0.9))}, 1, 1};
        GnomonSources sources = no_sources();
        sources.spheres = &sphere, sources.sphere_count = 1;
        const Vec3f point = to_float({rng.uniform(-3, 0.5), rng.uniform(-1, 1), 0x1p-20});
        CHECK(lux(floor.get(), sources, point, {0, 0, 1}) == lux(nullptr, sources, point, {0, 0, 1}));
    }
}

TEST_CASE("screens_leave_the_closed_form_within_an_honest_error_that_falls_with_the_root_of_the_samples") {
    const std::size_t most_samples = ray_count_or(1'000'000);
    std::printf("%-26s %9s %10s %14s %14s %8s %8s\n", "lamp", "samples", "estimates", "rms error", "rms std error", "> 2, %",
                "most");
    for (const LampKind kind : lamp_kinds) {
        CAPTURE(std::string(name_of(kind)));
        std::size_t estimates = 0, beyond_two = 0;
        std::vector<double> logs_of_count, logs_of_error;
        for (std::size_t sample_count = 1'000; sample_count <= most_samples; sample_count *= 10) {
            const std::size_t place_count = std::clamp<std::size_t>(40 * most_samples / sample_count, 40, 400);
            Rng rng(sample_count);
            double squares = 0, stated = 0, most = 0;
            std::size_t beyond = 0;
            for (std::size_t seed = 0; seed < place_count; ++seed) {
                const HalfHidden place = half_hidden(kind, rng);
                const SceneHandle scene = build_meshes({place.screen});
                const GnomonIrradiance answer = irradiance_at(place, scene.get(), sample_count, seed);
                const double off = off_by(answer, place.visible_lx);
                CAPTURE(seed);
                CHECK(std::abs(off) <= 5);  // of so many estimates one is beyond 4 every fifth time, and beyond 5 every 500th
                beyond += std::abs(off) > 2;
                most = std::max(most, std::abs(off));
                squares += std::pow((answer.illuminance_lx - place.visible_lx) / place.whole_lx, 2);
                stated += std::pow(answer.standard_error_lx / place.whole_lx, 2);
            }
            const double count = double(place_count), error = std::sqrt(squares / count);
            std::printf("%-26s %9zu %10zu %14.3e %14.3e %8.1f %8.2f\n", name_of(kind), sample_count, place_count, error,
                        std::sqrt(stated / count), 100 * double(beyond) / count, most);
            estimates += place_count, beyond_two += beyond;
            logs_of_count.push_back(std::log(double(sample_count))), logs_of_error.push_back(std::log(error));
        }
        // The share of a normal distribution beyond two, and four deviations of its estimate.
        const double expected = std::erfc(std::numbers::sqrt2), count = double(estimates);
        CHECK(std::abs(double(beyond_two) / count - expected) < 4 * std::sqrt(expected * (1 - expected) / count));

        if (logs_of_count.size() < 3) continue;
        const double n = double(logs_of_count.size());
        double x = 0, y = 0, xx = 0, xy = 0;
        for (std::size_t i = 0; i < logs_of_count.size(); ++i) {
            x += logs_of_count[i] / n, y += logs_of_error[i] / n;
            xx += logs_of_count[i] * logs_of_count[i] / n, xy += logs_of_count[i] * logs_of_error[i] / n;
        }
        const double slope = (xy - x * y) / (xx - x * x);
        std::printf("%-26s error falls as samples^%.3f\n", name_of(kind), slope);
        CHECK(std::abs(slope + 0.5) <= 0.05);
    }
}

TEST_CASE("lamps_seen_under_tiny_angles_have_an_honest_error") {
    // Whose weights vary less than their sum in closed form rounds.
    for (const double size : {1e-2, 1e-5, 1e-7, 1e-8}) {
        for (const float tilt : {0.0F, 1.0F}) {
            HalfHidden place{};
            place.rectangle = horizontal_rectangle({float(-size), float(-size), 1}, {float(size), float(size), 1}, false);
            place.screen = horizontal_rectangle({-1, -1, 0.5F}, {float(0.15 * size), 1, 0.5F}, false);
            place.normal = {tilt, 0, 1};
            const double edge = 2 * double(place.screen.positions[3]), side = place.rectangle.positions[3];
            const Vec3d normal = normalized(to_double(place.normal));
            // So small that all of it is as far away, and seen at the same angle, but for the largest.
            const double visible =
                size > 1e-3 ? 1000 * projected_polygon_sr({0, 0, 0}, normal,
                                                          {{edge, -side, 1}, {side, -side, 1}, {side, side, 1}, {edge, side, 1}})
                            : 1000 * normal[2] * (side - edge) * 2 * side;
            const SceneHandle scene = build_meshes({place.screen});
            for (std::uint64_t seed = 0; seed < 20; ++seed) {
                CAPTURE(size);
                CAPTURE(tilt);
                CHECK(std::abs(off_by(irradiance_at(place, scene.get(), 20'000, seed), visible)) <= 4);
            }
        }
    }
}

TEST_CASE("structures_agree_to_the_bit_behind_a_screen_and_precisions_within_two_samples") {
    constexpr std::uint64_t sample_count = 10'000;
    Rng rng(5);
    for (const LampKind kind : lamp_kinds) {
        for (std::uint64_t seed = 0; seed < 10; ++seed) {
            const HalfHidden place = half_hidden(kind, rng);
            std::map<std::uint32_t, GnomonIrradiance> firsts;  // of each precision
            for (const Engine& engine : engines()) {
                CAPTURE(engine.name());
                const SceneHandle scene = build_meshes({place.screen}, engine.structure, engine.precision);
                const GnomonIrradiance answer = irradiance_at(place, scene.get(), sample_count, seed);
                const GnomonIrradiance first = firsts.try_emplace(engine.precision, answer).first->second;
                CHECK(std::memcmp(&answer, &first, sizeof answer) == 0);
                // A ray that passes the screen's edge within rounding may be decided either way.
                CHECK(std::abs(answer.illuminance_lx - firsts.begin()->second.illuminance_lx) <=
                      4 * place.whole_lx / double(sample_count));
            }
        }
    }
}

TEST_CASE("places_a_million_times_as_large_or_small_look_alike_to_the_bit") {
    Rng rng(8);
    for (const LampKind kind : lamp_kinds) {
        for (std::uint64_t seed = 0; seed < 10; ++seed) {
            const HalfHidden place = half_hidden(kind, rng);
            const GnomonIrradiance expected = irradiance_at(place, build_meshes({place.screen}).get(), 10'000, seed);
            for (const float scale : {0x1p-60F, 0x1p-20F, 0x1p20F, 0x1p60F}) {
                HalfHidden scaled = place;
                const auto multiply = [&](auto& coordinates) {
                    for (float& coordinate : coordinates) coordinate *= scale;
                };
                multiply(scaled.rectangle.positions), multiply(scaled.screen.positions), multiply(scaled.point);
                multiply(scaled.sphere.centre), scaled.sphere.radius *= scale;
                const GnomonIrradiance answer = irradiance_at(scaled, build_meshes({scaled.screen}).get(), 10'000, seed);
                CAPTURE(scale);
                CHECK(std::memcmp(&answer, &expected, sizeof answer) == 0);
            }
        }
    }
}

TEST_CASE("a_lamp_that_stands_on_the_receivers_plane_is_exact") {
    const Mesh wall{"wall", {1, -1, 0, 1, 1, 0, 1, 1, 1, 1, -1, 1}, {0, 2, 1, 0, 3, 2}};
    const SceneHandle scene = build_meshes({horizontal_rectangle({-64, -64, 0}, {64, 64, 0}, true), wall});
    const GnomonAreaSource lamp{triangles_of(wall), 1, 0};
    GnomonSources sources = no_sources();
    sources.areas = &lamp, sources.area_count = 1;
    for (const float height : {0.0F, 0x1p-24F, 0x1p-10F}) {
        for (const float x : {0.0F, 0.875F, 1 - 0x1p-10F, 1 - 0x1p-23F}) {
            const Vec3f point{x, 0.125F, height}, up{0, 0, 1};
            const double expected =
                projected_polygon_sr(to_double(point), to_double(up), {{1, 1, 1}, {1, -1, 1}, {1, -1, 0}, {1, 1, 0}});
            CAPTURE(x);
            CHECK(std::abs(lux(nullptr, sources, point, up) - expected) <= few_roundings);
            CHECK(lux(scene.get(), sources, point, up) == lux(nullptr, sources, point, up));
        }
    }
}

TEST_CASE("cutting_a_lamp_into_needles_or_100_000_triangles_changes_nothing") {
    Rng rng(9);
    for (int i = 0; i < 2'000; ++i) {
        const float sliver = float(std::pow(10, rng.uniform(-7, -1)));
        const Mesh whole{"whole", {-1, -1, 1, 1, -1, 1, 0, 1, 1}, {0, 2, 1}};
        Mesh cut{"cut", whole.positions, {0, 2, 3, 2, 1, 3, 1, 0, 3}};
        cut.positions.insert(cut.positions.end(), {float(rng.uniform(-0.9, 0.9)), -1 + sliver, 1});
        const Vec3f point = to_float({rng.uniform(-2, 2), rng.uniform(-2, 2), 1 - std::pow(10, rng.uniform(-4, 1))});
        const Vec3f normal = random_point(rng);
        double found[2];
        for (const Mesh* mesh : {&std::as_const(whole), &std::as_const(cut)}) {
            const GnomonAreaSource lamp{triangles_of(*mesh), 1, 0};
            GnomonSources sources = no_sources();
            sources.areas = &lamp, sources.area_count = 1;
            found[mesh == &cut] = lux(nullptr, sources, point, normal);
        }
        CAPTURE(i);
        CHECK(std::abs(found[0] - found[1]) <= few_roundings);
    }

    constexpr std::uint32_t cells = 224;
    HalfHidden place = half_hidden(LampKind::rectangle, rng);
    const double whole = irradiance_at(place, nullptr, 2, 0).illuminance_lx;
    const auto coordinate = [](std::uint32_t i) { return float(-1 + 2.0 * i / cells); };
    place.rectangle = Mesh{"grid", {}, {}};
    for (std::uint32_t y = 0; y <= cells; ++y)
        for (std::uint32_t x = 0; x <= cells; ++x)
            place.rectangle.positions.insert(place.rectangle.positions.end(), {coordinate(x), coordinate(y), 2});
    for (std::uint32_t y = 0; y < cells; ++y) {
        for (std::uint32_t x = 0; x < cells; ++x) {
            const std::uint32_t corner = y * (cells + 1) + x, above = corner + cells + 1;
            place.rectangle.indices.insert(place.rectangle.indices.end(),
                                           {corner, above, corner + 1, above + 1, corner + 1, above});
        }
    }
    CHECK(std::abs(irradiance_at(place, nullptr, 2, 0).illuminance_lx / whole - 1) <= few_roundings);
    const SceneHandle scene = build_meshes({place.screen, place.rectangle});
    CHECK(std::abs(off_by(irradiance_at(place, scene.get(), 100'000, 0), place.visible_lx)) <= 4);
}

TEST_CASE("a_lamp_in_the_scene_is_not_in_its_own_way") {
    Rng rng(6);
    const Mesh ball = generate_scene("icosphere", 1'280).meshes[0];
    const GnomonAreaSource lamp{triangles_of(ball), 1, 0};
    GnomonSources glowing = no_sources();
    glowing.areas = &lamp, glowing.area_count = 1;
    for (const Engine& engine : engines()) {
        CAPTURE(engine.name());
        std::size_t differences = 0, ball_differences = 0;
        double most = 0;
        const SceneHandle ball_scene = build_meshes({ball}, engine.structure, engine.precision);
        for (std::uint64_t seed = 0; seed < 30; ++seed) {
            const HalfHidden place = half_hidden(seed % 2 == 0 ? LampKind::rectangle : LampKind::rectangle_on_horizon, rng);
            const SceneHandle scene = build_meshes({place.rectangle}, engine.structure, engine.precision);
            const double whole = irradiance_at(place, nullptr, 2, seed).illuminance_lx;
            const double found = irradiance_at(place, scene.get(), 4096, seed).illuminance_lx;
            differences += found != whole;
            most = std::max(most, std::abs(found / whole - 1));

            const Vec3d away = normalized(to_double(random_point(rng)));
            const Vec3f point = to_float(rng.uniform(1.01, 5) * away),
                        normal = to_float(-away + 0.7 * to_double(random_point(rng)));
            const double bright = lux(nullptr, glowing, point, normal);
            GnomonIrradiance answer;
            REQUIRE(gnomon_irradiance(ball_scene.get(), &glowing, point.data(), normal.data(), nullptr, &answer) == GNOMON_OK);
            ball_differences += answer.illuminance_lx != bright;
            most = std::max(most, std::abs(answer.illuminance_lx / bright - 1));
        }
        std::printf("%-24s lamps in the scene that differ: %zu of 30 rectangles, %zu of 30 balls, by %.2e at most\n",
                    engine.name().c_str(), differences, ball_differences, most);
        // The t of FAST may be off by more than the share of the way that does not count.
        CHECK(most <= (engine.precision == GNOMON_PRECISION_FAST ? 0.002 : 0));
    }
}

TEST_CASE("plain_monte_carlo_agrees") {
    constexpr std::uint64_t sample_count = 100'000;
    Rng rng(7);
    for (const LampKind kind : lamp_kinds) {
        for (const PlainSampling sampling : {PlainSampling::sphere, PlainSampling::cosine_hemisphere, PlainSampling::lamp}) {
            for (std::uint64_t seed = 0; seed < 5; ++seed) {
                const HalfHidden place = half_hidden(kind, rng);
                const SceneHandle scene = build_meshes({place.screen});
                const GnomonIrradiance answer = irradiance_at(place, scene.get(), sample_count, seed);
                const PlainEstimate plain =
                    plain_irradiance(place, build_lamp(place).get(), scene.get(), sampling, sample_count, seed);
                CAPTURE(std::string(name_of(kind)));
                CAPTURE(std::string(name_of(sampling)));
                CAPTURE(plain.illuminance_lx);
                CAPTURE(answer.illuminance_lx);
                CHECK(std::abs(plain.illuminance_lx - answer.illuminance_lx) <=
                      4 * std::hypot(plain.standard_error_lx, answer.standard_error_lx));
            }
        }
    }
}
