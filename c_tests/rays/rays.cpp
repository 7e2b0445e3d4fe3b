// The kinds of rays that renderers trace.
#include "rays/rays.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

#include "harness/rng.hpp"
#include "rays/vector.hpp"

namespace harness {
namespace {

constexpr float infinity = std::numeric_limits<float>::infinity();

/// A place on a surface, and the unit normal on the side that the ray came from.
struct SurfacePoint {
    Vec3d position, normal;
};

/// Nothing where the answer is a miss, names no triangle of the scene, or one whose area vanishes.
std::optional<SurfacePoint> surface_point(const Scene& scene, const GnomonRay& ray, const GnomonHit& hit) {
    if (hit.geometry_id >= scene.meshes.size()) return {};
    if (hit.primitive_id >= scene.meshes[hit.geometry_id].triangle_count()) return {};
    const auto [p0, p1, p2] = scene.triangle(hit.geometry_id, hit.primitive_id);
    const Vec3d a = to_double(p0), b = to_double(p1), c = to_double(p2);
    const Vec3d normal = cross(b - a, c - a);
    const double area = length(normal);
    if (!(area > 0)) return {};
    const double u = hit.u, v = hit.v;
    const bool faces_ray = dot(normal, to_double(ray.direction)) < 0;
    return SurfacePoint{(1 - u - v) * a + u * b + v * c, ((faces_ray ? 1 : -1) / area) * normal};
}

std::vector<SurfacePoint> surface_points(const Scene& scene, const RaySet& primary, const std::vector<GnomonHit>& hits) {
    std::vector<SurfacePoint> points;
    for (std::size_t i = 0; i < hits.size(); ++i) {
        if (const auto point = surface_point(scene, primary.rays[i], hits[i])) points.push_back(*point);
    }
    return points;
}

/// The origin of a ray that leaves the surface on the normal's side. Rounding a point of the plane to floats moves it by at most
/// u |P_i| an axis, u = 2^-24, so along the normal by at most the sum of |n_i| u |P_i|. A step of that length, rounded away from
/// the surface, cannot end behind it (Pharr, Jakob, Humphreys, PBRT 4, 6.8.6).
Vec3f offset_origin(const SurfacePoint& point) {
    constexpr double unit_roundoff = 0x1p-24;
    double bound = 0;
    for (int axis = 0; axis < 3; ++axis) bound += std::abs(point.normal[axis]) * unit_roundoff * std::abs(point.position[axis]);
    Vec3f origin;
    for (int axis = 0; axis < 3; ++axis) {
        const float rounded = static_cast<float>(static_cast<float>(point.position[axis]) + bound * point.normal[axis]);
        const double outward = point.normal[axis];
        if (outward == 0) {
            origin[axis] = rounded;
            continue;
        }
        const float stepped = std::nextafter(rounded, outward > 0 ? infinity : -infinity);
        // A step among the subnormals, over a long direction, would come to a t of 0, which is a hit.
        const bool vanishes = std::abs(stepped) < std::numeric_limits<float>::min();
        origin[axis] = vanishes ? std::copysign(std::numeric_limits<float>::min(), static_cast<float>(outward)) : stepped;
    }
    return origin;
}

GnomonRay make_ray(const Vec3f& origin, const Vec3d& direction, float t_max) {
    GnomonRay ray{};
    std::copy(origin.begin(), origin.end(), ray.origin);
    for (int axis = 0; axis < 3; ++axis) ray.direction[axis] = static_cast<float>(direction[axis]);
    ray.t_max = t_max;
    return ray;
}

/// Malley's method: a uniform point of the unit disc, lifted to the hemisphere.
Vec3d cosine_direction(const Vec3d& normal, Rng& rng) {
    const Vec3d axis = std::abs(normal[0]) < 0.5 ? Vec3d{1, 0, 0} : Vec3d{0, 1, 0};
    const Vec3d tangent = normalized(cross(normal, axis)), bitangent = cross(normal, tangent);
    const double area = rng.uniform(), angle = 2 * std::numbers::pi * rng.uniform();
    const double radius = std::sqrt(area);
    return radius * std::cos(angle) * tangent + radius * std::sin(angle) * bitangent + std::sqrt(1 - area) * normal;
}

/// A horizontal square, as wide as half the scene, above it by half its largest side.
struct Light {
    Vec3d centre;
    double half_side;

    explicit Light(const Bounds& bounds) : centre(0.5 * (bounds.lower + bounds.upper)) {
        const Vec3d extent = bounds.upper - bounds.lower;
        centre[1] = bounds.upper[1] + 0.5 * std::max({extent[0], extent[1], extent[2]});
        half_side = 0.25 * std::max(extent[0], extent[2]);
    }
    Vec3d sample(Rng& rng) const {
        const double x = rng.uniform(-half_side, half_side), z = rng.uniform(-half_side, half_side);
        return centre + Vec3d{x, 0, z};
    }
};

Vec3d random_point(const Bounds& bounds, Rng& rng) {
    Vec3d point;
    for (int axis = 0; axis < 3; ++axis) {
        const double margin = 0.05 * (bounds.upper[axis] - bounds.lower[axis]);
        point[axis] = rng.uniform(bounds.lower[axis] - margin, bounds.upper[axis] + margin);
    }
    return point;
}

}  // namespace

RaySet primary_rays(const Camera& camera, std::size_t count) {
    const double aspect = camera.half_width / camera.half_height;
    const std::size_t width = std::max<std::size_t>(1, std::llround(std::sqrt(static_cast<double>(count) * aspect)));
    const double height = std::ceil(static_cast<double>(count) / static_cast<double>(width));
    RaySet set{"primary", false, {}};
    set.rays.reserve(count);
    for (std::size_t i = 0; i < count; ++i) {
        const double column = static_cast<double>(i % width), row = static_cast<double>(i / width);
        set.rays.push_back(camera.ray((column + 0.5) / static_cast<double>(width), (row + 0.5) / height));
    }
    return set;
}

RaySet bounce_rays(const Scene& scene, const RaySet& primary, const std::vector<GnomonHit>& hits, std::size_t count,
                   std::uint64_t seed) {
    Rng rng(seed);
    const std::vector<SurfacePoint> points = surface_points(scene, primary, hits);
    RaySet set{"bounce", false, {}};
    set.rays.reserve(count);
    for (std::size_t i = 0; i < count && !points.empty(); ++i) {
        const SurfacePoint& point = points[i % points.size()];
        set.rays.push_back(make_ray(offset_origin(point), cosine_direction(point.normal, rng), infinity));
    }
    return set;
}

RaySet shadow_rays(const Scene& scene, const RaySet& primary, const std::vector<GnomonHit>& hits, std::size_t count,
                   std::uint64_t seed) {
    Rng rng(seed);
    const Light light(scene.bounds());
    std::vector<SurfacePoint> points = surface_points(scene, primary, hits);
    std::erase_if(points, [&](const SurfacePoint& point) { return dot(point.normal, light.centre - point.position) <= 0; });
    RaySet set{"shadow", true, {}};
    set.rays.reserve(count);
    for (std::size_t i = 0; i < count && !points.empty(); ++i) {
        const Vec3f origin = offset_origin(points[i % points.size()]);
        set.rays.push_back(make_ray(origin, light.sample(rng) - to_double(origin), 1.0f));
    }
    return set;
}

RaySet connection_rays(const Scene& scene, const RaySet& primary, const std::vector<GnomonHit>& hits, std::size_t count,
                       std::uint64_t seed) {
    constexpr double grazing = 0.01;                  // as a cosine: two points of one plane face each other by rounding alone
    constexpr float short_of_the_end = 1 - 0x1p-10f;  // the surface there must not be in the way, whatever an engine's error of t
    constexpr std::size_t most_tries = 64;            // for one ray: on a convex surface no two points face each other
    Rng rng(seed);
    const std::vector<SurfacePoint> points = surface_points(scene, primary, hits);
    RaySet set{"shadow", true, {}};
    set.rays.reserve(count);
    for (std::size_t tries = 0; set.rays.size() < count && tries < most_tries * count && !points.empty(); ++tries) {
        const SurfacePoint& from = points[tries % points.size()];
        const SurfacePoint& to = points[rng.below(points.size())];
        const Vec3d between = to.position - from.position;
        const double least_cosine = grazing * length(between);
        if (!(dot(between, from.normal) > least_cosine && dot(between, to.normal) < -least_cosine)) continue;
        const Vec3f origin = offset_origin(from);
        set.rays.push_back(make_ray(origin, to_double(offset_origin(to)) - to_double(origin), short_of_the_end));
    }
    return set;
}

RaySet random_rays(const Scene& scene, std::size_t count, std::uint64_t seed) {
    Rng rng(seed);
    const Bounds bounds = scene.bounds();
    RaySet set{"random", false, {}};
    set.rays.reserve(count);
    for (std::size_t i = 0; i < count; ++i) {
        const Vec3d from = random_point(bounds, rng), to = random_point(bounds, rng);
        set.rays.push_back(make_ray(to_float(from), to - from, infinity));
    }
    return set;
}

std::vector<GnomonRay> spread_rays(const std::vector<GnomonRay>& rays, std::size_t count) {
    count = std::min(count, rays.size());
    std::vector<GnomonRay> part;
    part.reserve(count);
    for (std::size_t i = 0; i < count; ++i) part.push_back(rays[i * rays.size() / count]);
    return part;
}

}  // namespace harness
