// What the renderer's suites build scenes of, and how they look at them.
#pragma once

#include <atomic>
#include <limits>
#include <utility>
#include <vector>

#include "rays/vector.hpp"
#include "render/camera_ray.hpp"
#include "render/lamp_rays.hpp"
#include "render/render.hpp"
#include "render/traced_scene.hpp"
#include "scene/mesh_parts.hpp"

namespace harness {

inline constexpr float infinity = std::numeric_limits<float>::infinity();

inline render::Rgb grey(float value) { return {value, value, value}; }

inline std::uint32_t add_material(render::RenderScene& scene, render::MaterialKind kind, float base_color,
                                  float emission_nt = 0) {
    render::Material material;
    material.kind = kind, material.base_color = grey(base_color), material.emission_nt = grey(emission_nt);
    scene.materials.push_back(material);
    return static_cast<std::uint32_t>(scene.materials.size() - 1);
}

inline void add_surface(render::RenderScene& scene, Mesh mesh, std::uint32_t material_id) {
    scene.surfaces.push_back({std::move(mesh), {}, material_id});
}

inline Mesh ball(const Vec3d& centre, double radius, std::uint32_t n = 12) {
    Mesh mesh;
    add_icosphere(mesh, n, centre, radius);
    return mesh;
}

inline Mesh inward_box(const Vec3d& lower, const Vec3d& upper) {
    Mesh mesh;
    add_box(mesh, lower, upper, true);
    return mesh;
}

/// Of a box, whose second quad is its top.
inline Mesh without_top(Mesh box) {
    const auto top = box.indices.begin() + 6;
    box.indices.erase(top, top + 6);
    return box;
}

/// A square at a height; its front is below where it `looks_down`.
inline Mesh square(double half_side, const Vec3d& centre, bool looks_down) {
    Mesh mesh;
    const auto corner = [&](double x, double y) { return add_vertex(mesh, centre + half_side * Vec3d{x, y, 0}); };
    const std::uint32_t a = corner(-1, -1), b = corner(1, -1), c = corner(1, 1), d = corner(-1, 1);
    looks_down ? add_quad(mesh, d, c, b, a) : add_quad(mesh, a, b, c, d);
    return mesh;
}

inline render::Camera camera_at(const Vec3d& position, const Vec3d& target, double half_height, double aspect) {
    const Vec3d forward = normalized(target - position), right = normalized(cross(forward, {0, 0, 1}));
    return {"", position, right, cross(right, forward), forward, half_height, aspect * half_height};
}

inline render::Rendering picture_of(const render::RenderScene& scene, const render::Camera& camera,
                                    const render::RenderOptions& options) {
    const std::atomic<bool> stop{false};
    return render::render(scene, camera, options, {}, stop);
}

/// What the rays through the centres of pixels hit, which are those of a picture of one sample.
struct Sight {
    std::vector<GnomonRay> rays;
    std::vector<GnomonHit> hits;
};

inline Sight sight_of(const render::RenderScene& scene, const render::Camera& camera, const render::RenderOptions& options) {
    const render::TracedScene traced(scene, options.precision, 1);
    Sight sight;
    for (int y = 0; y < options.height; ++y)
        for (int x = 0; x < options.width; ++x)
            sight.rays.push_back(camera_ray(camera, (x + 0.5) / options.width, (y + 0.5) / options.height));
    render::intersect_all(traced.handle.get(), sight.rays, sight.hits);
    return sight;
}

}  // namespace harness
