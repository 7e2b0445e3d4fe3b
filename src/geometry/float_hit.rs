//! FAST's hits: what they are made of is a few operations on floats, the same for one triangle as for eight.

use super::TriangleRay;
use crate::simd::Floats;

/// `[t, u, v]`; `t` from the triangle's plane or from the weights, whichever is off by less. In roundings, times the distance from the
/// origin and over the weights' sum, the first is off by the length of the normal, the second by the range of depths
/// times the size of the triangle as the ray sees it: where that is small beside the normal, weights are better.
/// Weights alone make long triangles seen at an angle hit the rays that leave them.
///
/// In the order of the ray's axes: the [edges] of the triangle, and the first vertex from the origin; `weights` and `z` of the sheared
/// triangle, as in `triangle_hit.rs`.
#[inline(always)]
pub(crate) fn in_floats<F: Floats>(
    floats: F,
    ray: &TriangleRay,
    [x, y, depth]: [[F::Vector; 2]; 3],
    first: [F::Vector; 3],
    &[a, b, c]: &[F::Vector; 3],
    z: &[F::Vector; 3],
) -> [F::Vector; 3] {
    let per_sum = floats.div(floats.splat(1.0), floats.add(floats.add(a, b), c));
    let (u, v) = (floats.mul(b, per_sum), floats.mul(c, per_sum));
    let normal = [across(floats, y, depth), across(floats, depth, x), across(floats, x, y)];
    let distance = along(floats, &normal, first);
    let [dx, dy, dz, _] = ray.direction;
    let [dx, dy, dz] = [floats.splat(dx), floats.splat(dy), floats.splat(dz)];
    // Measured: from 1 on CAD loses rays' origins, at 0 scans have twice the error.
    const SHARE: f32 = 0.25;
    let (width, height) = (largest(floats, x), largest(floats, y));
    let (size, depth_range) = (floats.max(width, height), largest(floats, depth));
    let length = floats.add(floats.add(floats.abs(normal[0]), floats.abs(normal[1])), floats.abs(normal[2]));
    let by_plane = floats.less(floats.mul(floats.splat(SHARE), length), floats.mul(depth_range, size));
    let of_plane = floats.mul(floats.div(distance, along(floats, &normal, [dx, dy, dz])), dz);
    let of_weights = floats.add(z[0], floats.add(floats.mul(u, depth[0]), floats.mul(v, depth[1])));
    let between = floats.blend(of_weights, of_plane, by_plane);
    // Rounding does not lead out of the triangle, or its box could be passed over. This makes a number of a NaN.
    let least = floats.min(floats.min(z[0], z[1]), z[2]);
    let most = floats.max(floats.max(z[0], z[1]), z[2]);
    let between = floats.min(floats.max(between, least), most);
    // Adding 0 makes 0 of -0.
    let t = floats.add(floats.div(between, dz), floats.splat(0.0));
    [t, u, v]
}

/// One coordinate of the edges from the first vertex to the others.
#[inline(always)]
pub(crate) fn edges<F: Floats>(floats: F, &[a, b, c]: &[F::Vector; 3]) -> [F::Vector; 2] {
    [floats.sub(b, a), floats.sub(c, a)]
}

/// A component of the cross product of two edges.
#[inline(always)]
fn across<F: Floats>(floats: F, [a, d]: [F::Vector; 2], [c, b]: [F::Vector; 2]) -> F::Vector {
    floats.sub(floats.mul(a, b), floats.mul(c, d))
}

#[inline(always)]
fn along<F: Floats>(floats: F, normal: &[F::Vector; 3], [x, y, z]: [F::Vector; 3]) -> F::Vector {
    floats.add(floats.add(floats.mul(normal[0], x), floats.mul(normal[1], y)), floats.mul(normal[2], z))
}

#[inline(always)]
fn largest<F: Floats>(floats: F, [a, b]: [F::Vector; 2]) -> F::Vector {
    floats.max(floats.abs(a), floats.abs(b))
}
