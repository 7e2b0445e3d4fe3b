// Triangles without neighbours, and hair.
#include <cmath>
#include <numbers>

#include "harness/rng.hpp"
#include "scene/generators.hpp"
#include "scene/mesh_parts.hpp"

namespace harness {

namespace {

Vec3d operator+(const Vec3d& a, const Vec3d& b) { return {a[0] + b[0], a[1] + b[1], a[2] + b[2]}; }
Vec3d operator*(double s, const Vec3d& v) { return {s * v[0], s * v[1], s * v[2]}; }
Vec3d cross(const Vec3d& a, const Vec3d& b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
Vec3d normalized(const Vec3d& v) { return 1 / std::hypot(v[0], v[1], v[2]) * v; }

Vec3d random_in_cube(Rng& rng, double half_side) {
    // One statement a coordinate: the order of calls inside a braced list is fixed, but easily lost in an edit.
    const double x = rng.uniform(-half_side, half_side);
    const double y = rng.uniform(-half_side, half_side);
    const double z = rng.uniform(-half_side, half_side);
    return {x, y, z};
}

/// Uniform on the sphere, by Archimedes' projection.
Vec3d random_direction(Rng& rng) {
    const double z = rng.uniform(-1, 1), longitude = rng.uniform(0, 2 * std::numbers::pi), radius = std::sqrt(1 - z * z);
    return {radius * std::cos(longitude), radius * std::sin(longitude), z};
}

/// Some unit vector at a right angle to the unit vector `v`.
Vec3d perpendicular(const Vec3d& v) { return normalized(cross(v, std::abs(v[0]) < 0.5 ? Vec3d{1, 0, 0} : Vec3d{0, 1, 0})); }

void add_separate_triangle(Mesh& mesh, const Vec3d& a, const Vec3d& b, const Vec3d& c) {
    const std::uint32_t first = add_vertex(mesh, a);
    add_triangle(mesh, first, add_vertex(mesh, b), add_vertex(mesh, c));
}

/// An open tube of three sides along a curve that bends away from `root`.
void add_strand(Mesh& mesh, Rng& rng, std::uint32_t segments) {
    constexpr double radius = 0.001, length = 0.6;
    const Vec3d root = random_direction(rng), bend = 0.5 * random_direction(rng);
    const Vec3d side = perpendicular(root), other = cross(root, side);
    const auto point = [=](std::uint32_t row, std::uint32_t column) -> Vec3d {
        const double s = double(row) / segments, theta = 2 * std::numbers::pi * column / 3;
        // Tapers, but not to a point.
        const double width = radius * (1 - 0.9 * s);
        return root + length * (s * root + s * s * bend) + width * (std::cos(theta) * side + std::sin(theta) * other);
    };
    add_patch(mesh, {segments + 1, 3, false, true, point});
}

}  // namespace

Scene make_soup(std::size_t triangle_count) {
    Rng rng(1);
    // As large as the cube's share of one triangle, so that a ray meets about the cube root of the count.
    const double half_side = std::cbrt(1 / double(triangle_count));
    Mesh mesh{"soup", {}, {}};
    for (std::size_t i = 0; i < triangle_count; ++i) {
        const Vec3d center = random_in_cube(rng, 1);
        const Vec3d a = random_in_cube(rng, half_side), b = random_in_cube(rng, half_side), c = random_in_cube(rng, half_side);
        add_separate_triangle(mesh, center + a, center + b, center + c);
    }
    return {"soup", {mesh}};
}

Scene make_needles(std::size_t triangle_count) {
    Rng rng(2);
    Mesh mesh{"needles", {}, {}};
    for (std::size_t i = 0; i < triangle_count; ++i) {
        const Vec3d tail = random_in_cube(rng, 1), along = random_direction(rng), across = perpendicular(along);
        const double length = rng.uniform(0.1, 1), width = length * std::pow(10, rng.uniform(-7, -3)), foot = rng.uniform();
        add_separate_triangle(mesh, tail, tail + length * along, tail + (foot * length) * along + width * across);
    }
    return {"needles", {mesh}};
}

Scene make_identical(std::size_t triangle_count) {
    Mesh mesh{"identical", {-1, -1, 0, 1, -1, 0, 0, 1, 0}, {}};
    for (std::size_t i = 0; i < triangle_count; ++i) add_triangle(mesh, 0, 1, 2);
    return {"identical", {mesh}};
}

Scene make_hair(std::size_t triangle_count) {
    constexpr std::uint32_t segments = 12;
    constexpr double strand_triangles = 6 * segments;
    Rng rng(3);
    Mesh mesh{"hair", {}, {}};
    const std::uint32_t strand_count = at_least(1, double(triangle_count) / strand_triangles);
    for (std::uint32_t i = 0; i < strand_count; ++i) add_strand(mesh, rng, segments);
    return {"hair", {mesh}};
}

}  // namespace harness
