#include "render/whitted.hpp"

#include <numbers>

#include "render/material.hpp"
#include "render/rgb.hpp"
#include "render/surface_hit.hpp"

namespace render {

using namespace harness;

namespace {

/// Mirrors that face each other would never end; `max_depth` 0 means this.
constexpr int most_bounces = 32;

/// What weighs less is not followed, so that glass among glass ends: Hall and Greenberg 1983, "A testbed for realistic image
/// synthesis". It is half a step of 8 bits.
constexpr float least_weight = 0x1p-9f;

void add_lamp_ray(const SurfaceHit& hit, const std::optional<LampSample>& sample, const Path& path, Wave& wave) {
    if (!sample) return;
    const double cosine = hit.side * dot(sample->direction, hit.normal);
    if (!(cosine > 0)) return;
    const Rgb reflected = path.weight * hit.base_color;
    wave.lamp_rays.add(hit, *sample, static_cast<float>(cosine / std::numbers::pi) * reflected, path.pixel);
}

void add_lamp_rays(const Lamps& lamps, const SurfaceHit& hit, Path& path, Wave& wave) {
    const Vec3f point = position_of(hit);
    for (std::size_t i = 0; i < lamps.sizeless_count(); ++i) add_lamp_ray(hit, lamps.sizeless(i, point), path, wave);
    add_lamp_ray(hit, lamps.sample_triangle(point, path.rng), path, wave);
}

void go_on(const SurfaceHit& hit, int side, const Vec3d& direction, const Rgb& weight, Path path, Wave& wave) {
    path.weight = path.weight * weight;
    if (largest(path.weight) < least_weight) return;
    if (const auto ray = ray_leaving(hit, side, direction)) wave.go_on(path, *ray);
}

void go_on_at_glass(const SurfaceHit& hit, const Path& path, Wave& wave) {
    const GlassWays ways = glass_ways(hit.material.index_of_refraction, hit.towards, hit.normal, hit.side);
    const auto reflectance = static_cast<float>(ways.reflectance);
    Path other = path;
    other.rng = Rng(other.rng.next());  // both would take the same samples of lamps
    go_on(hit, hit.side, ways.reflected, {reflectance, reflectance, reflectance}, path, wave);
    go_on(hit, -hit.side, ways.refracted, (1 - reflectance) * hit.base_color, other, wave);
}

void advance(const TracedScene& traced, bool is_last, const GnomonRay& ray, const GnomonHit& hit, Path& path, Wave& wave) {
    Rgb& pixel = wave.pixels[path.pixel];
    if (hit.geometry_id == GNOMON_INVALID_ID) {
        pixel += path.weight * traced.scene.environment_nt;
        return;
    }
    const auto surface = surface_hit(traced.scene, traced.handle.get(), ray, hit);
    if (!surface) return;
    pixel += path.weight * emitted(surface->material, surface->side);
    if (is_last) return;
    switch (surface->material.kind) {
        case MaterialKind::diffuse:
            return add_lamp_rays(traced.lamps, *surface, path, wave);
        case MaterialKind::mirror:
            return go_on(*surface, surface->side, reflected(surface->towards, surface->normal), surface->base_color, path, wave);
        case MaterialKind::glass:
            return go_on_at_glass(*surface, path, wave);
    }
}

}  // namespace

void trace_whitted(const TracedScene& traced, const RenderOptions& options, Wave& wave) {
    const int last = options.max_depth > 0 ? options.max_depth : most_bounces;
    for (int bounce = 0; !wave.paths.empty(); ++bounce) {
        intersect_all(traced.handle.get(), wave.rays, wave.hits);
        wave.ray_count += wave.rays.size();
        for (std::size_t i = 0; i < wave.paths.size(); ++i)
            advance(traced, bounce == last, wave.rays[i], wave.hits[i], wave.paths[i], wave);
        wave.ray_count += wave.lamp_rays.trace(traced.handle.get(), wave.pixels);
        wave.turn();
    }
}

}  // namespace render
