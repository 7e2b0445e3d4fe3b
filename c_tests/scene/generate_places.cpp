// Ground and bowls, and what stands on them. z points up.
#include <cmath>
#include <numbers>

#include "harness/rng.hpp"
#include "scene/generators.hpp"
#include "scene/mesh_parts.hpp"

namespace harness {

namespace {

/// Vertices along a side of a square grid of about `triangle_count` triangles.
std::uint32_t grid_side(std::size_t triangle_count) { return at_least(1, std::sqrt(double(triangle_count) / 2)) + 1; }

/// Uniform in [-1, 1), a function of the lattice point alone.
double lattice_noise(std::uint32_t x, std::uint32_t y, std::uint32_t octave) {
    return Rng((std::uint64_t(octave) << 60) ^ (std::uint64_t(x) << 30) ^ y).uniform(-1, 1);
}

/// Value noise: lattice values, smoothly interpolated.
double value_noise(double x, double y, std::uint32_t octave) {
    const double x0 = std::floor(x), y0 = std::floor(y);
    const auto smooth = [](double s) { return s * s * (3 - 2 * s); };
    const double u = smooth(x - x0), v = smooth(y - y0);
    const auto value = [&](std::uint32_t dx, std::uint32_t dy) {
        return lattice_noise(std::uint32_t(x0) + dx, std::uint32_t(y0) + dy, octave);
    };
    return std::lerp(std::lerp(value(0, 0), value(1, 0), u), std::lerp(value(0, 1), value(1, 1), u), v);
}

/// Octaves of noise, each half as high and twice as fine; x and y in [0, 1].
double hills(double x, double y) {
    constexpr std::uint32_t octave_count = 8;
    double height = 0;
    for (std::uint32_t octave = 0; octave < octave_count; ++octave) {
        const double frequency = 4 << octave;
        height += value_noise(frequency * x, frequency * y, octave) / frequency;
    }
    return height;
}

/// A table: a top on four legs, 60 triangles.
void add_table(Mesh& mesh, double x, double y) {
    add_box(mesh, {x, y, 0.7}, {x + 1.6, y + 0.8, 0.75});
    for (double dx : {0.05, 1.5})
        for (double dy : {0.05, 0.7}) add_box(mesh, {x + dx, y + dy, 0.01}, {x + dx + 0.05, y + dy + 0.05, 0.69});
}

/// A stack of shelves: a back and six boards, 84 triangles.
void add_shelves(Mesh& mesh, double x, double y) {
    add_box(mesh, {x, y, 0.01}, {x + 1.2, y + 0.02, 2.2});
    for (int board = 0; board < 6; ++board)
        add_box(mesh, {x, y + 0.03, 0.1 + 0.4 * board}, {x + 1.2, y + 0.35, 0.13 + 0.4 * board});
}

constexpr double room_side = 6, room_height = 3, wall = 0.1;

/// Two walls towards the next rooms, each with a door-wide gap; pillars of `sides` sides; a table and shelves where the dice put
/// them.
void add_room(Mesh& walls, Mesh& furniture, Rng& rng, double x, double y, std::uint32_t sides) {
    constexpr double gap_low = 2.5, gap_high = 3.5, top = room_height - 0.01;
    for (const auto& [low, high] : {std::pair{0.05, gap_low}, std::pair{gap_high, room_side - 0.05}}) {
        add_box(walls, {x + room_side - wall, y + low, 0.01}, {x + room_side - 0.01, y + high, top});
        add_box(walls, {x + low, y + room_side - wall, 0.01}, {x + high, y + room_side - 0.01, top});
    }
    for (double dx : {1.2, 4.8})
        for (double dy : {1.2, 4.8}) add_column(walls, sides, {x + dx, y + dy, 0.01}, 0.15, top - 0.01);
    const double table_x = x + rng.uniform(1.5, 2.8), table_y = y + rng.uniform(2, 3.5);
    add_table(furniture, table_x, table_y);
    const double shelves_x = x + rng.uniform(0.5, 4);
    add_shelves(furniture, shelves_x, y + 0.2);
}

}  // namespace

Scene make_height_field(std::size_t triangle_count) {
    const std::uint32_t side = grid_side(triangle_count);
    Rng rng(4);
    Mesh mesh{"height field", {}, {}};
    add_patch(mesh, {side, side, false, false, [&](std::uint32_t row, std::uint32_t column) -> Vec3d {
                         return {double(column), double(row), double(rng.below(8))};
                     }});
    return {"height_field", {mesh}};
}

Scene make_terrain(std::size_t triangle_count) {
    const std::uint32_t side = grid_side(triangle_count);
    Mesh mesh{"terrain", {}, {}};
    add_patch(mesh, {side, side, false, false, [=](std::uint32_t row, std::uint32_t column) -> Vec3d {
                         const double x = double(column) / (side - 1), y = double(row) / (side - 1);
                         return {100 * x, 100 * y, 100 * hills(x, y)};
                     }});
    return {"terrain", {mesh}};
}

Scene make_teapot_in_stadium(std::size_t triangle_count) {
    constexpr std::uint32_t rings = 8, seats = 64;
    Mesh stadium{"stadium", {}, {}};
    add_patch(stadium, {rings, seats, false, true, [](std::uint32_t row, std::uint32_t column) -> Vec3d {
                            const double angle = 2 * std::numbers::pi * column / seats, radius = 200 + 100.0 * row;
                            return {radius * std::cos(angle), radius * std::sin(angle), 0.5 * 100 * row};
                        }});
    const auto ground_center = add_vertex(stadium, {0, 0, 0});
    for (std::uint32_t i = 0; i < seats; ++i) add_triangle(stadium, ground_center, i, (i + 1) % seats);

    const double left = std::max(0.0, double(triangle_count) - double(stadium.triangle_count()));
    const std::uint32_t across = at_least(3, std::sqrt(left / 4));
    Mesh teapot{"teapot", {}, {}};
    add_torus(teapot, 2 * across, across, {17, 5, 0.5}, 1, 0.4);
    return {"teapot_in_stadium", {stadium, teapot}};
}

Scene make_interior(std::size_t triangle_count) {
    constexpr std::uint32_t pillar_sides = 24;
    // Four walls, four pillars, a table and shelves.
    constexpr double room_triangles = 4 * 12 + 4 * 4 * pillar_sides + 60 + 84;
    const std::uint32_t side = at_least(1, std::sqrt(double(triangle_count) / room_triangles));
    Rng rng(5);
    Mesh hall{"hall", {}, {}}, walls{"walls and pillars", {}, {}}, furniture{"furniture", {}, {}};
    add_box(hall, {0, 0, 0}, {side * room_side, side * room_side, room_height}, true);
    for (std::uint32_t i = 0; i < side; ++i)
        for (std::uint32_t j = 0; j < side; ++j) add_room(walls, furniture, rng, i * room_side, j * room_side, pillar_sides);
    return {"interior", {hall, walls, furniture}};
}

}  // namespace harness
