// What a surface does with light: diffuse, a mirror, or smooth glass.
//
// All weights are for basic radiance, L / n^2, which refraction leaves as it is (Nicodemus 1963, "Radiance"): so glass that is
// open or inside out gives no light away, and a lamp's nits are those that it has in air.
#pragma once

#include "harness/rng.hpp"
#include "render/render_scene.hpp"

namespace render {

/// Where a ray goes on.
struct Scatter {
    Vec3d direction;        // of unit length
    int side;               // of the surface that the direction leads to: 1 the normal's, -1 the other
    Rgb weight;             // of what comes back from there; no channel above 1
    double density_per_sr;  // with which the direction was chosen; INFINITY where no other was possible
};

/// A random direction, chosen as the material prefers. `towards`: the ray's direction, of unit length; `normal` the triangle's;
/// `side` that the ray came from. The normal's side of glass is air.
Scatter sample_material(const Material& material, const Rgb& base_color, const Vec3d& towards, const Vec3d& normal, int side,
                        harness::Rng& rng);

/// Both ways on at glass.
struct GlassWays {
    double reflectance;  // of the reflected one; the refracted one has the rest, and no meaning where that is nothing
    Vec3d reflected, refracted;
};
GlassWays glass_ways(double index_of_refraction, const Vec3d& towards, const Vec3d& normal, int side);

/// The share of unpolarised light that a smooth boundary reflects; the rest passes (Fresnel; Born and Wolf, "Principles of
/// Optics", 1.5.2). `cosine` of the angle of incidence, in [0, 1]; `relative_index`: the far side's over the near one's. 1 for
/// total reflection.
double fresnel_reflectance(double cosine, double relative_index);

Vec3d reflected(const Vec3d& towards, const Vec3d& normal);

}  // namespace render
