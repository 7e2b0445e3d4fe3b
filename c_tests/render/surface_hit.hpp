// What a ray hit, and how the next one leaves it.
//
// The normal is the triangle's own, never one interpolated between vertices: that would have lit points behind the horizon and
// dark ones before it, and directions that lead into the surface; and a diffuse surface would return more than it gets.
#pragma once

#include <optional>

#include "gnomon.h"
#include "render/render_scene.hpp"

namespace render {

struct SurfaceHit {
    GnomonSurfacePoint point;
    Vec3d towards;  // the ray's direction
    Vec3d normal;   // of unit length, of the side that counter-clockwise vertices show
    int side;       // that the ray came from: 1 the normal's, -1 the other
    const Material& material;
    Rgb base_color;  // with the texture
};

inline Vec3f position_of(const SurfaceHit& hit) { return {hit.point.position[0], hit.point.position[1], hit.point.position[2]}; }

/// Nothing where rounding leaves open from which side the ray came. Throws harness::SceneError.
std::optional<SurfaceHit> surface_hit(const RenderScene& scene, const GnomonScene* handle, const GnomonRay& ray,
                                      const GnomonHit& hit);

/// The side that a direction leads to: 1 the normal's, -1 the other, 0 where the rounding of the normal leaves it open.
///
/// Each component of a surface point's normal is within 0.51 * 2^-24, so that the dot product is within sqrt(3) * 0.51 * 2^-24,
/// below 2^-24, of the direction's length; its own rounding, 2^-51, has room in the difference. Without this a path could leave a
/// closed room along its wall. Paths that end there are lost light: of a cosine-weighted hemisphere 2^-48.
int side_of(const Vec3d& direction, const Vec3d& normal);

/// The ray that leaves a surface to `side`. Nothing where, rounded, the direction might lead to another one.
std::optional<GnomonRay> ray_leaving(const SurfaceHit& hit, int side, const Vec3d& direction);

/// As `ray_leaving`, with the end at t = 1.
std::optional<GnomonRay> ray_to(const SurfaceHit& hit, int side, const Vec3f& end);

}  // namespace render
