// A view of a scene from within its box.
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <set>
#include <utility>

#include "harness/rng.hpp"
#include "rays/rays.hpp"
#include "rays/vector.hpp"
#include "scene/load.hpp"

namespace harness {
namespace {

constexpr std::uint64_t seed = 7;
constexpr std::size_t candidate_count = 96, coarse_ray_count = 1'024;
constexpr double widest_tangent = 0.7;  // of half the angle of view: 70 degrees in all, a wide lens, as interiors are shown

/// Uniform on the sphere, by Archimedes' projection.
Vec3d random_direction(Rng& rng) {
    const double y = rng.uniform(-1, 1), longitude = rng.uniform(0, 2 * std::numbers::pi), radius = std::sqrt(1 - y * y);
    return {radius * std::cos(longitude), y, radius * std::sin(longitude)};
}

Camera candidate(const Bounds& bounds, Rng& rng) {
    constexpr double margin = 0.05;  // of the box, on each side
    Camera camera;
    for (int axis = 0; axis < 3; ++axis) {
        camera.position[axis] = std::lerp(bounds.lower[axis], bounds.upper[axis], rng.uniform(margin, 1 - margin));
    }
    camera.aim(random_direction(rng));
    camera.half_width = widest_tangent;
    camera.half_height = 0.75 * widest_tangent;
    return camera;
}

/// Seeing something in every pixel, as different as can be, comes first; then distance, up to a quarter of the box's diagonal.
double score(const Sight& sight, double diagonal) {
    constexpr double far_enough = 0.25;
    if (sight.hit_share == 0) return 0;
    return sight.hit_share + sight.triangle_share + std::min(sight.median_depth / diagonal, far_enough);
}

}  // namespace

Sight sight(const Camera& camera, const Tracer& trace) {
    const RaySet coarse = primary_rays(camera, coarse_ray_count);
    std::vector<float> depths;
    std::set<std::pair<std::uint32_t, std::uint32_t>> triangles;
    for (const GnomonHit& hit : trace(coarse.rays)) {
        if (hit.geometry_id == GNOMON_INVALID_ID) continue;
        depths.push_back(hit.t);
        triangles.emplace(hit.geometry_id, hit.primitive_id);
    }
    if (depths.empty()) return {0, 0, std::numeric_limits<double>::quiet_NaN()};
    const auto middle = depths.begin() + static_cast<std::ptrdiff_t>(depths.size() / 2);
    std::nth_element(depths.begin(), middle, depths.end());
    const double pixels = static_cast<double>(coarse.rays.size());
    return {static_cast<double>(depths.size()) / pixels, static_cast<double>(triangles.size()) / pixels, *middle};
}

Camera inside_camera(const Scene& scene, const Tracer& trace) {
    const Bounds bounds = scene.bounds();
    if (!(bounds.lower[0] <= bounds.upper[0]))
        throw SceneError(scene.name + ": no triangle has a finite vertex, so there is nothing to look at");
    const double diagonal = length(bounds.upper - bounds.lower);
    Rng rng(seed);
    Camera best = candidate(bounds, rng);
    double best_score = score(sight(best, trace), diagonal);
    for (std::size_t i = 1; i < candidate_count; ++i) {
        const Camera camera = candidate(bounds, rng);
        const double camera_score = score(sight(camera, trace), diagonal);
        if (camera_score > best_score) {
            best = camera;
            best_score = camera_score;
        }
    }
    return best;
}

}  // namespace harness
