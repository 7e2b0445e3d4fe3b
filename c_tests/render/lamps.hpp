// All that shines and has a place or a direction of its own: triangles that emit, point, spot and directional lights.
//
// The environment is none of them: it is the same from everywhere, so that no choice of directions can be better than the
// material's own.
#pragma once

#include <optional>
#include <vector>

#include "gnomon.h"
#include "harness/rng.hpp"
#include "render/render_scene.hpp"

namespace render {

/// What arrives from a lamp if nothing is in the way.
struct LampSample {
    Vec3d direction;  // to the lamp, of unit length
    /// Of one direction of a triangle: its luminance over the density. Of other lamps: the illuminance where the light falls
    /// straight, in lx. Both over the probability of the choice of the lamp.
    Rgb light;
    double density_per_sr;     // with the choice of the lamp in it; INFINITY for lamps without a size
    std::optional<Vec3f> end;  // of the way: where the lamp is; nothing for a triangle, which has to be hit, and the distance
    std::uint32_t geometry_id = GNOMON_INVALID_ID, primitive_id = GNOMON_INVALID_ID;  // of the triangle
};

class Lamps {
public:
    /// `radius_m` of the scene, to compare directional lights with others. The scene must outlive it.
    Lamps(const RenderScene& scene, double radius_m);

    /// A lamp chosen by power, and a direction to it; nothing where that lamp does not reach the point or there is none.
    std::optional<LampSample> sample(const Vec3f& point, harness::Rng& rng) const;

    /// As `sample`, of triangles alone.
    std::optional<LampSample> sample_triangle(const Vec3f& point, harness::Rng& rng) const;

    /// Of each lamp that has no size, with nothing to chance.
    std::size_t sizeless_count() const { return lamps_.size() - triangle_count_; }
    std::optional<LampSample> sizeless(std::size_t index, const Vec3f& point) const;

    /// With which `sample` gives any direction that meets a triangle: what multiple importance sampling weighs. 0 for triangles
    /// that it does not give: they emit nothing, or are so small that their solid angle is rounded to 0.
    double density_per_sr(const Vec3f& point, std::uint32_t geometry_id, std::uint32_t primitive_id) const;

private:
    enum class Kind { triangle, point, spot, directional };
    struct Lamp {
        Kind kind;
        std::uint32_t index;         // among its kind; of a triangle the surface
        std::uint32_t primitive_id;  // of a triangle
        double power_until;          // of this lamp and all before it, in lm
    };

    void add(Kind kind, std::size_t index, std::size_t primitive_id, double power);
    void add_triangles(const RenderScene& scene);
    std::optional<std::size_t> choose(std::size_t count, double u) const;
    double power(std::size_t lamp) const;
    std::optional<LampSample> sample_triangle(const Lamp& lamp, double probability, const Vec3f& point, harness::Rng& rng) const;

    const RenderScene& scene_;
    std::vector<Lamp> lamps_;  // triangles first
    std::size_t triangle_count_ = 0;
    std::vector<std::size_t> first_of_surface_;  // lamps_.size() for those that do not emit
};

/// What a triangle emits, in nt, to a side of it: 1 the normal's, -1 the other.
Rgb emitted(const Material& material, int side);

}  // namespace render
