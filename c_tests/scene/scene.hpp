// A scene as every engine gets it: world-space triangle meshes, nothing else.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace harness {

using Vec3f = std::array<float, 3>;
using Vec3d = std::array<double, 3>;

/// One geometry: its index in Scene::meshes is the geometry_id in every engine.
struct Mesh {
    std::string name;
    std::vector<float> positions;        // x y z, three floats a vertex, world space
    std::vector<std::uint32_t> indices;  // three a triangle, each < vertex_count()

    std::size_t vertex_count() const { return positions.size() / 3; }
    std::size_t triangle_count() const { return indices.size() / 3; }
};

struct Bounds {
    Vec3d lower, upper;  // lower > upper where there is no finite vertex
};

struct Scene {
    std::string name;
    std::vector<Mesh> meshes;

    std::size_t triangle_count() const;
    /// Box of all finite vertices that a triangle refers to.
    Bounds bounds() const;
    std::array<Vec3f, 3> triangle(std::uint32_t geometry_id, std::uint32_t primitive_id) const;
};

}  // namespace harness
