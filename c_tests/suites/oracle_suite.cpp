// The exact referee against answers known beforehand, against itself without culling, and against answers made wrong on purpose.
#define DOCTEST_CONFIG_IMPLEMENT_WITH_MAIN
#include <doctest/doctest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "harness/rng.hpp"
#include "oracle/exact.hpp"
#include "oracle/oracle.hpp"
#include "oracle/rounding.hpp"
#include "scene/load.hpp"

using namespace harness;

namespace {

constexpr float infinity = std::numeric_limits<float>::infinity();
constexpr float nan_value = std::numeric_limits<float>::quiet_NaN();

Scene scene_of(const std::vector<Triangle>& triangles) {
    Scene scene;
    scene.name = "by hand";
    Mesh& mesh = scene.meshes.emplace_back();
    for (const Triangle& triangle : triangles) {
        for (const Vec3f& vertex : triangle) {
            mesh.indices.push_back(static_cast<std::uint32_t>(mesh.vertex_count()));
            mesh.positions.insert(mesh.positions.end(), vertex.begin(), vertex.end());
        }
    }
    return scene;
}

GnomonRay ray_of(const Vec3f& origin, const Vec3f& direction, float t_min = 0, float t_max = infinity) {
    return {{origin[0], origin[1], origin[2]}, t_min, {direction[0], direction[1], direction[2]}, t_max};
}

GnomonHit miss() { return {infinity, 0, 0, {0, 0, 0}, GNOMON_INVALID_ID, GNOMON_INVALID_ID, GNOMON_INVALID_ID}; }

GnomonHit hit(std::uint32_t primitive_id, float t, float u, float v) {
    return {t, u, v, {0, 0, 0}, primitive_id, 0, GNOMON_INVALID_ID};
}

/// In the plane z = `z`, with legs of length 4 along x and y.
Triangle right_triangle(float z) { return {Vec3f{0, 0, z}, Vec3f{4, 0, z}, Vec3f{0, 4, z}}; }

/// The t of the closest hit.
std::optional<float> closest_t(const std::vector<Triangle>& triangles, const GnomonRay& ray) {
    const Scene scene = scene_of(triangles);
    const std::vector<Candidate> hits = Oracle(scene).hits(ray);
    if (hits.empty()) return std::nullopt;
    return hits.front().t;
}

bool is_same(const Candidate& a, const Candidate& b) {
    return a.geometry_id == b.geometry_id && a.primitive_id == b.primitive_id && a.exact_hit == b.exact_hit &&
           a.in_band == b.in_band && a.t == b.t && a.t_exact == b.t_exact && a.t_least == b.t_least &&
           a.t_greatest == b.t_greatest;
}

Vec3f point_in_box(const Bounds& box, Rng& rng) {
    Vec3f point;
    for (std::size_t axis = 0; axis < 3; ++axis) point[axis] = static_cast<float>(rng.uniform(box.lower[axis], box.upper[axis]));
    return point;
}

/// A point of a random triangle: inside, on an edge, or a vertex.
Vec3f point_on_scene(const Scene& scene, Rng& rng) {
    const Triangle triangle = scene.triangle(0, static_cast<std::uint32_t>(rng.below(scene.meshes[0].triangle_count())));
    const std::uint64_t kind = rng.below(3);
    const double u = kind == 0 ? 0.0 : rng.uniform();
    const double v = kind == 2 ? (1 - u) * rng.uniform() : 0.0;
    Vec3f point;
    for (std::size_t axis = 0; axis < 3; ++axis)
        point[axis] = static_cast<float>((1 - u - v) * triangle[0][axis] + u * triangle[1][axis] + v * triangle[2][axis]);
    return point;
}

GnomonRay ray_towards(const Vec3f& origin, const Vec3f& target) {
    return ray_of(origin, {target[0] - origin[0], target[1] - origin[1], target[2] - origin[2]});
}

/// The f32 code of accuracy.md, with the exact signs of the edge functions of what it computes.
bool f32_decides_hit(const GnomonRay& ray, const Triangle& triangle_of_scene) {
    const RayFrame frame(ray);
    const Triangle triangle = frame.rename(triangle_of_scene);
    std::array<std::array<float, 3>, 2> sheared;
    for (std::size_t axis = 0; axis < 2; ++axis) {
        const float slope = frame.direction[axis] / frame.direction[2];
        for (std::size_t i = 0; i < 3; ++i) {
            const float along = slope * (triangle[i][2] - frame.origin[2]);
            sheared[axis][i] = (triangle[i][axis] - frame.origin[axis]) - along;
        }
    }
    const auto sign = [&](std::size_t p, std::size_t q) {
        const double left = static_cast<double>(sheared[0][p]) * sheared[1][q];  // exact
        const double right = static_cast<double>(sheared[1][p]) * sheared[0][q];
        return (left > right) - (left < right);
    };
    return is_hit({sign(2, 1), sign(0, 2), sign(1, 0)});
}

/// A float with every exponent alike.
float any_float(Rng& rng) {
    for (;;) {
        const float value = std::bit_cast<float>(static_cast<std::uint32_t>(rng.next()));
        if (std::isfinite(value)) return value;
    }
}

/// Whether no float is nearer to the value than `rounded`, and an even one was taken of two that are as near.
bool is_nearest(const mpq_class& value, float rounded) {
    const mpq_class error = abs(mpq_class(rounded) - value);
    for (const float neighbour : {std::nextafter(rounded, -infinity), std::nextafter(rounded, infinity)}) {
        if (!std::isfinite(neighbour)) continue;
        const mpq_class neighbour_error = abs(mpq_class(neighbour) - value);
        if (neighbour_error < error) return false;
        if (neighbour_error == error && (std::bit_cast<std::uint32_t>(rounded) & 1) != 0) return false;
    }
    return true;
}

}  // namespace

TEST_CASE("nearest_float_of_random_rationals_has_no_nearer_neighbour") {
    for (std::uint64_t seed = 0; seed < 20'000; ++seed) {
        CAPTURE(seed);
        Rng rng(seed);
        const mpq_class denominator(any_float(rng));
        if (denominator == 0) continue;
        const mpq_class value = mpq_class(any_float(rng)) / denominator;
        const float rounded = nearest_float(value);
        if (abs(value) >= mpq_class(0x1.ffffffp127)) {
            CHECK(std::isinf(rounded));
        } else {
            CHECK(is_nearest(value, rounded));
        }
    }
}

TEST_CASE("nearest_float_of_midpoints_goes_to_even_and_just_beside_them_to_the_nearer") {
    const mpq_class tiny = mpq_class(1) / (mpz_class(1) << 300);
    for (std::uint64_t seed = 0; seed < 5'000; ++seed) {
        CAPTURE(seed);
        Rng rng(seed);
        const float below = any_float(rng);
        const float above = std::nextafter(below, infinity);
        if (!std::isfinite(above)) continue;
        const mpq_class midpoint = (mpq_class(below) + mpq_class(above)) / 2;
        const float even = (std::bit_cast<std::uint32_t>(below) & 1) == 0 ? below : above;
        CHECK(nearest_float(midpoint) == even);
        // By way of double both would round to the midpoint first.
        CHECK(nearest_float(midpoint - tiny) == below);
        CHECK(nearest_float(midpoint + tiny) == above);
    }
}

TEST_CASE("nearest_double_inverts_the_conversion_from_double") {
    for (std::uint64_t seed = 0; seed < 5'000; ++seed) {
        CAPTURE(seed);
        Rng rng(seed);
        const double value = rng.uniform(-1, 1) * std::ldexp(1.0, static_cast<int>(rng.below(600)) - 300);
        CHECK(nearest_double(mpq_class(value)) == value);
    }
    CHECK(nearest_double(mpq_class(1, 3)) == 1.0 / 3.0);
}

TEST_CASE("float_spacing_is_that_of_the_binade") {
    CHECK(float_spacing(mpq_class(1)) == 0x1p-23);
    CHECK(float_spacing(mpq_class(-3, 2)) == 0x1p-23);
    CHECK(float_spacing(mpq_class(2) - mpq_class(1, 1000)) == 0x1p-23);
    CHECK(float_spacing(mpq_class(2)) == 0x1p-22);
    CHECK(float_spacing(mpq_class(1, 3)) == 0x1p-25);
    CHECK(float_spacing(mpq_class(0)) == 0x1p-149);
    CHECK(float_spacing(mpq_class(0x1p-130)) == 0x1p-149);
}

TEST_CASE("hit_of_an_interior_point_has_the_exact_t") {
    CHECK(closest_t({right_triangle(5)}, ray_of({1, 1, 0}, {0, 0, 1})) == 5.0f);
    CHECK(closest_t({right_triangle(5)}, ray_of({1, 1, 0}, {0, 0, -1}, -infinity)) == -5.0f);
    CHECK(closest_t({right_triangle(1)}, ray_of({1, 1, 0}, {0, 0, 3})) == 1.0f / 3.0f);
    CHECK_FALSE(closest_t({right_triangle(5)}, ray_of({3, 3, 0}, {0, 0, 1})));
    CHECK_FALSE(closest_t({right_triangle(5)}, ray_of({1, 1, 0}, {0, 0, -1})));
}

TEST_CASE("vertices_edges_and_midpoints_belong_to_the_triangle_from_both_sides") {
    for (const Vec3f& target : {Vec3f{0, 0, 5}, Vec3f{4, 0, 5}, Vec3f{0, 4, 5}, Vec3f{2, 0, 5}, Vec3f{0, 2, 5}, Vec3f{2, 2, 5},
                                Vec3f{1, 3, 5}, Vec3f{0.125f, 0, 5}}) {
        CAPTURE(target[0]);
        CAPTURE(target[1]);
        CHECK(closest_t({right_triangle(5)}, ray_towards({3, -7, 1}, target)) == 1.0f);
        CHECK(closest_t({right_triangle(5)}, ray_towards({-1, 2, 9}, target)) == 1.0f);
    }
}

TEST_CASE("edge_through_the_ray_is_hit_where_double_loses_its_sign") {
    // An edge from -w to 3w, the ray from -d through 0: exactly on the edge, and w drowns in the rounding of d - w.
    for (std::uint64_t seed = 0; seed < 200; ++seed) {
        CAPTURE(seed);
        Rng rng(seed);
        const auto random_vector = [&](double size) {
            Vec3f vector;
            for (float& x : vector) x = static_cast<float>(size * rng.uniform(-1, 1));
            return vector;
        };
        const Vec3f d = random_vector(1);
        Vec3f w = random_vector(1e-16), thrice_w;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            w[axis] = std::ldexp(std::round(std::ldexp(w[axis], 72)), -72);  // 3w is then exact, too
            thrice_w[axis] = 3 * w[axis];
        }
        const Triangle triangle{random_vector(1), Vec3f{-w[0], -w[1], -w[2]}, thrice_w};
        CHECK(closest_t({triangle}, ray_of({-d[0], -d[1], -d[2]}, d)) == 1.0f);
    }
}

TEST_CASE("one_float_beside_an_edge_is_a_miss_in_the_band") {
    const Scene scene = scene_of({right_triangle(5)});
    const Oracle oracle(scene);
    const GnomonRay beside = ray_of({1, -0x1p-149f, 0}, {0, 0, 1});
    CHECK(oracle.hits(beside).empty());
    const std::vector<Candidate> candidates = oracle.candidates(beside);
    REQUIRE(candidates.size() == 1);
    CHECK_FALSE(candidates[0].exact_hit);
    CHECK(candidates[0].in_band);
    CHECK(candidates[0].t == 5.0f);
    CHECK(oracle.candidates(ray_of({1, -0.001f, 0}, {0, 0, 1})).empty());
}

TEST_CASE("needle_is_no_candidate_for_a_ray_beyond_its_tip") {
    // Both long edges pass the rays within the band, which a slanting ray makes wider than the needle is.
    const Scene scene = scene_of({{Vec3f{0, 0, 5}, Vec3f{0, 1e-9f, 5}, Vec3f{1, 0, 5}}});
    CHECK(Oracle(scene).candidates_unculled(ray_of({100, -2.5f, 0}, {0, 0.5f, 1})).empty());
    CHECK(Oracle(scene).candidates_unculled(ray_of({1, -2.5f, 0}, {0, 0.5f, 1})).size() == 1);
}

TEST_CASE("coplanar_rays_and_zero_area_triangles_never_hit") {
    CHECK_FALSE(closest_t({right_triangle(0)}, ray_of({-1, 1, 0}, {1, 0, 0})));
    CHECK_FALSE(closest_t({right_triangle(0)}, ray_of({-1, 0, 0}, {1, 0, 0})));
    const std::vector<Triangle> degenerate = {{Vec3f{1, 1, 1}, Vec3f{1, 1, 1}, Vec3f{1, 1, 1}},
                                              {Vec3f{0, 0, 1}, Vec3f{2, 2, 1}, Vec3f{1, 1, 1}},
                                              {Vec3f{0, 0, 1}, Vec3f{2, 2, 1}, Vec3f{2, 2, 1}}};
    const Scene scene = scene_of(degenerate);
    CHECK(Oracle(scene).candidates(ray_of({1, 1, 0}, {0, 0, 1})).empty());
    CHECK(Oracle(scene).candidates(ray_towards({3, -7, 0}, {1, 1, 1})).empty());
}

TEST_CASE("edge_on_triangle_is_a_candidate_in_the_band_and_no_hit") {
    const Scene scene = scene_of({right_triangle(0)});
    const std::vector<Candidate> candidates = Oracle(scene).candidates(ray_of({-1, 1, 0}, {1, 0, 0}));
    REQUIRE(candidates.size() == 1);
    CHECK_FALSE(candidates[0].exact_hit);
    CHECK(candidates[0].in_band);
    CHECK(candidates[0].t == infinity);
}

TEST_CASE("ray_from_the_plane_hits_at_zero") {
    CHECK(closest_t({right_triangle(0)}, ray_of({1, 1, 0}, {0, 0, 1})) == 0.0f);
    CHECK(closest_t({right_triangle(0)}, ray_of({0, 0, 0}, {1, 2, 3})) == 0.0f);
    CHECK_FALSE(closest_t({right_triangle(0)}, ray_of({-0.5f, 1, 0}, {0, 0, 1})));
}

TEST_CASE("interval_is_closed") {
    const float after = std::nextafter(5.0f, infinity), before = std::nextafter(5.0f, 0.0f);
    CHECK(closest_t({right_triangle(5)}, ray_of({1, 1, 0}, {0, 0, 1}, 5, 5)) == 5.0f);
    CHECK(closest_t({right_triangle(5)}, ray_of({1, 1, 0}, {0, 0, 1}, 0, 5)) == 5.0f);
    CHECK_FALSE(closest_t({right_triangle(5)}, ray_of({1, 1, 0}, {0, 0, 1}, 0, before)));
    CHECK_FALSE(closest_t({right_triangle(5)}, ray_of({1, 1, 0}, {0, 0, 1}, after, infinity)));
    CHECK_FALSE(closest_t({right_triangle(5)}, ray_of({1, 1, 0}, {0, 0, 1}, 5, 4)));
}

TEST_CASE("invalid_rays_miss") {
    const Scene scene = scene_of({right_triangle(5)});
    const Oracle oracle(scene);
    const auto has_none = [&](const GnomonRay& ray) {
        return oracle.candidates(ray).empty() && oracle.candidates_unculled(ray).empty();
    };
    for (const float bad : {nan_value, infinity, -infinity}) {
        for (std::size_t axis = 0; axis < 3; ++axis) {
            GnomonRay ray = ray_of({1, 1, 0}, {0, 0, 1});
            ray.origin[axis] = bad;
            CHECK(has_none(ray));
            ray = ray_of({1, 1, 0}, {0, 0, 1});
            ray.direction[axis] = bad;
            CHECK(has_none(ray));
        }
    }
    CHECK(has_none(ray_of({1, 1, 0}, {0, -0.0f, 0})));
    CHECK(oracle.hits(ray_of({1, 1, 0}, {0, 0, 1}, nan_value, infinity)).empty());
    CHECK(oracle.hits(ray_of({1, 1, 0}, {0, 0, 1}, 0, nan_value)).empty());
}

TEST_CASE("triangles_with_non_finite_vertices_are_left_out") {
    for (const float bad : {nan_value, infinity}) {
        Triangle broken = right_triangle(1);
        broken[1][2] = bad;
        CHECK(closest_t({broken, right_triangle(5)}, ray_of({1, 1, 0}, {0, 0, 1})) == 5.0f);
    }
}

TEST_CASE("closest_hits_come_first_and_equal_t_by_id") {
    const Scene scene = scene_of({right_triangle(7), right_triangle(5), right_triangle(5)});
    const std::vector<Candidate> hits = Oracle(scene).hits(ray_of({1, 1, 0}, {0, 0, 1}));
    REQUIRE(hits.size() == 3);
    CHECK(hits[0].primitive_id == 1);
    CHECK(hits[1].primitive_id == 2);
    CHECK(hits[2].primitive_id == 0);
}

TEST_CASE("huge_and_denormal_coordinates_keep_the_exact_signs") {
    for (const float size : {3e38f, 1e30f, 1e-30f, 1e-38f, 0x1p-140f}) {
        CAPTURE(size);
        const Triangle triangle{Vec3f{0, 0, size}, Vec3f{size, 0, size}, Vec3f{0, size, size}};
        for (const float speed : {3e38f, 1.0f, 1e-38f}) {
            CAPTURE(speed);
            const float t = nearest_float(mpq_class(size) / mpq_class(speed));
            const auto found = closest_t({triangle}, ray_of({size / 4, size / 4, 0}, {0, 0, speed}));
            CHECK(found == (std::isfinite(t) ? std::optional(t) : std::nullopt));
            CHECK_FALSE(closest_t({triangle}, ray_of({size, size, 0}, {0, 0, speed})));
            CHECK(closest_t({triangle}, ray_of({size / 2, size / 2, 0}, {0, 0, speed})).has_value() == std::isfinite(t));
        }
    }
}

TEST_CASE("origin_far_away_finds_the_vertex_it_aims_at") {
    const float far = 0x1p30f;
    CHECK(closest_t({right_triangle(0)}, ray_of({far, far, far}, {-1, -1, -1})) == far);
    // One unit in the last place of the origin beside the vertex: 128 lengths of the triangle.
    CHECK_FALSE(closest_t({right_triangle(0)}, ray_of({far, far, std::nextafter(far, 0.0f)}, {-1, -1, -1})));
}

TEST_CASE("culling_leaves_no_candidate_out") {
    for (const char* name : {"soup", "needles", "icosphere", "cube_grid", "fan_valence", "teapot_in_stadium", "identical"}) {
        CAPTURE(name);
        const Scene scene = generate_scene(name, 1'000);
        const Oracle oracle(scene);
        const Bounds box = scene.bounds();
        for (std::uint64_t seed = 0; seed < 300; ++seed) {
            CAPTURE(seed);
            Rng rng(seed);
            const Vec3f origin = point_in_box(box, rng);
            GnomonRay ray = ray_towards(origin, seed % 2 == 0 ? point_in_box(box, rng) : point_on_scene(scene, rng));
            if (seed % 5 == 0) ray.direction[seed % 3] = 0;
            const std::vector<Candidate> culled = oracle.candidates(ray);
            const std::vector<Candidate> unculled = oracle.candidates_unculled(ray);
            REQUIRE(culled.size() == unculled.size());
            for (std::size_t i = 0; i < culled.size(); ++i) CHECK(is_same(culled[i], unculled[i]));
        }
    }
}

TEST_CASE("band_holds_the_f32_decision") {
    // Far from the origin the band is wider than the triangles.
    for (const double offset : {0.0, 1e3, 1e6}) {
        CAPTURE(offset);
        Scene scene = generate_scene("icosphere", 1'000);
        for (float& coordinate : scene.meshes[0].positions) coordinate = static_cast<float>(coordinate + offset);
        const Oracle oracle(scene);
        Bounds box = scene.bounds();
        for (std::size_t axis = 0; axis < 3; ++axis) box.lower[axis] -= offset;
        std::size_t differing = 0;
        for (std::uint64_t seed = 0; seed < 300; ++seed) {
            CAPTURE(seed);
            Rng rng(seed);
            const GnomonRay ray = ray_towards(point_in_box(box, rng), point_on_scene(scene, rng));
            const std::vector<Candidate> candidates = oracle.candidates(ray);
            for (std::uint32_t primitive = 0; primitive < scene.meshes[0].triangle_count(); ++primitive) {
                const auto candidate = std::find_if(candidates.begin(), candidates.end(),
                                                    [&](const Candidate& c) { return c.primitive_id == primitive; });
                const bool exact_hit = candidate != candidates.end() && candidate->exact_hit;
                const Triangle triangle = scene.triangle(0, primitive);
                if (has_zero_area(triangle) || f32_decides_hit(ray, triangle) == exact_hit) continue;
                ++differing;
                REQUIRE(candidate != candidates.end());
                CHECK(candidate->in_band);
            }
        }
        CHECK(differing > 30);
    }
}

TEST_SUITE("judge") {
    const Scene scene = scene_of({right_triangle(7), right_triangle(5), right_triangle(5)});
    const Oracle oracle(scene);
    const GnomonRay inside = ray_of({1, 2, 0}, {0, 0, 1});
    const GnomonRay outside = ray_of({3, 3, 0}, {0, 0, 1});
    const GnomonRay beside_edge = ray_of({1, -0x1p-149f, 0}, {0, 0, 1});

    bool is_faultless(const Verdict& verdict) {
        return !verdict.missed && !verdict.false_hit && !verdict.wrong_primitive && !verdict.tie && !verdict.outside_contract;
    }

    TEST_CASE("judge_right_answers_without_fault") {
        const Verdict verdict = oracle.judge(inside, hit(1, 5, 0.25f, 0.5f), Contract::exact);
        CHECK(is_faultless(verdict));
        CHECK(verdict.t_ulps == 0);
        CHECK(verdict.uv_error == 0);
        const Verdict of_miss = oracle.judge(outside, miss(), Contract::exact);
        CHECK(is_faultless(of_miss));
        CHECK(of_miss.t_ulps == -1);
        CHECK(of_miss.uv_error == -1);
    }

    TEST_CASE("judge_miss_of_a_hit_as_missed") {
        const Verdict verdict = oracle.judge(inside, miss(), Contract::banded);
        CHECK(verdict.missed);
        CHECK(verdict.outside_contract);
        CHECK_FALSE(oracle.judge(inside, miss(), Contract::none).outside_contract);
    }

    TEST_CASE("judge_hit_of_nothing_as_false") {
        const Verdict verdict = oracle.judge(outside, hit(1, 5, 0.75f, 0.75f), Contract::banded);
        CHECK(verdict.false_hit);
        CHECK(verdict.invented);
        CHECK(verdict.outside_contract);
        CHECK_FALSE(oracle.judge(outside, hit(1, 5, 0.75f, 0.75f), Contract::none).outside_contract);
    }

    TEST_CASE("judge_ids_out_of_range_as_false") {
        GnomonHit answer = hit(3, 5, 0.25f, 0.5f);
        CHECK(oracle.judge(inside, answer, Contract::banded).false_hit);
        CHECK(oracle.judge(inside, answer, Contract::banded).outside_contract);
        answer = hit(1, 5, 0.25f, 0.5f);
        answer.geometry_id = 1;
        CHECK(oracle.judge(inside, answer, Contract::banded).false_hit);
        CHECK(oracle.judge(inside, answer, Contract::banded).outside_contract);
    }

    TEST_CASE("judge_hit_beyond_the_interval_as_false") {
        GnomonRay ray = inside;
        ray.t_max = 4;
        CHECK(oracle.judge(ray, hit(1, 5, 0.25f, 0.5f), Contract::banded).false_hit);
        CHECK(oracle.judge(ray, hit(1, 5, 0.25f, 0.5f), Contract::banded).outside_contract);
        // The triangle at 7 counts, but not at a t of 5.
        ray.t_min = 6, ray.t_max = 8;
        CHECK_FALSE(oracle.judge(ray, hit(0, 5, 0.25f, 0.5f), Contract::banded).false_hit);
        CHECK(oracle.judge(ray, hit(0, 5, 0.25f, 0.5f), Contract::banded).outside_contract);
    }

    TEST_CASE("judge_any_hit_of_an_invalid_ray_as_false") {
        for (const GnomonRay& ray : {ray_of({1, 2, nan_value}, {0, 0, 1}), ray_of({1, 2, 0}, {0, 0, 0}),
                                     ray_of({1, 2, 0}, {0, 0, 1}, 6, 4), ray_of({1, 2, 0}, {0, 0, 1}, nan_value)}) {
            CHECK(oracle.judge(ray, hit(1, 5, 0.25f, 0.5f), Contract::banded).false_hit);
            CHECK(oracle.judge(ray, hit(1, 5, 0.25f, 0.5f), Contract::banded).outside_contract);
            CHECK(is_faultless(oracle.judge(ray, miss(), Contract::banded)));
            CHECK(oracle.judge_occluded(ray, true, Contract::banded).outside_contract);
            CHECK(is_faultless(oracle.judge_occluded(ray, false, Contract::banded)));
        }
    }

    TEST_CASE("judge_farther_hit_as_wrong_primitive") {
        const Verdict verdict = oracle.judge(inside, hit(0, 7, 0.25f, 0.5f), Contract::banded);
        CHECK(verdict.wrong_primitive);
        CHECK_FALSE(verdict.false_hit);
        CHECK(verdict.outside_contract);
        CHECK(verdict.t_ulps == 0);
    }

    TEST_CASE("judge_higher_id_at_the_same_t_as_a_tie_outside_the_contract") {
        const Verdict verdict = oracle.judge(inside, hit(2, 5, 0.25f, 0.5f), Contract::banded);
        CHECK(verdict.tie);
        CHECK_FALSE(verdict.wrong_primitive);
        CHECK(verdict.outside_contract);
        CHECK_FALSE(oracle.judge(inside, hit(2, 5, 0.25f, 0.5f), Contract::none).outside_contract);
    }

    TEST_CASE("judge_measures_t_in_ulps") {
        const float next = std::nextafter(5.0f, infinity);
        const Verdict verdict = oracle.judge(inside, hit(1, next, 0.25f, 0.5f), Contract::banded);
        CHECK(verdict.t_ulps == 1);
        CHECK(verdict.outside_contract);
        CHECK(oracle.judge(inside, hit(1, std::nextafter(5.0f, 0.0f), 0.25f, 0.5f), Contract::banded).t_ulps == 1);
        const Verdict of_nan = oracle.judge(inside, hit(1, nan_value, 0.25f, 0.5f), Contract::banded);
        CHECK(of_nan.t_ulps == infinity);
        CHECK(of_nan.outside_contract);
    }

    TEST_CASE("judge_allows_half_an_ulp") {
        // 1/3 of the way along: the nearest float is a third of an ulp off, the other one two thirds.
        const Scene thirds = scene_of({right_triangle(1)});
        const Oracle judge(thirds);
        const GnomonRay ray = ray_of({1, 2, 0}, {0, 0, 3});
        const Verdict nearest = judge.judge(ray, hit(0, 1.0f / 3.0f, 0.25f, 0.5f), Contract::exact);
        CHECK(nearest.t_ulps == doctest::Approx(1.0 / 3.0));
        CHECK(is_faultless(nearest));
        const float other = std::nextafter(1.0f / 3.0f, 0.0f);
        const Verdict off = judge.judge(ray, hit(0, other, 0.25f, 0.5f), Contract::exact);
        CHECK(off.t_ulps == doctest::Approx(2.0 / 3.0));
        CHECK(off.outside_contract);
    }

    // At 54 + 50/101 ulps behind 1, and at 53 + 87/101: both round to 54 ulps, and the first is 51/101 from 55.
    const float far_of_two = 101 + 86 * 0x1p-17f, near_of_two = 101 + 85 * 0x1p-17f;
    const float rounded_t = 1 + 54 * 0x1p-23f;
    const Scene two = scene_of({right_triangle(far_of_two), right_triangle(near_of_two)});
    const Oracle of_two(two);
    GnomonRay towards_two(float t_min, float t_max) { return ray_of({1, 2, 0}, {0, 0, 101}, t_min, t_max); }

    TEST_CASE("judge_exact_asks_for_the_nearest_float") {
        const Scene far_alone = scene_of({right_triangle(far_of_two)});
        const Oracle judge(far_alone);
        const GnomonRay ray = towards_two(0, 2);
        for (const Contract contract : {Contract::banded, Contract::exact})
            CHECK_FALSE(judge.judge(ray, hit(0, rounded_t, 0.25f, 0.5f), contract).outside_contract);
        const GnomonHit other = hit(0, 1 + 55 * 0x1p-23f, 0.25f, 0.5f);
        CHECK(judge.judge(ray, other, Contract::exact).t_ulps == doctest::Approx(51.0 / 101));
        CHECK_FALSE(judge.judge(ray, other, Contract::banded).outside_contract);
        CHECK(judge.judge(ray, other, Contract::exact).outside_contract);
    }

    TEST_CASE("judge_exact_orders_hits_of_one_rounded_t") {
        const GnomonRay ray = towards_two(0, 2);
        const std::vector<Candidate> hits = of_two.hits(ray);
        REQUIRE(hits.size() == 2);
        CHECK(hits[0].t == hits[1].t);
        CHECK(hits[0].primitive_id == 1);
        CHECK(is_faultless(of_two.judge(ray, hit(1, rounded_t, 0.25f, 0.5f), Contract::exact)));
        const GnomonHit farther = hit(0, rounded_t, 0.25f, 0.5f);
        const Verdict verdict = of_two.judge(ray, farther, Contract::exact);
        CHECK(verdict.tie);
        CHECK_FALSE(verdict.wrong_primitive);
        CHECK(verdict.outside_contract);
        CHECK_FALSE(of_two.judge(ray, farther, Contract::banded).outside_contract);
    }

    TEST_CASE("judge_exact_takes_the_lower_id_of_equal_exact_t") {
        CHECK(is_faultless(oracle.judge(inside, hit(1, 5, 0.25f, 0.5f), Contract::exact)));
        CHECK(oracle.judge(inside, hit(2, 5, 0.25f, 0.5f), Contract::exact).outside_contract);
    }

    TEST_CASE("judge_exact_decides_the_interval_on_the_rounded_t") {
        // The exact t of the first lies behind the end, that of the second before the start.
        const Scene far_alone = scene_of({right_triangle(far_of_two)});
        const Scene near_alone = scene_of({right_triangle(near_of_two)});
        for (const Scene* scene : {&far_alone, &near_alone}) {
            const Oracle judge(*scene);
            const GnomonRay ray = towards_two(rounded_t, rounded_t);
            CHECK(is_faultless(judge.judge(ray, hit(0, rounded_t, 0.25f, 0.5f), Contract::exact)));
            CHECK(judge.judge(ray, miss(), Contract::exact).outside_contract);
            CHECK(is_faultless(judge.judge_occluded(ray, true, Contract::exact)));
            CHECK(judge.judge_occluded(ray, false, Contract::exact).outside_contract);
            const GnomonRay before = towards_two(0, std::nextafter(rounded_t, 0.0f));
            CHECK(is_faultless(judge.judge(before, miss(), Contract::exact)));
            CHECK(judge.judge(before, hit(0, rounded_t, 0.25f, 0.5f), Contract::exact).outside_contract);
            CHECK(judge.judge_occluded(before, true, Contract::exact).outside_contract);
        }
    }

    TEST_CASE("judge_exact_counts_every_raw_fault") {
        for (const auto& [ray, answer] :
             {std::pair(inside, miss()), std::pair(outside, hit(1, 5, 0.75f, 0.75f)), std::pair(inside, hit(0, 7, 0.25f, 0.5f))})
            CHECK(oracle.judge(ray, answer, Contract::exact).outside_contract);
        CHECK(oracle.judge(inside, hit(1, 5, 0.25f, 0.5f + 0x1p-24f), Contract::exact).outside_contract);
        CHECK(oracle.judge(inside, hit(1, nan_value, 0.25f, 0.5f), Contract::exact).outside_contract);
    }

    TEST_CASE("judge_measures_u_and_v") {
        const Verdict verdict = oracle.judge(inside, hit(1, 5, 0.25f, 0.5f + 0x1p-24f), Contract::banded);
        CHECK(verdict.uv_error == 1);
        CHECK(verdict.outside_contract);
        CHECK(oracle.judge(inside, hit(1, 5, 0.25f - 0x1p-25f, 0.5f), Contract::banded).uv_error == 0.5);
        CHECK_FALSE(oracle.judge(inside, hit(1, 5, 0.25f - 0x1p-25f, 0.5f), Contract::banded).outside_contract);
        CHECK(oracle.judge(inside, hit(1, 5, nan_value, 0.5f), Contract::banded).outside_contract);
        CHECK(oracle.judge(inside, hit(1, 5, 0.25f, nan_value), Contract::banded).outside_contract);
    }

    TEST_CASE("judge_leaves_the_band_to_either_decision") {
        for (const GnomonHit& answer : {miss(), hit(1, 5, 0.25f, 0.0f)}) {
            CHECK_FALSE(oracle.judge(beside_edge, answer, Contract::banded).outside_contract);
        }
        CHECK(oracle.judge(beside_edge, hit(1, 5, 0.25f, 0.0f), Contract::exact).outside_contract);
        CHECK_FALSE(oracle.judge(beside_edge, miss(), Contract::exact).outside_contract);
        const GnomonRay on_edge = ray_of({1, 0, 0}, {0, 0, 1});
        CHECK_FALSE(oracle.judge(on_edge, miss(), Contract::banded).outside_contract);
        CHECK(oracle.judge(on_edge, miss(), Contract::exact).outside_contract);
        CHECK(oracle.judge(on_edge, miss(), Contract::banded).missed);
    }

    TEST_CASE("judge_holds_a_t_in_the_band_to_the_triangle") {
        const GnomonHit answer = hit(1, 5.001f, 0.25f, 0.0f);
        CHECK(oracle.judge(beside_edge, answer, Contract::banded).outside_contract);
        GnomonRay ray = beside_edge;
        ray.t_max = 4;
        CHECK(oracle.judge_occluded(ray, true, Contract::banded).outside_contract);
    }

    TEST_CASE("judge_occluded_lets_nothing_into_an_empty_interval") {
        // Seen edge-on, from t = 1 to t = 4.
        const Scene edge_on = scene_of({right_triangle(0)});
        const Oracle judge(edge_on);
        CHECK_FALSE(judge.judge_occluded(ray_of({-1, 1, 0}, {1, 0, 0}, 2, 3), true, Contract::banded).outside_contract);
        CHECK(judge.judge_occluded(ray_of({-1, 1, 0}, {1, 0, 0}, 3, 2), true, Contract::banded).outside_contract);
    }

    TEST_CASE("judge_occluded_holds_certain_rays_to_the_truth") {
        CHECK(is_faultless(oracle.judge_occluded(inside, true, Contract::banded)));
        CHECK(oracle.judge_occluded(inside, false, Contract::banded).missed);
        CHECK(oracle.judge_occluded(inside, false, Contract::banded).outside_contract);
        CHECK(is_faultless(oracle.judge_occluded(outside, false, Contract::banded)));
        CHECK(oracle.judge_occluded(outside, true, Contract::banded).false_hit);
        CHECK(oracle.judge_occluded(outside, true, Contract::banded).outside_contract);
        CHECK(oracle.judge_occluded(beside_edge, true, Contract::banded).false_hit);
        CHECK_FALSE(oracle.judge_occluded(beside_edge, true, Contract::banded).outside_contract);
        CHECK(oracle.judge_occluded(beside_edge, true, Contract::exact).outside_contract);
    }
}
