// What the generators build with.
#pragma once

#include <cstdint>
#include <functional>

#include "scene/scene.hpp"

namespace harness {

/// Rounds to float and returns the new vertex's index.
std::uint32_t add_vertex(Mesh& mesh, const Vec3d& position);

void add_triangle(Mesh& mesh, std::uint32_t a, std::uint32_t b, std::uint32_t c);

/// Two triangles; a, b, c, d in order around the border.
void add_quad(Mesh& mesh, std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d);

/// Rows times columns of vertices, point(row, column), and the quads between neighbours: counter-clockwise seen from where
/// columns point right and rows up.
struct Patch {
    std::uint32_t rows, columns;
    bool rows_wrap = false, columns_wrap = false;  // the last neighbours the first
    std::function<Vec3d(std::uint32_t row, std::uint32_t column)> point;
};
/// Returns the index of the first vertex; (row, column) has that plus row * columns + column.
std::uint32_t add_patch(Mesh& mesh, const Patch& patch);

/// A closed sphere of 20 n^2 triangles: each face of an icosahedron in n^2.
void add_icosphere(Mesh& mesh, std::uint32_t n, const Vec3d& center, double radius);

/// A closed torus around the z axis.
void add_torus(Mesh& mesh, std::uint32_t around, std::uint32_t across, const Vec3d& center, double major, double minor);

/// 12 triangles, closed, outward unless `inward`.
void add_box(Mesh& mesh, const Vec3d& lower, const Vec3d& upper, bool inward = false);

/// A closed vertical cylinder of 4 * sides triangles.
void add_column(Mesh& mesh, std::uint32_t sides, const Vec3d& foot, double radius, double height);

/// The whole number nearest to `x`, at least `least`.
std::uint32_t at_least(std::uint32_t least, double x);

}  // namespace harness
