#include "render/lamps.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "render/image.hpp"
#include "render/rgb.hpp"
#include "render/triangle.hpp"

namespace render {

using namespace harness;

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

double spot_flux_lm(const SpotLight& light) {
    double flux = 0;
    gnomon_spot_flux_lm(luminance(light.intensity_cd), light.inner_cone_rad, light.outer_cone_rad, &flux);
    return flux;
}

/// Of a lamp at `position`; `attenuation` of the direction from the lamp.
template <typename Attenuation>
std::optional<LampSample> from_position(const Vec3f& position, const Rgb& intensity_cd, float range_m, const Vec3f& point,
                                        Attenuation attenuation) {
    const Vec3d way = to_double(position) - to_double(point);
    const double distance_squared = dot(way, way), distance = std::sqrt(distance_squared);
    if (!(distance > 0)) return {};
    const Vec3d direction = (1 / distance) * way;
    const double share = attenuation(-direction) * gnomon_range_attenuation(distance, range_m);
    if (!(share > 0)) return {};
    return LampSample{direction, static_cast<float>(share / distance_squared) * intensity_cd, infinity, position};
}

double spot_attenuation(const SpotLight& light, const Vec3d& direction) {
    const double cosine = dot(direction, normalized(to_double(light.direction)));
    return gnomon_spot_attenuation(std::acos(std::clamp(cosine, -1.0, 1.0)), light.inner_cone_rad, light.outer_cone_rad);
}

}  // namespace

Rgb emitted(const Material& material, int side) {
    return side > 0 || material.is_double_sided ? material.emission_nt : Rgb{0, 0, 0};
}

Lamps::Lamps(const RenderScene& scene, double radius_m) : scene_(scene) {
    add_triangles(scene);
    triangle_count_ = lamps_.size();
    for (std::size_t i = 0; i < scene.point_lights.size(); ++i)
        add(Kind::point, i, 0, gnomon_isotropic_flux_lm(luminance(scene.point_lights[i].intensity_cd)));
    for (std::size_t i = 0; i < scene.spot_lights.size(); ++i) add(Kind::spot, i, 0, spot_flux_lm(scene.spot_lights[i]));
    const double disc_m2 = std::numbers::pi * radius_m * radius_m;
    for (std::size_t i = 0; i < scene.directional_lights.size(); ++i)
        add(Kind::directional, i, 0, disc_m2 * luminance(scene.directional_lights[i].illuminance_lx));
}

void Lamps::add(Kind kind, std::size_t index, std::size_t primitive_id, double power) {
    const double before = lamps_.empty() ? 0 : lamps_.back().power_until;
    lamps_.push_back({kind, static_cast<std::uint32_t>(index), static_cast<std::uint32_t>(primitive_id), before + power});
}

void Lamps::add_triangles(const RenderScene& scene) {
    first_of_surface_.assign(scene.surfaces.size(), std::numeric_limits<std::size_t>::max());
    for (std::size_t surface = 0; surface < scene.surfaces.size(); ++surface) {
        const Material& material = scene.materials[scene.surfaces[surface].material_id];
        const double exitance_lm_per_m2 = gnomon_lambertian_exitance_lm_per_m2(luminance(material.emission_nt));
        if (!(exitance_lm_per_m2 > 0)) continue;
        first_of_surface_[surface] = lamps_.size();
        const Mesh& mesh = scene.surfaces[surface].mesh;
        for (std::size_t i = 0; i < mesh.triangle_count(); ++i) {
            const auto [a, b, c] = triangle_of(mesh, i);
            const double area = 0.5 * length(cross(to_double(b) - to_double(a), to_double(c) - to_double(a)));
            add(Kind::triangle, surface, i, (material.is_double_sided ? 2 : 1) * area * exitance_lm_per_m2);
        }
    }
}

double Lamps::power(std::size_t lamp) const { return lamps_[lamp].power_until - (lamp == 0 ? 0 : lamps_[lamp - 1].power_until); }

/// One of the first `count` lamps, by power; never one without.
std::optional<std::size_t> Lamps::choose(std::size_t count, double u) const {
    if (count == 0 || !(lamps_[count - 1].power_until > 0)) return {};
    const double target = u * lamps_[count - 1].power_until;
    const auto first_above = std::upper_bound(lamps_.begin(), lamps_.begin() + static_cast<std::ptrdiff_t>(count), target,
                                              [](double power, const Lamp& lamp) { return power < lamp.power_until; });
    const auto chosen = static_cast<std::size_t>(first_above - lamps_.begin());
    if (chosen == count) return {};  // u times the sum was rounded up to it
    return chosen;
}

std::optional<LampSample> Lamps::sample(const Vec3f& point, Rng& rng) const {
    const auto chosen = choose(lamps_.size(), rng.uniform());
    if (!chosen) return {};
    const double probability = power(*chosen) / lamps_.back().power_until;
    if (*chosen < triangle_count_) return sample_triangle(lamps_[*chosen], probability, point, rng);
    auto sample = sizeless(*chosen - triangle_count_, point);
    if (sample) sample->light = static_cast<float>(1 / probability) * sample->light;
    return sample;
}

std::optional<LampSample> Lamps::sample_triangle(const Vec3f& point, Rng& rng) const {
    const auto chosen = choose(triangle_count_, rng.uniform());
    if (!chosen) return {};
    return sample_triangle(lamps_[*chosen], power(*chosen) / lamps_[triangle_count_ - 1].power_until, point, rng);
}

std::optional<LampSample> Lamps::sample_triangle(const Lamp& lamp, double probability, const Vec3f& point, Rng& rng) const {
    const Surface& surface = scene_.surfaces[lamp.index];
    const auto [a, b, c] = triangle_of(surface.mesh, lamp.primitive_id);
    const double u = rng.uniform(), v = rng.uniform();
    const Vec3d normal = cross(to_double(b) - to_double(a), to_double(c) - to_double(a));
    const bool front = dot(normal, to_double(point) - to_double(a)) > 0;
    const Material& material = scene_.materials[surface.material_id];
    GnomonDirectionSample sample;
    if ((!front && !material.is_double_sided) ||
        gnomon_sample_triangle(point.data(), a.data(), b.data(), c.data(), u, v, &sample) != GNOMON_OK ||
        !(sample.density_per_sr > 0))
        return {};
    const double density = probability * sample.density_per_sr;
    return LampSample{to_double(sample.direction),
                      static_cast<float>(1 / density) * material.emission_nt,
                      density,
                      {},
                      lamp.index,
                      lamp.primitive_id};
}

std::optional<LampSample> Lamps::sizeless(std::size_t index, const Vec3f& point) const {
    const Lamp& lamp = lamps_[triangle_count_ + index];
    if (lamp.kind == Kind::point) {
        const PointLight& light = scene_.point_lights[lamp.index];
        return from_position(light.position, light.intensity_cd, light.range_m, point, [](const Vec3d&) { return 1.0; });
    }
    if (lamp.kind == Kind::spot) {
        const SpotLight& light = scene_.spot_lights[lamp.index];
        return from_position(light.position, light.intensity_cd, light.range_m, point,
                             [&](const Vec3d& direction) { return spot_attenuation(light, direction); });
    }
    const DirectionalLight& light = scene_.directional_lights[lamp.index];
    return LampSample{-normalized(to_double(light.direction)), light.illuminance_lx, infinity, {}};
}

double Lamps::density_per_sr(const Vec3f& point, std::uint32_t geometry_id, std::uint32_t primitive_id) const {
    const std::size_t first = first_of_surface_[geometry_id];
    if (first >= lamps_.size()) return 0;
    const auto [a, b, c] = triangle_of(scene_.surfaces[geometry_id].mesh, primitive_id);
    const double probability = power(first + primitive_id) / lamps_.back().power_until;
    const double solid_angle_sr = gnomon_triangle_solid_angle_sr(point.data(), a.data(), b.data(), c.data());
    return solid_angle_sr > 0 ? probability / solid_angle_sr : 0;
}

}  // namespace render
