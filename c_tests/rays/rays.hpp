// The rays that every engine traces: written once, read by all.
#pragma once

#include <cstddef>
#include <cstdint>
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
};

/// Looks at the whole scene from outside, from a direction in which its box shows much area.
Camera outside_camera(const Scene& scene);

/// `count` rays through the pixels of a near-square image, in scanline order.
RaySet primary_rays(const Camera& camera, std::size_t count);

/// Cosine-distributed rays from the hits of `primary` (answers in `hits`, one a ray), started off the surface by a bound on the hit point's error. Repeats hits until there are `count`.
RaySet bounce_rays(const Scene& scene, const RaySet& primary, const std::vector<GnomonHit>& hits, std::size_t count, std::uint64_t seed);

/// From the same hits towards random points of a square light above the scene; t_max ends at the light.
RaySet shadow_rays(const Scene& scene, const RaySet& primary, const std::vector<GnomonHit>& hits, std::size_t count, std::uint64_t seed);

/// Between two uniform random points of the scene's box grown by a tenth.
RaySet random_rays(const Scene& scene, std::size_t count, std::uint64_t seed);

}  // namespace harness
