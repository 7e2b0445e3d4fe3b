// Rays aimed at what is hard: vertices, edges, planes that divide a scene's box evenly.
#pragma once

#include <cstddef>
#include <limits>
#include <utility>
#include <vector>

#include "gnomon.h"
#include "harness/rng.hpp"
#include "scene/scene.hpp"

namespace harness {

/// Uniform on the sphere.
Vec3d unit_direction(Rng& rng);

GnomonRay ray_of(const Vec3f& origin, const Vec3f& direction, float t_min = 0,
                 float t_max = std::numeric_limits<float>::infinity());

/// The direction is the difference, rounded: the target is at a t of about 1.
GnomonRay ray_towards(const Vec3f& origin, const Vec3f& target);

/// False where a target rounded to the origin.
bool has_direction(const GnomonRay& ray);

/// The point at the share `along` of the way, rounded once.
Vec3f between(const std::pair<Vec3f, Vec3f>& edge, double along);

/// (1 - u - v) * A + u * B + v * C, rounded once.
Vec3f point_of(const std::array<Vec3f, 3>& triangle, double u, double v);

/// Towards vertices, points of edges and insides, from anywhere around; towards and along what divides the scene's box evenly.
std::vector<GnomonRay> aimed_rays(const Scene& scene, std::size_t count, Rng& rng);

}  // namespace harness
