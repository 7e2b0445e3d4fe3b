#include "oracle/exact.hpp"

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <limits>

namespace harness {
namespace {

using Vec3z = std::array<mpz_class, 3>;

/// A power of two, as its exponent, that all the numbers are multiples of.
int unit_exponent(std::initializer_list<Vec3f> points) {
    constexpr int significand_bits = 24;
    constexpr int least_exponent = -149;  // of the least denormal
    int exponent = std::numeric_limits<int>::max();
    for (const Vec3f& point : points)
        for (float x : point)
            if (x != 0) exponent = std::min(exponent, std::max(std::ilogb(x) - (significand_bits - 1), least_exponent));
    return exponent == std::numeric_limits<int>::max() ? 0 : exponent;
}

/// The coordinates in units of 2^unit_exponent: integers below 2^277, exact in double.
Vec3z in_units(const Vec3f& point, int unit_exponent) {
    const auto integer = [&](float x) { return mpz_class(std::ldexp(static_cast<double>(x), -unit_exponent)); };
    return {integer(point[0]), integer(point[1]), integer(point[2])};
}

Vec3z difference(const Vec3z& a, const Vec3z& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }

mpq_class quotient(const mpz_class& numerator, const mpz_class& denominator) {
    mpq_class value(numerator, denominator);
    value.canonicalize();
    return value;
}

}  // namespace

ExactPair::ExactPair(const RayFrame& ray, const Triangle& triangle) {
    const int position_unit = unit_exponent({ray.origin, triangle[0], triangle[1], triangle[2]});
    const int direction_unit = unit_exponent({ray.direction});
    const Vec3z origin = in_units(ray.origin, position_unit);
    const Vec3z direction = in_units(ray.direction, direction_unit);
    std::array<mpz_class, 3> x, y;
    for (std::size_t i = 0; i < 3; ++i) {
        const Vec3z a = difference(in_units(triangle[i], position_unit), origin);
        x[i] = a[0] * direction[2] - direction[0] * a[2];
        y[i] = a[1] * direction[2] - direction[1] * a[2];
        depths_[i] = a[2];
    }
    edges_ = {x[2] * y[1] - y[2] * x[1], x[0] * y[2] - y[0] * x[2], x[1] * y[0] - y[1] * x[0]};
    direction_z_ = direction[2];
    t_exponent_ = position_unit - direction_unit;
    determinant_ = edges_[0] + edges_[1] + edges_[2];
}

std::array<int, 3> ExactPair::edge_signs() const { return {sgn(edges_[0]), sgn(edges_[1]), sgn(edges_[2])}; }

std::optional<mpq_class> ExactPair::plane_t() const {
    if (determinant_ == 0) return std::nullopt;
    mpz_class numerator = edges_[0] * depths_[0] + edges_[1] * depths_[1] + edges_[2] * depths_[2];
    mpz_class denominator = direction_z_ * determinant_;
    if (t_exponent_ >= 0) {
        numerator <<= t_exponent_;
    } else {
        denominator <<= -t_exponent_;
    }
    return quotient(numerator, denominator);
}

std::optional<PlanePoint> ExactPair::plane_point() const {
    const auto t = plane_t();
    if (!t) return std::nullopt;
    return PlanePoint{*t, quotient(edges_[1], determinant_), quotient(edges_[2], determinant_)};
}

bool is_hit(const std::array<int, 3>& edge_signs) {
    const auto [least, greatest] = std::minmax_element(edge_signs.begin(), edge_signs.end());
    return (*least >= 0 && *greatest > 0) || (*greatest <= 0 && *least < 0);
}

bool has_zero_area(const Triangle& triangle) {
    const int unit = unit_exponent({triangle[0], triangle[1], triangle[2]});
    const Vec3z a = in_units(triangle[0], unit);
    const Vec3z b = difference(in_units(triangle[1], unit), a);
    const Vec3z c = difference(in_units(triangle[2], unit), a);
    return b[1] * c[2] == b[2] * c[1] && b[2] * c[0] == b[0] * c[2] && b[0] * c[1] == b[1] * c[0];
}

}  // namespace harness
