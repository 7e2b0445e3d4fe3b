// Surfaces without a border: neighbours share their vertices, so a ray from inside can only leave through a leak.
#include <cmath>
#include <map>
#include <numbers>

#include "scene/generators.hpp"
#include "scene/mesh_parts.hpp"

namespace harness {

namespace {

Scene single(const char* name, Mesh mesh) {
    mesh.name = name;
    return {name, {std::move(mesh)}};
}

/// Adds the six faces of an n x n x n lattice; faces share the vertices of the cube's edges.
class CubeGrid {
public:
    explicit CubeGrid(std::uint32_t n) : n_(n) {}

    /// The two faces across `axis`.
    void add_faces(std::size_t axis) {
        const std::size_t u = (axis + 1) % 3, v = (axis + 2) % 3;
        for (std::uint32_t i = 0; i < n_; ++i) {
            for (std::uint32_t j = 0; j < n_; ++j) {
                const auto corner = [&](std::uint32_t side, std::uint32_t di, std::uint32_t dj) {
                    std::array<std::uint32_t, 3> point;
                    point[axis] = side, point[u] = i + di, point[v] = j + dj;
                    return vertex(point);
                };
                add_quad(mesh_, corner(n_, 0, 0), corner(n_, 1, 0), corner(n_, 1, 1), corner(n_, 0, 1));
                add_quad(mesh_, corner(0, 0, 0), corner(0, 0, 1), corner(0, 1, 1), corner(0, 1, 0));
            }
        }
    }

    Mesh take() { return std::move(mesh_); }

private:
    std::uint32_t vertex(const std::array<std::uint32_t, 3>& point) {
        const auto known = vertices_.find(point);
        if (known != vertices_.end()) return known->second;
        Vec3d position;
        for (std::size_t axis = 0; axis < 3; ++axis) position[axis] = 2.0 * point[axis] / n_ - 1;
        return vertices_[point] = add_vertex(mesh_, position);
    }

    std::uint32_t n_;
    Mesh mesh_;
    std::map<std::array<std::uint32_t, 3>, std::uint32_t> vertices_;
};

}  // namespace

Scene make_icosphere(std::size_t triangle_count) {
    Mesh mesh;
    add_icosphere(mesh, at_least(1, std::sqrt(double(triangle_count) / 20)), {0, 0, 0}, 1);
    return single("icosphere", std::move(mesh));
}

Scene make_uv_sphere(std::size_t triangle_count) {
    // `bands` rows of quads and fans with 2 * bands longitudes: 4 * bands * (bands - 1) triangles.
    const std::uint32_t bands = at_least(2, 0.5 + std::sqrt(0.25 + double(triangle_count) / 4)), longitudes = 2 * bands;
    const auto point = [=](std::uint32_t row, std::uint32_t column) -> Vec3d {
        const double latitude = std::numbers::pi * ((row + 1.0) / bands - 0.5),
                     longitude = 2 * std::numbers::pi * column / longitudes;
        return {std::cos(latitude) * std::cos(longitude), std::cos(latitude) * std::sin(longitude), std::sin(latitude)};
    };
    Mesh mesh;
    const std::uint32_t southmost = add_patch(mesh, {bands - 1, longitudes, false, true, point});
    const std::uint32_t northmost = southmost + (bands - 2) * longitudes;
    const std::uint32_t south = add_vertex(mesh, {0, 0, -1}), north = add_vertex(mesh, {0, 0, 1});
    for (std::uint32_t i = 0; i < longitudes; ++i) {
        const std::uint32_t next = (i + 1) % longitudes;
        add_triangle(mesh, south, southmost + next, southmost + i);
        add_triangle(mesh, north, northmost + i, northmost + next);
    }
    return single("uv_sphere", std::move(mesh));
}

Scene make_cube_grid(std::size_t triangle_count) {
    CubeGrid cube(at_least(1, std::sqrt(double(triangle_count) / 12)));
    for (std::size_t axis = 0; axis < 3; ++axis) cube.add_faces(axis);
    return single("cube_grid", cube.take());
}

Scene make_torus(std::size_t triangle_count) {
    // Twice as many steps around as across: 4 * across^2 triangles.
    const std::uint32_t across = at_least(3, std::sqrt(double(triangle_count) / 4));
    Mesh mesh;
    add_torus(mesh, 2 * across, across, {0, 0, 0}, 1, 0.4);
    return single("torus", std::move(mesh));
}

Scene make_fan_valence(std::size_t triangle_count) {
    const std::uint32_t valence = at_least(3, double(triangle_count) / 2);
    Mesh mesh;
    for (std::uint32_t i = 0; i < valence; ++i) {
        const double theta = 2 * std::numbers::pi * i / valence;
        add_vertex(mesh, {std::cos(theta), std::sin(theta), 0});
    }
    const std::uint32_t bottom = add_vertex(mesh, {0, 0, -1}), top = add_vertex(mesh, {0, 0, 1});
    for (std::uint32_t i = 0; i < valence; ++i) {
        const std::uint32_t next = (i + 1) % valence;
        add_triangle(mesh, top, i, next);
        add_triangle(mesh, bottom, next, i);
    }
    return single("fan_valence", std::move(mesh));
}

Scene make_shells(std::size_t triangle_count) {
    constexpr std::uint32_t shell_count = 8;
    const std::uint32_t n = at_least(1, std::sqrt(double(triangle_count) / (20 * shell_count)));
    Scene scene;
    for (std::uint32_t i = 1; i <= shell_count; ++i) {
        Mesh& mesh = scene.meshes.emplace_back();
        mesh.name = "shell " + std::to_string(i);
        add_icosphere(mesh, n, {0, 0, 0}, double(i) / shell_count);
    }
    return scene;
}

}  // namespace harness
