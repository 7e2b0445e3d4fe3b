#include "scene/mesh_parts.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <utility>

namespace harness {

namespace {

/// A vertex of a subdivided icosahedron: up to three corners with their weights, in order, so that faces that share it find it by
/// the same key.
using LatticePoint = std::array<std::pair<std::uint32_t, std::uint32_t>, 3>;

constexpr double phi = std::numbers::phi;
constexpr std::array<Vec3d, 12> icosahedron_corners = {{{-1, phi, 0},
                                                        {1, phi, 0},
                                                        {-1, -phi, 0},
                                                        {1, -phi, 0},
                                                        {0, -1, phi},
                                                        {0, 1, phi},
                                                        {0, -1, -phi},
                                                        {0, 1, -phi},
                                                        {phi, 0, -1},
                                                        {phi, 0, 1},
                                                        {-phi, 0, -1},
                                                        {-phi, 0, 1}}};
constexpr std::uint32_t icosahedron_faces[20][3] = {
    {0, 11, 5}, {0, 5, 1}, {0, 1, 7}, {0, 7, 10}, {0, 10, 11}, {1, 5, 9}, {5, 11, 4}, {11, 10, 2}, {10, 7, 6}, {7, 1, 8},
    {3, 9, 4},  {3, 4, 2}, {3, 2, 6}, {3, 6, 8},  {3, 8, 9},   {4, 9, 5}, {2, 4, 11}, {6, 2, 10},  {8, 6, 7},  {9, 8, 1}};

class Icosphere {
public:
    Icosphere(Mesh& mesh, std::uint32_t n, const Vec3d& center, double radius)
        : mesh_(mesh), n_(n), center_(center), radius_(radius) {}

    void add_face(const std::uint32_t (&corners)[3]) {
        for (std::uint32_t row = 0; row < n_; ++row) {
            for (std::uint32_t i = 0; i < n_ - row; ++i) {
                const std::uint32_t b = vertex(corners, row, i + 1), c = vertex(corners, row + 1, i);
                add_triangle(mesh_, vertex(corners, row, i), b, c);
                if (i + 1 < n_ - row) add_triangle(mesh_, b, vertex(corners, row + 1, i + 1), c);
            }
        }
    }

private:
    std::uint32_t vertex(const std::uint32_t (&corners)[3], std::uint32_t row, std::uint32_t i) {
        LatticePoint point{{{n_ - row - i, corners[0]}, {i, corners[1]}, {row, corners[2]}}};
        for (auto& [weight, corner] : point)
            if (weight == 0) corner = 0;
        std::ranges::sort(point);
        const auto known = vertices_.find(point);
        if (known != vertices_.end()) return known->second;
        return vertices_[point] = add_vertex(mesh_, position(point));
    }

    Vec3d position(const LatticePoint& point) const {
        Vec3d sum{0, 0, 0};
        for (const auto& [weight, corner] : point)
            for (std::size_t axis = 0; axis < 3; ++axis) sum[axis] += weight * icosahedron_corners[corner][axis];
        const double scale = radius_ / std::hypot(sum[0], sum[1], sum[2]);
        return {center_[0] + scale * sum[0], center_[1] + scale * sum[1], center_[2] + scale * sum[2]};
    }

    Mesh& mesh_;
    std::uint32_t n_;
    Vec3d center_;
    double radius_;
    std::map<LatticePoint, std::uint32_t> vertices_;
};

}  // namespace

std::uint32_t add_vertex(Mesh& mesh, const Vec3d& position) {
    for (double coordinate : position) mesh.positions.push_back(float(coordinate));
    return std::uint32_t(mesh.vertex_count() - 1);
}

void add_triangle(Mesh& mesh, std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    mesh.indices.insert(mesh.indices.end(), {a, b, c});
}

void add_quad(Mesh& mesh, std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) {
    add_triangle(mesh, a, b, c);
    add_triangle(mesh, a, c, d);
}

std::uint32_t add_patch(Mesh& mesh, const Patch& patch) {
    const auto first = std::uint32_t(mesh.vertex_count());
    for (std::uint32_t row = 0; row < patch.rows; ++row)
        for (std::uint32_t column = 0; column < patch.columns; ++column) add_vertex(mesh, patch.point(row, column));
    const auto index = [&](std::uint32_t row, std::uint32_t column) {
        return first + row % patch.rows * patch.columns + column % patch.columns;
    };
    const std::uint32_t quad_rows = patch.rows - (patch.rows_wrap ? 0 : 1),
                        quad_columns = patch.columns - (patch.columns_wrap ? 0 : 1);
    for (std::uint32_t row = 0; row < quad_rows; ++row)
        for (std::uint32_t column = 0; column < quad_columns; ++column)
            add_quad(mesh, index(row, column), index(row, column + 1), index(row + 1, column + 1), index(row + 1, column));
    return first;
}

void add_icosphere(Mesh& mesh, std::uint32_t n, const Vec3d& center, double radius) {
    Icosphere sphere(mesh, n, center, radius);
    for (const auto& face : icosahedron_faces) sphere.add_face(face);
}

void add_torus(Mesh& mesh, std::uint32_t around, std::uint32_t across, const Vec3d& center, double major, double minor) {
    const auto point = [=](std::uint32_t row, std::uint32_t column) -> Vec3d {
        const double theta = 2 * std::numbers::pi * column / around, psi = 2 * std::numbers::pi * row / across;
        const double distance = major + minor * std::cos(psi);
        return {center[0] + distance * std::cos(theta), center[1] + distance * std::sin(theta),
                center[2] + minor * std::sin(psi)};
    };
    add_patch(mesh, {across, around, true, true, point});
}

void add_box(Mesh& mesh, const Vec3d& lower, const Vec3d& upper, bool inward) {
    const auto first = std::uint32_t(mesh.vertex_count());
    for (std::uint32_t corner = 0; corner < 8; ++corner)
        add_vertex(mesh, {corner & 1 ? upper[0] : lower[0], corner & 2 ? upper[1] : lower[1], corner & 4 ? upper[2] : lower[2]});
    constexpr std::uint32_t faces[6][4] = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
    for (const auto& [a, b, c, d] : faces)
        inward ? add_quad(mesh, first + d, first + c, first + b, first + a)
               : add_quad(mesh, first + a, first + b, first + c, first + d);
}

void add_column(Mesh& mesh, std::uint32_t sides, const Vec3d& foot, double radius, double height) {
    const auto point = [=](std::uint32_t row, std::uint32_t column) -> Vec3d {
        const double theta = 2 * std::numbers::pi * column / sides;
        return {foot[0] + radius * std::cos(theta), foot[1] + radius * std::sin(theta), foot[2] + row * height};
    };
    const std::uint32_t ring = add_patch(mesh, {2, sides, false, true, point});
    const std::uint32_t bottom = add_vertex(mesh, foot), top = add_vertex(mesh, {foot[0], foot[1], foot[2] + height});
    for (std::uint32_t i = 0; i < sides; ++i) {
        const std::uint32_t next = (i + 1) % sides;
        add_triangle(mesh, bottom, ring + next, ring + i);
        add_triangle(mesh, top, ring + sides + i, ring + sides + next);
    }
}

std::uint32_t at_least(std::uint32_t least, double x) { return std::max(least, std::uint32_t(std::lround(x))); }

}  // namespace harness
