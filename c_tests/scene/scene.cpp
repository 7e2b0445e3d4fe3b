#include "scene/scene.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace harness {

namespace {

Vec3f vertex(const Mesh& mesh, std::uint32_t index) {
    const float* p = &mesh.positions[std::size_t(index) * 3];
    return {p[0], p[1], p[2]};
}

bool is_finite(const Vec3f& p) { return std::isfinite(p[0]) && std::isfinite(p[1]) && std::isfinite(p[2]); }

void grow(Bounds& bounds, const Vec3f& p) {
    for (int axis = 0; axis < 3; ++axis) {
        bounds.lower[axis] = std::min(bounds.lower[axis], double(p[axis]));
        bounds.upper[axis] = std::max(bounds.upper[axis], double(p[axis]));
    }
}

}  // namespace

std::size_t Scene::triangle_count() const {
    std::size_t count = 0;
    for (const Mesh& mesh : meshes) count += mesh.triangle_count();
    return count;
}

Bounds Scene::bounds() const {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    Bounds bounds{{infinity, infinity, infinity}, {-infinity, -infinity, -infinity}};
    for (const Mesh& mesh : meshes) {
        for (std::uint32_t index : mesh.indices) {
            const Vec3f p = vertex(mesh, index);
            if (is_finite(p)) grow(bounds, p);
        }
    }
    return bounds;
}

std::array<Vec3f, 3> Scene::triangle(std::uint32_t geometry_id, std::uint32_t primitive_id) const {
    const Mesh& mesh = meshes[geometry_id];
    const std::uint32_t* corner = &mesh.indices[std::size_t(primitive_id) * 3];
    return {vertex(mesh, corner[0]), vertex(mesh, corner[1]), vertex(mesh, corner[2])};
}

}  // namespace harness
