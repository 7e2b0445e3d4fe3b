// To be deleted: stands in for the radiometry of gnomon.h.
#pragma once
#include <algorithm>
#include <cmath>
#include <numbers>

#include "gnomon.h"
#include "rays/vector.hpp"

typedef struct GnomonDirectionSample {
    float direction[3];
    float density_per_sr;
} GnomonDirectionSample;

namespace standin {
using namespace harness;
inline Vec3d p3(const float* a) { return {a[0], a[1], a[2]}; }
inline void frame(const Vec3d& n, Vec3d& t, Vec3d& b) {
    const double s = std::copysign(1.0, n[2]), a = -1 / (s + n[2]), c = n[0] * n[1] * a;
    t = {1 + s * n[0] * n[0] * a, s * c, -s * n[0]};
    b = {c, s + n[1] * n[1] * a, -n[1]};
}
}  // namespace standin

inline double gnomon_triangle_solid_angle_sr(const float point[3], const float a[3], const float b[3], const float c[3]) {
    using namespace standin;
    const Vec3d p = p3(point), x = p3(a) - p, y = p3(b) - p, z = p3(c) - p;
    const double lx = length(x), ly = length(y), lz = length(z);
    return std::abs(2 * std::atan2(dot(x, cross(y, z)), lx * ly * lz + dot(x, y) * lz + dot(y, z) * lx + dot(x, z) * ly));
}
inline GnomonStatus gnomon_sample_cosine_hemisphere(const float normal[3], double u, double v, GnomonDirectionSample* out) {
    using namespace standin;
    const Vec3d n = p3(normal);
    Vec3d t, b;
    frame(n, t, b);
    const double r = std::sqrt(u), phi = 2 * std::numbers::pi * v, z = std::sqrt(1 - u);
    const Vec3d d = r * std::cos(phi) * t + r * std::sin(phi) * b + z * n;
    for (int i = 0; i < 3; ++i) out->direction[i] = float(d[i]);
    out->density_per_sr = float(z / std::numbers::pi);
    return GNOMON_OK;
}
inline GnomonStatus gnomon_sample_triangle(const float point[3], const float pa[3], const float pb[3], const float pc[3],
                                           double u, double v, GnomonDirectionSample* out) {
    using namespace standin;
    const double sr = gnomon_triangle_solid_angle_sr(point, pa, pb, pc);
    const Vec3d r0 = p3(pa) - p3(point), r1 = p3(pb) - p3(point), r2 = p3(pc) - p3(point);
    const Vec3d a = normalized(r0), b = normalized(r1), c = normalized(r2);
    *out = {{float(a[0]), float(a[1]), float(a[2])}, 0};
    if (!(sr > 0)) return GNOMON_OK;
    const double volume = std::abs(dot(r0, cross(r1 - r0, r2 - r0))) / (length(r0) * length(r1) * length(r2));
    const double s = std::sin(0.5 * u * sr), k = std::cos(0.5 * u * sr);
    const Vec3d offset = (volume * k - (dot(a, c) + dot(b, c)) * s) * a + ((1 + dot(a, b)) * s) * c;
    const Vec3d middle = length(offset) > 0 ? normalized(offset) : a;
    const Vec3d moved = 2 * dot(a, middle) * middle - a;
    const double height = 0.5 * dot(b - moved, b - moved), share = std::sqrt(v * (2 - v * height) / (2 - height));
    const Vec3d d = normalized(b + share * (moved - b) + (height * (share - v)) * b);
    for (int i = 0; i < 3; ++i) out->direction[i] = float(d[i]);
    out->density_per_sr = float(1 / sr);
    return GNOMON_OK;
}
inline double gnomon_spot_attenuation(double angle, double inner, double outer) {
    const double scale = 1 / std::max(0.001, std::cos(inner) - std::cos(outer));
    const double a = std::clamp((std::cos(angle) - std::cos(outer)) * scale, 0.0, 1.0);
    return a * a;
}
inline double gnomon_range_attenuation(double d, double range) {
    return range == 0 || std::isinf(range) ? 1 : std::clamp(1 - std::pow(d / range, 4), 0.0, 1.0);
}
inline double gnomon_isotropic_flux_lm(double intensity) { return 4 * std::numbers::pi * intensity; }
inline double gnomon_lambertian_exitance_lx(double luminance) { return std::numbers::pi * luminance; }
inline GnomonStatus gnomon_spot_flux_lm(double intensity, double inner, double outer, double* out) {
    *out = 2 * std::numbers::pi * intensity * (1 - (std::cos(inner) + 2 * std::cos(outer)) / 3);
    return GNOMON_OK;
}
