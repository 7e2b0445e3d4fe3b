#include "render/path_tracer.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "render/material.hpp"
#include "render/rgb.hpp"
#include "render/surface_hit.hpp"

namespace render {

using namespace harness;

namespace {

/// The power heuristic with exponent 2: the weight of a sample that was taken with density `own` and could have come from the
/// other strategy with density `other`.
double heuristic(double own, double other) {
    if (std::isinf(own)) return 1;
    const double ratio = other / own;
    return 1 / (1 + ratio * ratio);
}

double weight_of_lamp_sample(Strategy strategy, const LampSample& sample, double material_density) {
    if (std::isinf(sample.density_per_sr) || strategy == Strategy::lamps) return 1;
    return strategy == Strategy::material ? 0 : heuristic(sample.density_per_sr, material_density);
}

/// Of emission that the path ran into.
double weight_of_material_sample(Strategy strategy, const Path& path, const Lamps& lamps, const GnomonHit& hit) {
    if (std::isinf(path.density_per_sr) || strategy == Strategy::material) return 1;
    if (strategy == Strategy::lamps) return 0;
    const double lamp_density = lamps.density_per_sr(path.from, hit.geometry_id, hit.primitive_id);
    return heuristic(path.density_per_sr, lamp_density);
}

/// Light straight from a lamp, at a diffuse surface.
void add_lamp_ray(const TracedScene& traced, const RenderOptions& options, const SurfaceHit& hit, Path& path, Wave& wave) {
    const auto sample = traced.lamps.sample(position_of(hit), path.rng);
    if (!sample) return;
    const double cosine = hit.side * dot(sample->direction, hit.normal);
    if (!(cosine > 0)) return;
    const double density = cosine / std::numbers::pi;  // with which the material would have chosen this direction
    const double weight = density * weight_of_lamp_sample(options.strategy, *sample, density);
    if (weight > 0) wave.lamp_rays.add(hit, *sample, static_cast<float>(weight) * (path.weight * hit.base_color), path.pixel);
}

/// Whether the path goes on: by chance once it matters little, and then it stands for those that ended (Arvo and Kirk 1990,
/// "Particle transport and image synthesis").
///
/// Where nothing absorbs, paths have to end too, but late: light goes round in glass for thousands of bounces. With 0.95 from the
/// third bounce on, 0.14 % of the furnace's light was in paths too rare for any picture to have, with 0.999 still 0.015 %; with
/// as many sure bounces 0.001 %, at no cost in time.
bool survives(int bounce, Path& path) {
    constexpr int sure_bounces = 3, sure_without_choice = 1 << 14;
    if (bounce < sure_bounces) return true;
    const bool has_choice = !std::isinf(path.density_per_sr);
    const double most = has_choice ? 0.95 : bounce < sure_without_choice ? 1 : 0.999;
    const double probability = std::min(most, static_cast<double>(largest(path.weight)));
    if (!(path.rng.uniform() < probability)) return false;
    path.weight = static_cast<float>(1 / probability) * path.weight;
    return true;
}

void advance(const TracedScene& traced, const RenderOptions& options, int bounce, const GnomonRay& ray, const GnomonHit& hit,
             Path& path, Wave& wave) {
    Rgb& pixel = wave.pixels[path.pixel];
    if (hit.geometry_id == GNOMON_INVALID_ID) {
        pixel += path.weight * traced.scene.environment_nt;
        return;
    }
    const auto surface = surface_hit(traced.scene, traced.handle.get(), ray, hit);
    if (!surface) return;
    const Rgb emission = emitted(surface->material, surface->side);
    if (largest(emission) > 0) {
        const double weight = weight_of_material_sample(options.strategy, path, traced.lamps, hit);
        pixel += static_cast<float>(weight) * (path.weight * emission);
    }
    if (options.max_depth > 0 && bounce == options.max_depth) return;

    if (surface->material.kind == MaterialKind::diffuse) add_lamp_ray(traced, options, *surface, path, wave);
    const Scatter scatter =
        sample_material(surface->material, surface->base_color, surface->towards, surface->normal, surface->side, path.rng);
    path.weight = path.weight * scatter.weight;
    path.from = position_of(*surface);
    path.density_per_sr = scatter.density_per_sr;
    if (!(largest(path.weight) > 0) || !survives(bounce, path)) return;
    if (const auto next = ray_leaving(*surface, scatter.side, scatter.direction)) wave.go_on(path, *next);
}

}  // namespace

void trace_paths(const TracedScene& traced, const RenderOptions& options, Wave& wave) {
    for (int bounce = 0; !wave.paths.empty(); ++bounce) {
        intersect_all(traced.handle.get(), wave.rays, wave.hits);
        wave.ray_count += wave.rays.size();
        for (std::size_t i = 0; i < wave.paths.size(); ++i)
            advance(traced, options, bounce, wave.rays[i], wave.hits[i], wave.paths[i], wave);
        wave.ray_count += wave.lamp_rays.trace(traced.handle.get(), wave.pixels);
        wave.turn();
    }
}

}  // namespace render
