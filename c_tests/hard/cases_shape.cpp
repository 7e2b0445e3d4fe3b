// Shapes and places that rounding is worst at: needles, grazing rays, far origins, near hits, no area, crossings.
#include <cmath>
#include <numbers>

#include "hard/cases.hpp"
#include "rays/aim.hpp"
#include "rays/vector.hpp"
#include "scene/mesh_parts.hpp"

namespace harness {
namespace {

using MakeTrial = Trial (*)(double, std::size_t, Rng&);

/// One population after the other, by powers of ten.
std::function<void(CaseRun&)> sweep(MakeTrial make, std::vector<double> parameters) {
    return [=](CaseRun& run) {
        for (const double parameter : parameters) {
            Trial trial = make(parameter, run.ray_count(parameters.size()), run.rng);
            char suffix[32];
            std::snprintf(suffix, sizeof suffix, " %g", parameter);
            trial.scene.name += suffix;
            run.judge(trial);
        }
    };
}

/// Points, segments and doubled corners with whole coordinates, so that their area is 0 exactly.
Scene flat_triangles(Rng& rng) {
    constexpr int extent = 16;
    const auto whole_point = [&] {
        Vec3d point;
        for (double& x : point) x = static_cast<double>(rng.below(2 * extent + 1)) - extent;
        return point;
    };
    Mesh mesh{"no area", {}, {}};
    for (int i = 0; i < 300; ++i) {
        const Vec3d a = whole_point(), b = whole_point();
        const std::uint32_t first = add_vertex(mesh, a), second = add_vertex(mesh, b);
        add_triangle(mesh, first, first, first);
        add_triangle(mesh, first, second, first);
        add_triangle(mesh, first, second, add_vertex(mesh, 0.5 * (a + b)));
        add_triangle(mesh, first, second, add_vertex(mesh, b + (b - a)));
    }
    return {"no area", {std::move(mesh)}};
}

void run_zero_area(CaseRun& run) {
    const Scene scene = flat_triangles(run.rng);
    std::vector<GnomonRay> rays;
    while (rays.size() < run.ray_count()) {
        const auto triangle = scene.triangle(0, static_cast<std::uint32_t>(run.rng.below(scene.triangle_count())));
        const Vec3f target = between({triangle[0], triangle[1]}, static_cast<double>(run.rng.below(9)) / 8);
        const Vec3f origin = to_float(to_double(target) + 20.0 * unit_direction(run.rng));
        rays.push_back(ray_towards(origin, target));
    }
    run.expect_misses(scene, rays);
}

/// Two triangles through one point, which the ray is aimed at; the two meet it within rounding of each other.
void run_crossing(CaseRun& run) {
    Mesh mesh{"crossing", {}, {}};
    std::vector<Vec3d> points;
    for (int pair = 0; pair < 400; ++pair) {
        const Vec3d point{run.rng.uniform(-1, 1), run.rng.uniform(-1, 1), run.rng.uniform(-1, 1)};
        points.push_back(point);
        for (int side = 0; side < 2; ++side) {
            const Vec3d x = unit_direction(run.rng), y = normalized(cross(x, unit_direction(run.rng)));
            const auto corner = [&](int third) {
                const double angle = 2 * std::numbers::pi * third / 3, radius = run.rng.uniform(0.05, 0.2);
                return add_vertex(mesh, point + radius * std::cos(angle) * x + radius * std::sin(angle) * y);
            };
            const std::uint32_t first = corner(0), second = corner(1);
            add_triangle(mesh, first, second, corner(2));
        }
    }
    const Scene scene{"crossing", {std::move(mesh)}};
    std::vector<GnomonRay> rays;
    while (rays.size() < run.ray_count()) {
        const Vec3d& target = points[run.rng.below(points.size())];
        rays.push_back(ray_towards(to_float(target + 2.0 * unit_direction(run.rng)), to_float(target)));
    }
    run.judge(scene, rays);
}

/// Whole-number triangles that lie on each other in a plane: their hits have the same t, and the lowest id wins.
void run_overlap(CaseRun& run) {
    constexpr int extent = 8;
    Mesh mesh{"overlap", {}, {}};
    for (int i = 0; i < 100; ++i) {
        const auto corner = [&] {
            const double x = static_cast<double>(run.rng.below(extent + 1)), y = static_cast<double>(run.rng.below(extent + 1));
            return add_vertex(mesh, {x, y, 0});
        };
        const std::uint32_t first = corner(), second = corner();
        add_triangle(mesh, first, second, corner());
    }
    const Scene scene{"overlap", {std::move(mesh)}};
    std::vector<GnomonRay> rays;
    while (rays.size() < run.ray_count()) {
        const Vec3f target{static_cast<float>(run.rng.uniform(0, extent)), static_cast<float>(run.rng.uniform(0, extent)), 0};
        const Vec3f origin{target[0], target[1], 2};
        Vec3f direction{0, 0, -1};
        if (run.rng.below(2) == 0) direction = to_float(unit_direction(run.rng));
        rays.push_back(ray_of(origin, direction));
    }
    run.judge(scene, rays);
}

}  // namespace

std::vector<HardCase> shape_cases() {
    const std::string bar = "EXACT 0 wrong; 0 outside the contract";
    return {
        {20, "needles 1e-3 to 1e-7", bar, sweep(needle_trial, {1e-3, 1e-4, 1e-5, 1e-6, 1e-7})},
        {21, "grazing rays 1e-2 to 1e-7 rad", bar, sweep(grazing_trial, {1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7})},
        {23, "far origins 1e3 to 1e7", bar, sweep(far_origin_trial, {1e3, 1e4, 1e5, 1e6, 1e7})},
        {24, "near hits 1e-4 to 1e-7", bar, sweep(near_hit_trial, {1e-4, 1e-5, 1e-6, 1e-7})},
        {25, "zero area: points, segments, doubled corners", "0 hits", run_zero_area},
        {35, "triangles crossing at the hit", bar, run_crossing},
        {35, "coplanar overlap", bar, run_overlap},
    };
}

}  // namespace harness
