#include "oracle/filter.hpp"

#include <algorithm>

namespace harness {
namespace {

constexpr double f32_roundoff = 0x1p-24;
constexpr double f64_roundoff = 0x1p-53;
constexpr double f32_least = 0x1p-149;

// Covers the roundings made while a bound itself is computed: fewer than 100 of relative size 2^-53.
constexpr double bound_slack = 1.0 + 1e-12;

/// X (or Y) of one vertex.
struct Sheared {
    double value;      // rounded in double
    double magnitude;  // |ax*dz| + |dx*az|
    double band;       // bounds both |exact X - dz*x'| and |exact X - value|, with x' the f32 coordinate
};

// Rounding in double. All inputs are floats, so |ax| and |dz| lie between 2^-149 and 2^129 or are 0, and products of four of
// them neither overflow nor underflow in double: every operation has a relative error of at most e = 2^-53. Each of the two
// products in X passes three operations (a difference, the product, the last difference), so
//     |value - X| <= ((1+e)^3 - 1) * magnitude < 4e * magnitude.
//
// The band. With u = 2^-24 the f32 code computes
//     S = fl(dx/dz),   x' = fl(fl(Vx-ox) - fl(S * fl(Vz-oz))),
// and decides by the exact sign of the edge function of these x', y'. Let x = X/dz = ax - (dx/dz)*az. Then ax passes two
// roundings and (dx/dz)*az passes four (the quotient, the difference, the product, the last difference). Differences of floats
// never underflow; the quotient and the product may, by at most 2^-150 each, the quotient's being multiplied by az. So
//     |x' - x| <= (2u|ax| + 4u|dx/dz||az|) * (1 + 4u) + 2^-149 * (|az| + 1),
// which times |dz| is the bound below; 8u in place of 4u leaves room for the product terms.
// A direction that is scaled by a power of two first, to max |d| in [1, 2), adds 2^-150 |az| for a component that
// underflows there; the doubled last term covers it.
Sheared shear(double a, double az, double d, double dz) {
    const double across = std::abs(a * dz);
    const double along = std::abs(d * az);
    const double f32_error =
        (2 * across + 4 * along) * f32_roundoff * (1 + 8 * f32_roundoff) + 2 * f32_least * (std::abs(az) + 1) * std::abs(dz);
    const double magnitude = across + along;
    return {a * dz - d * az, magnitude, (f32_error + 4 * f64_roundoff * magnitude) * bound_slack};
}

/// X (axis 0) or Y (axis 1) of the three vertices.
using ShearedAxis = std::array<Sheared, 3>;

ShearedAxis shear(const RayFrame& ray, const Triangle& triangle, std::size_t axis) {
    const auto sheared = [&](const Vec3f& vertex) {
        return shear(static_cast<double>(vertex[axis]) - ray.origin[axis], static_cast<double>(vertex[2]) - ray.origin[2],
                     ray.direction[axis], ray.direction[2]);
    };
    return {sheared(triangle[0]), sheared(triangle[1]), sheared(triangle[2])};
}

/// All three on one side of the line, in the exact and in the f32 coordinates.
bool all_beside(const ShearedAxis& axis) {
    return std::all_of(axis.begin(), axis.end(), [](const Sheared& s) { return s.value > s.band; }) ||
           std::all_of(axis.begin(), axis.end(), [](const Sheared& s) { return s.value < -s.band; });
}

/// How far p*q moves when p and q move by their bands.
double product_band(const Sheared& p, const Sheared& q) {
    return p.band * std::abs(q.value) + q.band * std::abs(p.value) + p.band * q.band;
}

// x[p]*y[q] - y[p]*x[q]. Each monomial of the four floats passes three operations in either factor, the product and the
// difference: |value - exact| <= ((1+e)^8 - 1) * (sum of products of magnitudes); twice 8e covers the roundings of the
// magnitudes.
EdgeEstimate edge(const ShearedAxis& x, const ShearedAxis& y, std::size_t p, std::size_t q) {
    const double permanent = x[p].magnitude * y[q].magnitude + y[p].magnitude * x[q].magnitude;
    return {x[p].value * y[q].value - y[p].value * x[q].value, 16 * f64_roundoff * permanent,
            (product_band(x[p], y[q]) + product_band(y[p], x[q])) * bound_slack};
}

bool signs_may_agree(const std::array<EdgeEstimate, 3>& edges) {
    const auto surely = [&](int sign) {
        return std::any_of(edges.begin(), edges.end(), [&](const EdgeEstimate& e) { return !e.in_band() && e.sign() == sign; });
    };
    return !(surely(1) && surely(-1));
}

}  // namespace

std::optional<std::array<EdgeEstimate, 3>> estimate_edges(const RayFrame& ray, const Triangle& triangle) {
    const ShearedAxis x = shear(ray, triangle, 0);
    if (all_beside(x)) return std::nullopt;
    const ShearedAxis y = shear(ray, triangle, 1);
    if (all_beside(y)) return std::nullopt;
    const std::array<EdgeEstimate, 3> edges{edge(x, y, 2, 1), edge(x, y, 0, 2), edge(x, y, 1, 0)};
    if (!signs_may_agree(edges)) return std::nullopt;
    return edges;
}

}  // namespace harness
