#include "render/surface_hit.hpp"

#include <limits>

#include "render/rgb.hpp"
#include "render/texture.hpp"
#include "render/traced_scene.hpp"

namespace render {

using namespace harness;

namespace {

Rgb base_color_at(const RenderScene& scene, const Surface& surface, const Material& material, const GnomonHit& hit) {
    if (material.base_color_texture < 0 || surface.uvs.empty()) return material.base_color;
    double texture_u = 0, texture_v = 0;
    const double weights[3] = {1.0 - hit.u - hit.v, hit.u, hit.v};
    for (std::size_t corner = 0; corner < 3; ++corner) {
        const std::size_t vertex = surface.mesh.indices[3 * std::size_t{hit.primitive_id} + corner];
        texture_u += weights[corner] * surface.uvs[2 * vertex];
        texture_v += weights[corner] * surface.uvs[2 * vertex + 1];
    }
    const Texture& texture = scene.textures[static_cast<std::size_t>(material.base_color_texture)];
    return material.base_color * texel_color(texture, texture_u, texture_v);
}

}  // namespace

int side_of(const Vec3d& direction, const Vec3d& normal) {
    const double along = dot(direction, normal);
    if (!(along * along > 0x1p-48 * dot(direction, direction))) return 0;
    return along > 0 ? 1 : -1;
}

std::optional<SurfaceHit> surface_hit(const RenderScene& scene, const GnomonScene* handle, const GnomonRay& ray,
                                      const GnomonHit& hit) {
    const Surface& surface = scene.surfaces[hit.geometry_id];
    const Material& material = scene.materials[surface.material_id];
    GnomonSurfacePoint point;
    require(gnomon_surface_point(handle, &ray, &hit, &point));
    const Vec3d towards = to_double(ray.direction), normal = to_double(point.normal);
    const int side = -side_of(towards, normal);
    if (side == 0) return {};
    return SurfaceHit{point, towards, normal, side, material, base_color_at(scene, surface, material, hit)};
}

std::optional<GnomonRay> ray_leaving(const SurfaceHit& hit, int side, const Vec3d& direction) {
    GnomonRay ray{{}, 0, {}, std::numeric_limits<float>::infinity()};
    for (std::size_t axis = 0; axis < 3; ++axis) ray.direction[axis] = static_cast<float>(direction[axis]);
    if (side_of(to_double(ray.direction), hit.normal) != side) return {};
    if (gnomon_offset_origin(&hit.point, ray.direction, ray.origin) != GNOMON_OK) return {};
    return ray;
}

std::optional<GnomonRay> ray_to(const SurfaceHit& hit, int side, const Vec3f& end) {
    auto ray = ray_leaving(hit, side, to_double(end) - to_double(hit.point.position));
    if (!ray) return {};
    for (std::size_t axis = 0; axis < 3; ++axis) ray->direction[axis] = end[axis] - ray->origin[axis];
    if (side_of(to_double(ray->direction), hit.normal) != side) return {};
    ray->t_max = 1;
    return ray;
}

}  // namespace render
