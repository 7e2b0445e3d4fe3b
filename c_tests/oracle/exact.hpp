// One ray and one triangle in exact arithmetic.
//
// For each vertex V let a = V - origin and project along the ray, without a division:
//     X = ax*dz - dx*az,   Y = ay*dz - dy*az.
// The edge functions, each the weight of the vertex opposite to its edge, are
//     U = Cx*By - Cy*Bx,   V = Ax*Cy - Ay*Cx,   W = Bx*Ay - By*Ax.
// The closed triangle is hit iff all are >= 0 or all are <= 0, and not all are 0: then U + V + W, twice the projected area, is
// not 0 either. A triangle without area and one in a plane with the ray project onto a line, U + V + W = 0, and are never hit.
#pragma once

#include <gmpxx.h>

#include <array>
#include <optional>

#include "oracle/ray_frame.hpp"

namespace harness {

/// Where the line meets the plane of the triangle: origin + t * direction = (1-u-v)*A + u*B + v*C.
struct PlanePoint {
    mpq_class t, u, v;
};

/// The edge functions and depths of one pair, as integers: positions and directions in units of a power of two each.
class ExactPair {
public:
    /// The triangle has finite vertices, in the ray's frame.
    ExactPair(const RayFrame& ray, const Triangle& triangle);

    /// Signs of U, V, W: -1, 0 or 1.
    std::array<int, 3> edge_signs() const;

    /// PlanePoint's t alone. Nothing where the ray is parallel to the plane or the triangle has no area.
    std::optional<mpq_class> plane_t() const;
    std::optional<PlanePoint> plane_point() const;

private:
    std::array<mpz_class, 3> edges_, depths_;
    mpz_class direction_z_, determinant_;
    int t_exponent_;  // depths_ / direction_z_ counts in 2^t_exponent_
};

bool is_hit(const std::array<int, 3>& edge_signs);

/// (B - A) x (C - A) = 0, exactly.
bool has_zero_area(const Triangle& triangle);

}  // namespace harness
