// What users of other libraries reported, made again: the situation, not their data.
#include <cmath>
#include <numbers>

#include "compare/describe.hpp"
#include "hard/cases.hpp"
#include "rays/aim.hpp"
#include "rays/vector.hpp"
#include "scene/load.hpp"
#include "scene/mesh_parts.hpp"

namespace harness {
namespace {

/// Embree 174: a ray that meets a surface exactly at a vertex may leave no hit. Half a sphere, seen from within.
void run_half_sphere(CaseRun& run) {
    constexpr std::uint32_t rows = 12, columns = 32;
    Mesh mesh{"half sphere", {}, {}};
    add_patch(mesh, {rows, columns, false, true, [](std::uint32_t row, std::uint32_t column) -> Vec3d {
                         const double latitude = std::numbers::pi / 2 * row / rows, radius = std::cos(latitude);
                         const double longitude = 2 * std::numbers::pi * column / columns;
                         return {radius * std::cos(longitude), radius * std::sin(longitude), std::sin(latitude)};
                     }});
    const std::uint32_t pole = add_vertex(mesh, {0, 0, 1}), last_row = (rows - 1) * columns;
    for (std::uint32_t column = 0; column < columns; ++column)
        add_triangle(mesh, last_row + column, last_row + (column + 1) % columns, pole);
    std::vector<GnomonRay> rays;
    while (rays.size() < run.ray_count()) {
        // A vertex with triangles all around it: not of the border, which is the first row.
        const std::size_t vertex = columns + run.rng.below(mesh.vertex_count() - columns);
        const Vec3f target{mesh.positions[3 * vertex], mesh.positions[3 * vertex + 1], mesh.positions[3 * vertex + 2]};
        Vec3f origin = to_float(run.rng.uniform(0, 0.4) * unit_direction(run.rng));
        origin[2] = std::abs(origin[2]);
        rays.push_back(ray_towards(origin, target));
    }
    run.expect_hits({"half sphere", {std::move(mesh)}}, rays);
}

/// Embree 181: ten cylinders in each other; a ray from the fifth to a vertex of the sixth stopped hitting it once an eleventh was
/// built around them.
void run_nested_cylinders(CaseRun& run) {
    constexpr std::uint32_t sides = 24, target_mesh = 5;
    Scene scene{"ten cylinders", {}};
    const auto add_cylinder = [&](std::uint32_t i) {
        Mesh& mesh = scene.meshes.emplace_back();
        add_column(mesh, sides, {0, 0, -1.0 - 0.1 * i}, 1 + 0.1 * i, 2 + 0.2 * i);
    };
    for (std::uint32_t i = 0; i < 10; ++i) add_cylinder(i);
    std::vector<GnomonRay> rays;
    const Mesh& target = scene.meshes[target_mesh];
    while (rays.size() < run.ray_count()) {
        const std::size_t vertex = run.rng.below(target.vertex_count());
        const Vec3f to{target.positions[3 * vertex], target.positions[3 * vertex + 1], target.positions[3 * vertex + 2]};
        // From just within it, outside of the fifth.
        const Vec3d from = 0.98 * to_double(to) + 0.005 * unit_direction(run.rng);
        rays.push_back(ray_towards(to_float(from), to));
    }
    std::map<std::string, std::vector<GnomonHit>> before;
    run.each_engine(scene, [&](const HardEngine& engine, Backend& backend, CaseRow&) {
        before[engine.label()] = answers_of(backend, rays).hits;
    });
    add_cylinder(10);
    scene.name = "eleven cylinders";
    run.each_engine(scene, [&](const HardEngine& engine, Backend& backend, CaseRow& row) {
        const std::vector<GnomonHit> hits = answers_of(backend, rays).hits;
        for (std::size_t i = 0; i < rays.size(); ++i) {
            ++row.checked;
            const GnomonHit& first = before.at(engine.label())[i];
            if (!is_same_hit(hits[i], first) || hits[i].geometry_id != target_mesh)
                run.fail(row, scene, rays[i], hit_text(hits[i]) + ", among ten " + hit_text(first));
        }
    });
}

/// Embree 387: a skinny triangle (edges of 11.2, 9.7 and 1.4) at up to 600, a ray half a degree from its plane that passes it by,
/// and a hit far beyond it.
void run_skinny_triangles(CaseRun& run) {
    constexpr double angle = 0.52 * std::numbers::pi / 180;
    Mesh mesh{"skinny", {}, {}};
    std::vector<GnomonRay> rays;
    const std::size_t triangle_count = 300;
    for (std::size_t i = 0; i < triangle_count; ++i) {
        const Vec3d centre = 300.0 * unit_direction(run.rng), along = unit_direction(run.rng);
        const Vec3d across = normalized(cross(along, unit_direction(run.rng))), normal = cross(along, across);
        const std::uint32_t first = add_vertex(mesh, centre);
        // The third corner by the law of cosines: 11.2 and 1.4 from the ends of the side of 9.7 - nearly flat.
        add_triangle(mesh, first, add_vertex(mesh, centre + 11.2 * along), add_vertex(mesh, centre + 9.8 * along + 0.1 * across));
        for (std::size_t j = 0; j <= run.ray_count() / triangle_count; ++j) {
            const Vec3d target = centre + run.rng.uniform(-1, 12) * along + run.rng.uniform(-2, 2) * across;
            const double turn = run.rng.uniform(0, 2 * std::numbers::pi);
            const Vec3d away = std::cos(angle) * (std::cos(turn) * along + std::sin(turn) * across) + std::sin(angle) * normal;
            rays.push_back(ray_of(to_float(target + run.rng.uniform(10, 600) * away), to_float(-away)));
        }
    }
    run.judge({"skinny", {std::move(mesh)}}, rays);
}

/// Embree 416: a box 10^12 wide and 120,000 high, seen from above, again from each hit on.
void run_wide_box(CaseRun& run) {
    constexpr double height = 120'000;
    const auto half_widths = {5.89075e8, 5.89075e9, 5.89075e10, 5.89075e11};
    for (const double half_width : half_widths) {
        Scene scene{"box " + std::to_string(half_width), {Mesh{}}};
        add_box(scene.meshes[0], {-half_width, -half_width, 0}, {half_width, half_width, height});
        std::vector<GnomonRay> rays;
        while (rays.size() < run.ray_count(half_widths.size())) {
            const double reach = run.rng.below(2) == 0 ? 0 : half_width;
            const auto x = static_cast<float>(run.rng.uniform(-reach, reach));
            const auto y = static_cast<float>(run.rng.uniform(-reach, reach));
            for (const float z : {120'500.0f, 120'000.0f, 119'000.0f, 0.0078125f, 0.0f})
                rays.push_back(ray_of({x, y, z}, {0, 0, -1}));
        }
        run.judge(scene, rays);
    }
}

/// Embree 423: collisions, found by asking the edges of one mesh of the other; a false one with a mesh that is far away.
void run_collisions(CaseRun& run) {
    const Scene sphere = generate_scene("icosphere", 320);
    const auto gaps = {-0.01, 0.001, 0.5};
    for (const double gap : gaps) {
        Scene other = generate_scene("torus", 600);
        other.name += " at " + std::to_string(gap);
        const double offset = 1 + 1.4 + gap;  // the radius of the sphere, and the torus's
        for (std::size_t i = 0; i < other.meshes[0].positions.size(); i += 3)
            other.meshes[0].positions[i] = static_cast<float>(other.meshes[0].positions[i] + offset);
        std::vector<GnomonRay> rays;
        while (rays.size() < run.ray_count(gaps.size())) {
            const auto triangle = sphere.triangle(0, static_cast<std::uint32_t>(run.rng.below(sphere.triangle_count())));
            const std::size_t first = run.rng.below(3);
            rays.push_back(ray_towards(triangle[first], triangle[(first + 1) % 3]));
            rays.back().t_max = 1;
        }
        run.judge(other, rays);
    }
}

/// tinybvh 168: a mesh of whole coordinates, looked at along an axis from its box on, on the same whole coordinates: holes.
void run_whole_mesh(CaseRun& run) {
    const auto names = {"torus", "icosphere"};
    for (const char* name : names) {
        Scene scene = generate_scene(name, 2'000);
        for (float& x : scene.meshes[0].positions) x = std::round(50 * x);
        const Bounds box = scene.bounds();
        std::vector<GnomonRay> rays;
        while (rays.size() < run.ray_count(names.size())) {
            const auto whole = [&](int axis) {
                return static_cast<float>(std::round(run.rng.uniform(box.lower[axis], box.upper[axis])));
            };
            const float x = whole(0), z = whole(2);
            rays.push_back(ray_of({x, static_cast<float>(box.upper[1]), z}, {0, -1, 0}));
        }
        run.judge(scene, rays);
    }
}

}  // namespace

std::vector<HardCase> report_cases() {
    const std::string bar = "EXACT 0 wrong; 0 outside the contract";
    return {
        {42, "Embree 174: a vertex of half a sphere", "0 missed", run_half_sphere},
        {42, "Embree 181: nested cylinders, and one more", "the same hit", run_nested_cylinders},
        {42, "Embree 387: half a degree from a skinny triangle's plane", bar, run_skinny_triangles},
        {42, "Embree 416: a box as wide as 10^12", bar, run_wide_box},
        {42, "Embree 423: edges as segments against a mesh far away", bar, run_collisions},
        {42, "tinybvh 168: whole coordinates along an axis", bar, run_whole_mesh},
    };
}

}  // namespace harness
