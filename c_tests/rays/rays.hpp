// The rays that every engine traces: written once, read by all.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "gnomon.h"
#include "scene/scene.hpp"

namespace harness {

struct RaySet {
    std::string kind;        // "primary", "bounce", "shadow", "random"
    bool occlusion = false;  // asked with occluded(), not intersect()
    std::vector<GnomonRay> rays;
};

/// A pinhole view; image rows go down. Unit vectors; half_width and half_height are tangents of the half angles.
struct Camera {
    Vec3d position, forward, right, up;
    double half_width = 0, half_height = 0;
    GnomonRay ray(double x, double y) const;  // x, y in [0, 1]
    void aim(const Vec3d& direction);         // any length, not along y, which is up in the image
};

/// Looks at the whole scene from outside, from a direction in which its box shows much area. Throws SceneError when no vertex is
/// finite.
Camera outside_camera(const Scene& scene);

/// Some engine's closest hits, one a ray.
using Tracer = std::function<std::vector<GnomonHit>(const std::vector<GnomonRay>&)>;

/// Looks about from a point within the scene's box: of random points and directions the ones from which most pixels see
/// geometry, many triangles of it, and far away rather than near. The same on every call. Throws SceneError when no vertex is
/// finite.
Camera inside_camera(const Scene& scene, const Tracer& trace);

/// What a coarse image of a view shows.
struct Sight {
    double hit_share;       // of the pixels
    double triangle_share;  // different triangles, by pixels: low before a bare wall
    double median_depth;    // NaN where nothing is hit
};
Sight sight(const Camera& camera, const Tracer& trace);

/// `count` rays through the pixels of a near-square image, in scanline order.
RaySet primary_rays(const Camera& camera, std::size_t count);

/// Cosine-distributed rays from the hits of `primary` (answers in `hits`, one a ray), started off the surface by a bound on the
/// hit point's error. Repeats hits until there are `count`; none when nothing was hit.
RaySet bounce_rays(const Scene& scene, const RaySet& primary, const std::vector<GnomonHit>& hits, std::size_t count,
                   std::uint64_t seed);

/// From the same hits towards random points of a square light above the scene; t_max ends at the light.
/// Hits that face away from the light are left out, so there may be no ray at all.
RaySet shadow_rays(const Scene& scene, const RaySet& primary, const std::vector<GnomonHit>& hits, std::size_t count,
                   std::uint64_t seed);

/// From the same hits towards other hits, both ends off their surfaces, as light is carried from place to place; t_max ends
/// there. Pairs that face away from each other are left out, so there may be no ray at all.
RaySet connection_rays(const Scene& scene, const RaySet& primary, const std::vector<GnomonHit>& hits, std::size_t count,
                       std::uint64_t seed);

/// From one uniform random point of the scene's box, grown by a tenth, towards another; t_max is infinite.
RaySet random_rays(const Scene& scene, std::size_t count, std::uint64_t seed);

/// `count` of the rays, evenly spread, so that the part looks like the whole; all of them where there are no more.
std::vector<GnomonRay> spread_rays(const std::vector<GnomonRay>& rays, std::size_t count);

}  // namespace harness
