// Coordinates that meet exactly: axis rays, borders, planes and signs of zero.
#include <cmath>

#include "compare/describe.hpp"
#include "hard/cases.hpp"
#include "rays/aim.hpp"
#include "rays/vector.hpp"
#include "scene/load.hpp"
#include "scene/mesh_parts.hpp"

namespace harness {
namespace {

constexpr float infinity = std::numeric_limits<float>::infinity();

float signed_zero(Rng& rng) { return rng.below(2) == 0 ? 0.0f : -0.0f; }

/// Along an axis, forwards or backwards; the other components zeros of either sign.
Vec3f axis_direction(std::size_t axis, bool forwards, Rng& rng) {
    Vec3f direction;
    for (float& x : direction) x = signed_zero(rng);
    direction[axis] = forwards ? 1.0f : -1.0f;
    return direction;
}

/// A height field of whole numbers below 8, over [0, side]^2.
struct Field {
    Scene scene = generate_scene("height_field", 800);
    int side = static_cast<int>(scene.bounds().upper[0]);
};

/// A multiple of a quarter in [0, most], half of the time a whole number.
float quarter_step(int most, Rng& rng) {
    if (rng.below(2) == 0) return static_cast<float>(rng.below(most + 1));
    return 0.25f * static_cast<float>(rng.below(4 * most + 1));
}

void run_height_field(CaseRun& run) {
    const Field field;
    constexpr int most_height = 7;
    std::vector<GnomonRay> rays;
    while (rays.size() < run.ray_count()) {
        const std::size_t axis = run.rng.below(3);
        const bool forwards = run.rng.below(2) == 0;
        Vec3f origin{quarter_step(field.side, run.rng), quarter_step(field.side, run.rng), quarter_step(most_height, run.rng)};
        origin[axis] = static_cast<float>(forwards ? -5 : field.side + 12);
        rays.push_back(ray_of(origin, axis_direction(axis, forwards, run.rng)));
    }
    run.judge(field.scene, rays);
}

/// Vertical rays exactly on the field's border: each hits.
void run_border(CaseRun& run) {
    const Field field;
    std::vector<GnomonRay> rays;
    while (rays.size() < run.ray_count()) {
        const std::size_t across = run.rng.below(2);
        Vec3f origin;
        origin[across] = run.rng.below(2) == 0 ? 0.0f : static_cast<float>(field.side);
        origin[1 - across] = quarter_step(field.side, run.rng);
        const bool up = run.rng.below(2) == 0;
        origin[2] = up ? -3.0f : 20.0f;
        rays.push_back(ray_of(origin, axis_direction(2, up, run.rng)));
    }
    run.expect_hits(field.scene, rays);
    run.judge(field.scene, rays);
}

/// One box of twelve triangles, and one whose faces are grids; both from -1 to 1.
std::vector<Scene> boxes() {
    Scene plain{"box", {Mesh{"box", {}, {}}}};
    add_box(plain.meshes[0], {-1, -1, -1}, {1, 1, 1});
    return {plain, generate_scene("cube_grid", 768)};  // 8 cells a side: dyadic
}

/// Along an axis in the plane of a face, which is never hit itself; the faces across end in it, and are.
void run_face_plane(CaseRun& run) {
    for (const Scene& box : boxes()) {
        std::vector<GnomonRay> rays;
        while (rays.size() < run.ray_count(2)) {
            const std::size_t axis = run.rng.below(3), in_face = (axis + 1 + run.rng.below(2)) % 3;
            const bool forwards = run.rng.below(2) == 0;
            Vec3f origin;
            for (float& x : origin) x = 0.125f * static_cast<float>(run.rng.below(17)) - 1;
            origin[in_face] = run.rng.below(2) == 0 ? -1.0f : 1.0f;
            origin[axis] = forwards ? -3.0f : 3.0f;
            rays.push_back(ray_of(origin, axis_direction(axis, forwards, run.rng)));
        }
        run.expect_hits(box, rays);
        run.judge(box, rays);
    }
}

void run_one_ulp_outside(CaseRun& run) {
    for (const Scene& box : boxes()) {
        std::vector<GnomonRay> rays;
        while (rays.size() < run.ray_count(2)) {
            const std::size_t axis = run.rng.below(3);
            const bool above = run.rng.below(2) == 0;
            Vec3f origin = to_float(unit_direction(run.rng));
            origin[axis] = above ? std::nextafter(1.0f, infinity) : std::nextafter(-1.0f, -infinity);
            Vec3f direction = axis_direction(axis, !above, run.rng);
            if (run.rng.below(2) == 0) direction[(axis + 1) % 3] = static_cast<float>(run.rng.uniform(-2, 2));
            rays.push_back(ray_of(origin, direction));
        }
        run.judge(box, rays);
    }
}

/// Every sign that zeros can have gives the same hit, and three zeros none.
void run_signs_of_zero(CaseRun& run) {
    const Field field;
    std::vector<GnomonRay> rays, without_direction;
    while (rays.size() < run.ray_count()) {
        const std::size_t axis = run.rng.below(3);
        Vec3f direction{};
        direction[axis] = run.rng.below(2) == 0 ? 1.0f : -1.0f;
        if (run.rng.below(2) == 0) direction[(axis + 1) % 3] = static_cast<float>(run.rng.uniform(-1, 1));
        const Vec3f origin{quarter_step(field.side, run.rng), quarter_step(field.side, run.rng), quarter_step(8, run.rng)};
        for (unsigned pattern = 0; pattern < 8; ++pattern) {
            Vec3f signed_direction = direction, zeros;
            for (std::size_t i = 0; i < 3; ++i) {
                zeros[i] = (pattern >> i & 1) != 0 ? -0.0f : 0.0f;
                if (direction[i] == 0) signed_direction[i] = zeros[i];
            }
            rays.push_back(ray_of(origin, signed_direction));
            without_direction.push_back(ray_of(origin, zeros));
        }
    }
    run.judge(field.scene, rays);
    run.expect_misses(field.scene, without_direction);
    run.each_engine(field.scene, [&](const HardEngine&, Backend& backend, CaseRow& row) {
        const std::vector<GnomonHit> hits = answers_of(backend, rays).hits;
        for (std::size_t i = 0; i < rays.size(); ++i) {
            ++row.checked;
            const GnomonHit& first = hits[i / 8 * 8];
            if (hits[i].primitive_id != first.primitive_id || hits[i].t != first.t)
                run.fail(row, field.scene, rays[i], "not " + hit_text(first) + " as with other zeros: " + hit_text(hits[i]));
        }
    });
}

/// Coordinates of the origin are those of vertices, or divide the box evenly.
void run_origin_on_planes(CaseRun& run) {
    for (const char* name : {"cube_grid", "height_field"}) {
        const Scene scene = generate_scene(name, 768);
        const Bounds box = scene.bounds();
        std::vector<GnomonRay> rays;
        while (rays.size() < run.ray_count(2)) {
            Vec3f origin;
            for (std::size_t axis = 0; axis < 3; ++axis) {
                const auto triangle = scene.triangle(0, static_cast<std::uint32_t>(run.rng.below(scene.triangle_count())));
                const double share = static_cast<double>(run.rng.below(17)) / 16;
                origin[axis] = run.rng.below(2) == 0 ? triangle[0][axis]
                                                     : static_cast<float>(std::lerp(box.lower[axis], box.upper[axis], share));
            }
            const bool along_axis = run.rng.below(2) == 0;
            rays.push_back(ray_of(origin, along_axis ? axis_direction(run.rng.below(3), run.rng.below(2) == 0, run.rng)
                                                     : to_float(unit_direction(run.rng))));
        }
        run.judge(scene, rays);
    }
}

/// Points of whole-number triangles with weights in sixteenths are exact floats: t = 0 is a hit.
void run_origin_on_triangle(CaseRun& run) {
    const Field field;
    constexpr int sixteenths = 16;
    std::vector<GnomonRay> rays;
    while (rays.size() < run.ray_count()) {
        const auto triangle = field.scene.triangle(0, static_cast<std::uint32_t>(run.rng.below(field.scene.triangle_count())));
        const auto u = static_cast<int>(run.rng.below(sixteenths + 1));
        const auto v = static_cast<int>(run.rng.below(sixteenths + 1 - u));
        rays.push_back(
            ray_of(point_of(triangle, u / double(sixteenths), v / double(sixteenths)), to_float(unit_direction(run.rng))));
    }
    run.judge(field.scene, rays);
}

/// Triangles in the planes x + y + z = k, or z = k, with whole coordinates, and rays between whole points of them.
void run_coplanar(CaseRun& run) {
    for (const bool tilted : {false, true}) {
        constexpr int plane_count = 20, triangles_a_plane = 20, extent = 50;
        const auto whole = [&] { return static_cast<double>(run.rng.below(2 * extent + 1)) - extent; };
        const auto point_in_plane = [&](int k) -> Vec3d {
            const double x = whole(), y = whole();
            return {x, y, tilted ? k - x - y : k};
        };
        Mesh mesh{"planes", {}, {}};
        std::vector<GnomonRay> rays;
        for (int k = 0; k < plane_count; ++k) {
            for (int i = 0; i < triangles_a_plane; ++i) {
                const std::uint32_t first = add_vertex(mesh, point_in_plane(k));
                add_triangle(mesh, first, add_vertex(mesh, point_in_plane(k)), add_vertex(mesh, point_in_plane(k)));
            }
            for (std::size_t i = 0; i < run.ray_count(2 * plane_count); ++i) {
                const Vec3f from = to_float(point_in_plane(k)), to = to_float(point_in_plane(k));
                if (from != to) rays.push_back(ray_towards(from, to));
            }
        }
        run.judge({tilted ? "tilted planes" : "level planes", {std::move(mesh)}}, rays);
    }
}

}  // namespace

std::vector<HardCase> aligned_cases() {
    const std::string bar = "0 wrong";
    return {
        {11, "integer height field, axis rays with zeros of both signs", "0 missed", run_height_field},
        {12, "the field's outer border, lower and upper", "0 missed", run_border},
        {13, "rays in a face plane of a box", "0 missed", run_face_plane},
        {14, "origin one ulp outside a cube", bar, run_one_ulp_outside},
        {15, "all signs of zero", bar + "; equal hits", run_signs_of_zero},
        {16, "origin exactly on a box, split or triangle plane", bar, run_origin_on_planes},
        {17, "origin exactly on a triangle, t_min = 0", bar, run_origin_on_triangle,
         "FAST computes t in float: a hit at 0 may fall before t_min; where an edge is within rounding the neighbour may be "
         "taken",
         "rays", false},
        {22, "exactly coplanar rays", "0 hits in EXACT; 0 outside the contract", run_coplanar,
         "FAST and ACCURATE shear in float: a tilted triangle that the ray runs along may be hit"},
    };
}

}  // namespace harness
