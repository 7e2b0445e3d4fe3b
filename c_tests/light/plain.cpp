#include "light/plain.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "rays/vector.hpp"

namespace harness {
namespace {

constexpr float infinity = std::numeric_limits<float>::infinity();

void require(GnomonStatus status) {
    if (status != GNOMON_OK) throw std::runtime_error(gnomon_last_error());
}

/// Towards one of the rectangle's triangles, each as likely, or towards the sphere.
GnomonDirectionSample sample_lamp(const HalfHidden& place, Rng& rng) {
    GnomonDirectionSample sample;
    const double u = rng.uniform(), v = rng.uniform();
    if (place.sphere.radius > 0) {
        const Vec3d to_centre = to_double(place.sphere.centre) - to_double(place.point);
        // The axis is rounded: a wider cone has all of the sphere.
        const double half_angle = std::asin(place.sphere.radius / length(to_centre)) + 0x1p-22;
        require(gnomon_sample_cone(to_float(to_centre).data(), half_angle, u, v, &sample));
        return sample;
    }
    const std::size_t triangle = rng.below(2);
    const auto corner = [&](std::size_t i) { return &place.rectangle.positions[3 * place.rectangle.indices[3 * triangle + i]]; };
    require(gnomon_sample_triangle(place.point.data(), corner(0), corner(1), corner(2), u, v, &sample));
    sample.density_per_sr /= 2;
    return sample;
}

GnomonDirectionSample sample_direction(const HalfHidden& place, PlainSampling sampling, Rng& rng) {
    if (sampling == PlainSampling::lamp) return sample_lamp(place, rng);
    GnomonDirectionSample sample;
    const double u = rng.uniform(), v = rng.uniform();
    require(sampling == PlainSampling::sphere ? gnomon_sample_sphere(u, v, &sample)
                                              : gnomon_sample_cosine_hemisphere(place.normal.data(), u, v, &sample));
    return sample;
}

}  // namespace

const char* name_of(PlainSampling sampling) {
    switch (sampling) {
        case PlainSampling::sphere:
            return "plain, sphere";
        case PlainSampling::cosine_hemisphere:
            return "plain, cosine";
        case PlainSampling::lamp:
            return "plain, lamp";
    }
    throw std::logic_error("no such sampling");
}

SceneHandle build_lamp(const HalfHidden& place) {
    if (!(place.sphere.radius > 0)) return build_meshes({place.rectangle});
    const BuilderHandle builder = new_builder();
    const GnomonSpheres spheres{place.sphere.centre, 0, &place.sphere.radius, 0, 1};
    require(gnomon_scene_builder_add_spheres(builder.get(), &spheres, nullptr));
    GnomonScene* scene = nullptr;
    require(gnomon_scene_build(builder.get(), nullptr, &scene));
    return SceneHandle(scene);
}

PlainEstimate plain_irradiance(const HalfHidden& place, const GnomonScene* lamp, const GnomonScene* screen,
                               PlainSampling sampling, std::uint64_t sample_count, std::uint64_t seed) {
    const Vec3d normal = normalized(to_double(place.normal));
    Rng rng(seed);
    double sum = 0, squares = 0;
    for (std::uint64_t i = 0; i < sample_count; ++i) {
        const GnomonDirectionSample sample = sample_direction(place, sampling, rng);
        const double cosine = dot(normal, to_double(sample.direction));
        if (!(cosine > 0)) continue;
        GnomonRay ray{{place.point[0], place.point[1], place.point[2]}, 0, {}, infinity};
        std::copy_n(sample.direction, 3, ray.direction);
        GnomonHit hit;
        if (!gnomon_intersect(lamp, &ray, &hit)) continue;
        ray.t_max = hit.t;
        if (gnomon_occluded(screen, &ray)) continue;
        const double sent = lamp_luminance_nt * cosine / sample.density_per_sr;
        sum += sent, squares += sent * sent;
    }
    const double count = double(sample_count), mean = sum / count;
    return {mean, std::sqrt((squares / count - mean * mean) / (count - 1))};
}

}  // namespace harness
