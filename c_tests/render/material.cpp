#include "render/material.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "gnomon.h"
#include "rays/vector.hpp"

namespace render {

using namespace harness;

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

/// By the cosine, so that the reflectance is the weight.
Scatter sample_diffuse(const Rgb& reflectance, const Vec3d& normal, int side, Rng& rng) {
    const double u = rng.uniform(), v = rng.uniform();
    GnomonDirectionSample sample{};
    gnomon_sample_cosine_hemisphere(to_float(side * normal).data(), u, v, &sample);
    return {to_double(sample.direction), side, reflectance, sample.density_per_sr};
}

/// By the reflectance, so that one way stands for both.
Scatter sample_glass(double index_of_refraction, const Rgb& transmittance, const Vec3d& towards, const Vec3d& normal, int side,
                     Rng& rng) {
    const GlassWays ways = glass_ways(index_of_refraction, towards, normal, side);
    if (rng.uniform() < ways.reflectance) return {ways.reflected, side, {1, 1, 1}, infinity};
    return {ways.refracted, -side, transmittance, infinity};
}

}  // namespace

Scatter sample_material(const Material& material, const Rgb& base_color, const Vec3d& towards, const Vec3d& normal, int side,
                        Rng& rng) {
    switch (material.kind) {
        case MaterialKind::diffuse:
            return sample_diffuse(base_color, normal, side, rng);
        case MaterialKind::mirror:
            return {reflected(towards, normal), side, base_color, infinity};
        case MaterialKind::glass:
            return sample_glass(material.index_of_refraction, base_color, towards, normal, side, rng);
    }
    return {};
}

GlassWays glass_ways(double index_of_refraction, const Vec3d& towards, const Vec3d& normal, int side) {
    const Vec3d facing = side * normal;
    const double relative_index = side > 0 ? index_of_refraction : 1 / index_of_refraction;
    const double cosine = std::clamp(-dot(towards, facing), 0.0, 1.0);
    // Snell's law for vectors: Heckbert 1989, "Derivation of refraction formulas", An Introduction to Ray Tracing.
    const double far_cosine = std::sqrt(std::max(0.0, 1 - (1 - cosine * cosine) / (relative_index * relative_index)));
    const Vec3d refracted = (1 / relative_index) * towards + (cosine / relative_index - far_cosine) * facing;
    return {fresnel_reflectance(cosine, relative_index), reflected(towards, normal), refracted};
}

double fresnel_reflectance(double cosine, double relative_index) {
    const double far_sine_squared = (1 - cosine * cosine) / (relative_index * relative_index);
    if (!(far_sine_squared < 1)) return 1;
    const double far_cosine = std::sqrt(1 - far_sine_squared);
    const double across = (cosine - relative_index * far_cosine) / (cosine + relative_index * far_cosine);
    const double within = (relative_index * cosine - far_cosine) / (relative_index * cosine + far_cosine);
    return 0.5 * (across * across + within * within);
}

Vec3d reflected(const Vec3d& towards, const Vec3d& normal) { return towards - 2 * dot(towards, normal) * normal; }

}  // namespace render
