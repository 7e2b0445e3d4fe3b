//! Where a ray meets a triangle: watertight decisions in `f32`, and `t`, `u`, `v` to half an ulp.
//!
//! The decision is Woop's (Woop, Benthin, Wald 2013, "Watertight ray/triangle intersection"): the vertices, relative
//! to the origin, are sheared so that the ray becomes an axis; the ray hits where the three edge functions of the
//! remaining two coordinates agree in sign. A vertex is sheared the same way for every triangle that has it, and the
//! signs of the edge functions of the sheared coordinates are exact, so that neighbours agree about the edge between
//! them: nothing slips through.
//!
//! What is inexact is the shear. With `u = 2^-24`, `z` the axis of the largest direction component, `a` the vertex
//! minus the origin, and `|dx / dz| <= 1`, the sheared `x = ax - (dx / dz) az` is off by at most `2u |ax| + 4u |az|`
//! (one rounding of the result, one of each difference, and of the quotient and the product) plus `3 * 2^-149` where
//! something underflows. That is the band: a triangle
//! that the ray passes at less than this distance may be taken for hit, its neighbour then is refused. One that ends behind the origin
//! along an axis is refused all the same.

use std::ops::{Mul, Neg, Sub};

use glam::{Vec4, Vec4Swizzles};

use super::evaluation::Evaluation;
use super::{BEHIND, Ray, Triangle};
use crate::math::{DoubleDouble, UNIT_ROUNDOFF, rounds_alike, widen};
use crate::simd::{Floats, One, Scalar, Simd};

/// What a triangle test found. `t` is finite.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct TriangleHit {
    pub(crate) t: f32,
    pub(crate) u: f32,
    pub(crate) v: f32,
}

/// A ray made ready for triangle tests, in the order of [`TriangleRay::axes`]. Aligned, so that none of its vectors crosses a cache
/// line.
#[derive(Clone, Copy, Debug)]
#[repr(align(16))]
pub(crate) struct TriangleRay {
    /// 0 in the fourth lane.
    pub(crate) origin: [f32; 4],
    /// 1 in the fourth lane.
    pub(crate) direction: [f32; 4],
    /// x, y and z of the sheared space, as axes of the scene's: z is the one along which the direction is the longest.
    pub(crate) axes: [usize; 3],
    /// `direction / dz`: how far the shear moves a point for each unit of z; and `1 / dz`.
    pub(crate) per_z: [f32; 4],
}

/// The coordinates of a triangle's vertices, axis by axis in the order of [`TriangleRay::axes`].
pub(crate) type Corners = [[f32; 3]; 3];

/// Edge functions: the weights of the three vertices, up to a common factor.
type Weights<T> = [T; 3];

/// The values of `t` that still count.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Interval {
    pub(crate) t_min: f32,
    pub(crate) t_max: f32,
}

impl Interval {
    pub(crate) fn contains(&self, t: f32) -> bool {
        self.t_min <= t && t <= self.t_max
    }

    /// Whether everything within `error` of `t` rounds to a float outside.
    #[inline(always)]
    fn excludes(&self, t: f64, error: f64) -> bool {
        // At least the distance to the next float.
        let spacing = |bound: f64| bound.abs() * f64::from(f32::EPSILON) + f64::from(f32::from_bits(1));
        let (t_min, t_max) = (f64::from(self.t_min), f64::from(self.t_max));
        t + error < t_min - spacing(t_min) || t - error > t_max + spacing(t_max)
    }
}

/// How triangles are accepted, and `t`, `u` and `v` of those computed.
pub(crate) trait PrecisionMode {
    /// Whether it is the ray itself that decides, not its sheared coordinates in `f32`: these then refuse or accept only what
    /// their rounding leaves no doubt about.
    const IS_EXACT: bool;
    /// Whether hits can be evaluated several at once.
    const HAS_LANES: bool;
    /// Whether `t` is where the weights lead to, not only somewhere between those of the vertices.
    const FOLLOWS_WEIGHTS: bool;

    /// The hit of a triangle about which `f32` did not decide. One outside the interval may be given or not: the caller
    /// looks.
    fn settle(
        ray: &TriangleRay,
        triangle: &Triangle,
        x: &[f32; 3],
        y: &[f32; 3],
        interval: Interval,
    ) -> Option<TriangleHit>;

    /// The hit of a triangle whose `f32` edge functions have one sign, none zero, where those are all that it takes.
    #[inline(always)]
    fn evaluate_sheared(
        _ray: &TriangleRay,
        _corners: &Corners,
        _sheared: &Weights<f32>,
        _z: &[f32; 3],
    ) -> Option<TriangleHit> {
        None
    }

    /// Whether [`PrecisionMode::evaluate_certain`] is [`in_floats`].
    const IS_IN_FLOATS: bool;

    /// For such a triangle what the answer is made of, where that does not need more.
    fn evaluate_certain<S: Simd>(simd: S, ray: &TriangleRay, corners: &Corners, t_min: f32) -> Option<Evaluation>;
}

/// From the coordinates that decided, in `f32`: off by as much as those are.
pub(crate) struct Fast;

/// From the ray and the triangle themselves, in `f64` or, where that is not provably enough, in twice its precision.
pub(crate) struct Accurate;

/// Decided as if all were computed without rounding, `t` rounded once; `u` and `v` as [`Accurate`].
pub(crate) struct Exact;

impl TriangleRay {
    /// Expects a valid ray.
    #[inline(always)]
    pub(crate) fn new(ray: &Ray) -> Self {
        // Four lanes at a time, and one store for each: a load that is wider than the stores before it waits for them.
        let (origin, direction) = (ray.origin.extend(0.0), ray.direction.extend(1.0));
        // Of equal components the first is taken, so that the choice is the same everywhere.
        let magnitude = direction.abs();
        let largest = magnitude.max(magnitude.yzxw()).max(magnitude.zxyw()).xxxx();
        let (is_x, is_y) = (magnitude.xxxx().cmpeq(largest), magnitude.yyyy().cmpeq(largest));
        let in_order = |v: Vec4| Vec4::select(is_x, v.yzxw(), Vec4::select(is_y, v.zxyw(), v));
        let (origin, direction) = (in_order(origin), in_order(direction));
        let kz = magnitude.cmpeq(largest).bitmask().trailing_zeros() as usize % 4;
        // Two bits for each axis: the next one, and the one after that.
        let (kx, ky) = (0b00_10_01 >> (2 * kz) & 3, 0b01_00_10 >> (2 * kz) & 3);
        let per_z = direction / direction.zzzz();
        Self { origin: origin.to_array(), direction: direction.to_array(), axes: [kx, ky, kz], per_z: per_z.to_array() }
    }

    /// The closed triangle against the closed interval of the line.
    #[inline(always)]
    pub(crate) fn hit<P: PrecisionMode>(&self, triangle: &Triangle, interval: Interval) -> Option<TriangleHit> {
        let corners = self.corners(triangle);
        let (x, y, z) = self.shear(&corners);

        // Rounding keeps order, so the difference of two rounded products never has the wrong sign: it can only be
        // zero, or NaN where both overflowed. A nonzero sign settles it here; the rest is settled in f64, where these
        // products are exact.
        let edges = edge_functions(&x, &y);
        let doubt = if P::IS_EXACT { edge_doubt(&x, &y, &z) } else { 0.0 };
        let (any_negative, any_positive) = signs_beyond(&edges, doubt);
        if any_negative && any_positive {
            return None;
        }
        if edges.iter().all(|edge| *edge != 0.0)
            && let Some(hit) = P::evaluate_sheared(self, &corners, &edges, &z)
        {
            return Some(hit).filter(|hit| interval.contains(hit.t) && !self.ends_behind(hit, &corners));
        }
        // A hit's t lies between those of its vertices.
        let is_behind = z.iter().all(|z| z / self.direction[2] < 0.0);
        if is_behind && interval.t_min >= 0.0 {
            return None;
        }
        P::settle(self, triangle, &x, &y, interval).filter(|hit| interval.contains(hit.t) && hit.t.is_finite())
    }

    /// [`TriangleRay::hit`] for a triangle whose `f32` edge functions have one sign, none zero, and of which
    /// [`PrecisionMode::evaluate_certain`] gave an [`Evaluation::Near`].
    pub(crate) fn hit_near<P: PrecisionMode>(
        &self,
        triangle: &Triangle,
        (hit, t, t_error): (TriangleHit, f64, f64),
        interval: Interval,
    ) -> Option<TriangleHit> {
        if interval.excludes(t, t_error) {
            return None;
        }
        match self.hit_across::<P>(hit, &self.corners(triangle)) {
            Some(hit) => interval.contains(hit.t).then_some(hit),
            None => self.hit::<P>(triangle, interval),
        }
    }

    /// An [`Evaluation::Near`] of a triangle that lies across an axis, as floors and walls do: the plane gives `t`, two roundings off,
    /// however near to 0. Its sign is that of the exact one, so that [what ends behind the origin](BEHIND) is not hit.
    fn hit_across<P: PrecisionMode>(&self, hit: TriangleHit, corners: &Corners) -> Option<TriangleHit> {
        for (axis, &[a, b, c]) in corners.iter().enumerate() {
            let (origin, direction) = (widen(self.origin[axis]), widen(self.direction[axis]));
            // By their bits: a host may read denormal ones as 0.
            if a.to_bits() == b.to_bits() && b.to_bits() == c.to_bits() && direction != 0.0 {
                let t = (widen(a) - origin) / direction;
                let is_known = !P::IS_EXACT || t == 0.0 || rounds_alike(t, 2.0 * f64::EPSILON * t.abs());
                // Adding 0 makes 0 of -0.
                return is_known.then_some(TriangleHit { t: t as f32 + 0.0, ..hit });
            }
        }
        None
    }

    /// The weights that decide in `f32`, where they take the triangle for hit: each rounded once.
    #[cold]
    pub(super) fn deciding_weights(&self, triangle: &Triangle) -> Option<[f64; 3]> {
        let (x, y, _) = self.shear(&self.corners(triangle));
        sheared_weights(&x, &y).filter(|weights| weights.iter().sum::<f64>().is_finite())
    }

    /// Whether a hit at 0 or after is that of a triangle that ends behind the origin along some axis (see [`BEHIND`]). The ray
    /// leaves it behind, and begins within the band of it.
    ///
    /// A point `Q` of the triangle was sheared onto the ray. Along that axis it is `|Qa|` behind the origin, and where the ray is then
    /// `|slope Qz|` ahead; together no more than the band, `2u |Qa| + 4u |slope| max |az|`. So both are as small as that.
    #[inline(always)]
    fn ends_behind(&self, hit: &TriangleHit, corners: &Corners) -> bool {
        hit.t >= 0.0
            && (self.ends_behind_along(corners, 0)
                || self.ends_behind_along(corners, 1)
                || self.ends_behind_along(corners, 2))
    }

    #[inline(always)]
    fn ends_behind_along(&self, corners: &Corners, axis: usize) -> bool {
        let (origin, direction) = (self.origin[axis], self.direction[axis]);
        let [a, b, c] = corners[axis];
        let are_behind = if direction < 0.0 {
            (a > origin) & (b > origin) & (c > origin)
        } else {
            (a < origin) & (b < origin) & (c < origin)
        };
        // Few are, so that few wait for the division. Of a zero direction component the inverse is infinite: the ray does not leave.
        are_behind && {
            let inverse = 1.0 / direction;
            let (a, b, c) = ((a - origin) * inverse, (b - origin) * inverse, (c - origin) * inverse);
            inverse.is_finite() & (a < BEHIND) & (b < BEHIND) & (c < BEHIND)
        }
    }

    /// One of its vectors as the scene has it.
    pub(super) fn in_scene(&self, vector: &[f32; 4]) -> [f32; 3] {
        let mut of_scene = [0.0; 3];
        for (value, axis) in vector.iter().zip(self.axes) {
            of_scene[axis] = *value;
        }
        of_scene
    }

    /// Relative to the origin, so that the ray is the axis of z.
    #[inline(always)]
    fn shear(&self, corners: &Corners) -> ([f32; 3], [f32; 3], [f32; 3]) {
        let from_origin = |[a, b, c]: [f32; 3], origin: f32| [a - origin, b - origin, c - origin];
        let z = from_origin(corners[2], self.origin[2]);
        let shear = |[a, b, c]: [f32; 3], slope: f32| [a - slope * z[0], b - slope * z[1], c - slope * z[2]];
        let x = shear(from_origin(corners[0], self.origin[0]), self.per_z[0]);
        let y = shear(from_origin(corners[1], self.origin[1]), self.per_z[1]);
        (x, y, z)
    }

    #[inline(always)]
    fn corners(&self, triangle: &Triangle) -> Corners {
        let [kx, ky, kz] = self.axes;
        [triangle.axes[kx], triangle.axes[ky], triangle.axes[kz]]
    }

    /// Interpolates `t`, `u` and `v` by weights that agree in sign; `z` are distances along the ray's main axis.
    fn interpolate(&self, weights: &Weights<f64>, z: &[f64; 3]) -> TriangleHit {
        let [a, b, c] = weights;
        let sum = a + b + c;
        let t = (a * z[0] + b * z[1] + c * z[2]) / (sum * f64::from(self.direction[2]));
        TriangleHit { t: t as f32, u: (b / sum) as f32, v: (c / sum) as f32 }
    }

    fn main_axis_distances(&self, triangle: &Triangle) -> [f64; 3] {
        triangle.axes[self.axes[2]].map(|v| f64::from(v) - f64::from(self.origin[2]))
    }
}

/// `[t, u, v]`; `t` from the triangle's plane or from the weights, whichever is off by less. In roundings, times the distance from the
/// origin and over the weights' sum, the first is off by the length of the normal, the second by the range of depths
/// times the size of the triangle as the ray sees it: where that is small beside the normal, weights are better.
/// Weights alone make long triangles seen at an angle hit the rays that leave them.
///
/// `corners` as [`TriangleRay::corners`], `z` relative to the origin.
#[inline(always)]
pub(crate) fn in_floats<F: Floats>(
    floats: F,
    ray: &TriangleRay,
    corners: &[[F::Vector; 3]; 3],
    &[a, b, c]: &Weights<F::Vector>,
    z: &[F::Vector; 3],
) -> [F::Vector; 3] {
    let per_sum = floats.div(floats.splat(1.0), floats.add(floats.add(a, b), c));
    let (u, v) = (floats.mul(b, per_sum), floats.mul(c, per_sum));
    let [x, y, depth] = [edges(floats, &corners[0]), edges(floats, &corners[1]), edges(floats, &corners[2])];
    let normal = [across(floats, y, depth), across(floats, depth, x), across(floats, x, y)];
    let [ox, oy, _, _] = ray.origin;
    let (from_x, from_y) = (floats.sub(corners[0][0], floats.splat(ox)), floats.sub(corners[1][0], floats.splat(oy)));
    let distance = along(floats, &normal, [from_x, from_y, z[0]]);
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
fn edges<F: Floats>(floats: F, &[a, b, c]: &[F::Vector; 3]) -> [F::Vector; 2] {
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

impl PrecisionMode for Fast {
    const IS_IN_FLOATS: bool = true;
    const IS_EXACT: bool = false;
    const HAS_LANES: bool = false;
    const FOLLOWS_WEIGHTS: bool = false;

    #[inline(never)]
    fn settle(
        ray: &TriangleRay,
        triangle: &Triangle,
        x: &[f32; 3],
        y: &[f32; 3],
        _interval: Interval,
    ) -> Option<TriangleHit> {
        let weights = sheared_weights(x, y)?;
        let hit = ray.interpolate(&weights, &ray.main_axis_distances(triangle));
        (!ray.ends_behind(&hit, &ray.corners(triangle))).then_some(hit)
    }

    #[inline(always)]
    fn evaluate_sheared(
        ray: &TriangleRay,
        corners: &Corners,
        weights: &Weights<f32>,
        z: &[f32; 3],
    ) -> Option<TriangleHit> {
        let [t, u, v] = in_floats(One, ray, corners, weights, z);
        // Not where something was beyond the range of `f32`.
        (t.is_finite() & u.is_finite() & v.is_finite()).then_some(TriangleHit { t, u, v })
    }

    #[inline(always)]
    fn evaluate_certain<S: Simd>(_simd: S, ray: &TriangleRay, corners: &Corners, _t_min: f32) -> Option<Evaluation> {
        let (x, y, z) = ray.shear(corners);
        let hit = Self::evaluate_sheared(ray, corners, &edge_functions(&x, &y), &z)?;
        Some(if ray.ends_behind(&hit, corners) { Evaluation::Behind } else { Evaluation::Inside(hit) })
    }
}

impl PrecisionMode for Accurate {
    const IS_IN_FLOATS: bool = false;
    const IS_EXACT: bool = false;
    const HAS_LANES: bool = true;
    const FOLLOWS_WEIGHTS: bool = true;

    #[inline(never)]
    fn settle(
        ray: &TriangleRay,
        triangle: &Triangle,
        x: &[f32; 3],
        y: &[f32; 3],
        interval: Interval,
    ) -> Option<TriangleHit> {
        let sheared = sheared_weights(x, y)?;
        let corners = ray.corners(triangle);
        let evaluation = match Evaluation::inside::<_, Self>(Scalar, ray, &corners, interval.t_min) {
            Some(Evaluation::Inside(hit)) => return Some(hit),
            Some(Evaluation::Near { hit, .. }) if let Some(hit) = ray.hit_across::<Self>(hit, &corners) => {
                return Some(hit);
            }
            evaluation => evaluation.unwrap_or_else(|| Evaluation::of::<f64>(ray, triangle)),
        };
        let hit = match evaluation {
            Evaluation::Inside(hit) => hit,
            Evaluation::Behind => return None,
            Evaluation::Near { t, t_error, .. } if interval.excludes(t, t_error) => return None,
            Evaluation::Outside => within_the_band(ray, triangle, &sheared),
            Evaluation::Near { hit, .. } => evaluate_slowly(ray, triangle, interval, || hit)?,
            Evaluation::Uncertain => {
                evaluate_slowly(ray, triangle, interval, || within_the_band(ray, triangle, &sheared))?
            }
        };
        (!ray.ends_behind(&hit, &corners)).then_some(hit)
    }

    #[inline(always)]
    fn evaluate_certain<S: Simd>(simd: S, ray: &TriangleRay, corners: &Corners, t_min: f32) -> Option<Evaluation> {
        Evaluation::inside::<S, Self>(simd, ray, corners, t_min)
    }
}

impl PrecisionMode for Exact {
    const IS_IN_FLOATS: bool = false;
    const IS_EXACT: bool = true;
    const HAS_LANES: bool = true;
    const FOLLOWS_WEIGHTS: bool = true;

    #[inline(never)]
    fn settle(
        ray: &TriangleRay,
        triangle: &Triangle,
        _x: &[f32; 3],
        _y: &[f32; 3],
        interval: Interval,
    ) -> Option<TriangleHit> {
        let corners = ray.corners(triangle);
        match Evaluation::inside::<_, Self>(Scalar, ray, &corners, interval.t_min) {
            Some(Evaluation::Inside(hit)) => Some(hit),
            Some(Evaluation::Outside | Evaluation::Behind) => None,
            Some(Evaluation::Near { t, t_error, .. }) if interval.excludes(t, t_error) => None,
            Some(Evaluation::Near { hit, .. }) if let Some(hit) = ray.hit_across::<Self>(hit, &corners) => Some(hit),
            _ => ray.hit_exactly(triangle),
        }
    }

    #[inline(always)]
    fn evaluate_certain<S: Simd>(simd: S, ray: &TriangleRay, corners: &Corners, t_min: f32) -> Option<Evaluation> {
        Evaluation::inside::<S, Self>(simd, ray, corners, t_min)
    }
}

/// How far the edge functions of sheared coordinates are from those of the exact ones, at the most. Infinite or NaN where
/// something was beyond the range of `f32`.
///
/// With `u = 2^-24`, `s` the sum of all `|x|` and `|y|` and `m` the largest `|z|`, no coordinate exceeded `s + m` before the
/// shear, so the sheared ones are off by `e = 2 u s + 6 u m` at the most (see the top). That moves an edge function by `e s + 2 e^2`;
/// its own products and their difference round by `2 u (|x0 y1| + |y0 x1|) <= u s^2 / 2`. The factors are a little larger for the
/// roundings of the bound itself, and absolute terms cover underflow, flushed to zero or not.
#[inline(always)]
fn edge_doubt(x: &[f32; 3], y: &[f32; 3], z: &[f32; 3]) -> f32 {
    let sum = |values: &[f32; 3]| values[0].abs() + values[1].abs() + values[2].abs();
    let size = sum(x) + sum(y);
    let depth = greater(greater(z[0].abs(), z[1].abs()), z[2].abs());
    if size >= MOST_REACH {
        return f32::INFINITY;
    }
    let moved = 2.25 * UNIT_ROUNDOFF * size + 6.5 * UNIT_ROUNDOFF * depth + LEAST_DOUBT;
    moved * (size + 2.25 * moved) + 0.75 * UNIT_ROUNDOFF * size * size + LEAST_DOUBT
}

/// 2^-120: what 64 results that underflow add up to.
const LEAST_DOUBT: f32 = 1.0 / (1u128 << 120) as f32;

/// From 2^62 on products of two coordinates may overflow, and an infinite edge function tells no sign for certain.
const MOST_REACH: f32 = (1u64 << 62) as f32;

/// A NaN is kept if it is the first.
#[inline(always)]
fn greater(a: f32, b: f32) -> f32 {
    if a < b { b } else { a }
}

/// The slack `w` of edge functions in one scene: those of sheared coordinates are off by `w s + w^2 + 2^-120` at the most, where
/// `s` is the sum of all `|x|` and `|y|`. `reach` is the largest distance `M` along an axis from the origin to a corner of the scene.
///
/// As [`edge_doubt`], with `M` for all coordinates before the shear: these are off by `e = 6 u M`; `|x0 y1| + |y0 x1|` is at most
/// `M s` and some roundings, because sheared coordinates do not exceed `2 M`, so products and difference round by `2.2 u M s`.
#[inline(always)]
pub(crate) fn edge_slack(reach: f32) -> f32 {
    if reach < MOST_REACH { 9.0 * UNIT_ROUNDOFF * reach + LEAST_DOUBT } else { f32::INFINITY }
}

/// `w^2 + 2^-120` of [`edge_slack`].
#[inline(always)]
pub(crate) fn least_doubt(edge_slack: f32) -> f32 {
    edge_slack * edge_slack + LEAST_DOUBT
}

/// In twice the precision, and exactly what is still uncertain. `otherwise` is for a triangle that turns out to be
/// missed: what is known of it then must not depend on the interval, or the order of tests would show in the answer.
#[cold]
fn evaluate_slowly(
    ray: &TriangleRay,
    triangle: &Triangle,
    interval: Interval,
    otherwise: impl FnOnce() -> TriangleHit,
) -> Option<TriangleHit> {
    match Evaluation::of::<DoubleDouble>(ray, triangle) {
        Evaluation::Inside(hit) => Some(hit),
        Evaluation::Near { t, t_error, .. } if interval.excludes(t, t_error) => None,
        Evaluation::Near { hit, t_per_volume, .. } => {
            let t = t_per_volume * triangle.signed_volume(ray.in_scene(&ray.origin));
            Some(TriangleHit { t: t as f32, ..hit })
        }
        Evaluation::Behind => None,
        Evaluation::Outside => Some(otherwise()),
        Evaluation::Uncertain => Some(ray.hit_exactly(triangle).unwrap_or_else(otherwise)),
    }
}

/// No point of the triangle lies on the ray, as far as can be told: the weights that decided name a point of the
/// triangle within the band of it.
#[cold]
fn within_the_band(ray: &TriangleRay, triangle: &Triangle, sheared: &Weights<f64>) -> TriangleHit {
    ray.interpolate(sheared, &ray.main_axis_distances(triangle))
}

/// Twice the signed area between the origin and each edge, seen along the ray: the weight of the vertex opposite.
#[inline(always)]
pub(super) fn edge_functions<T: Copy + Sub<Output = T> + Mul<Output = T>>(x: &[T; 3], y: &[T; 3]) -> Weights<T> {
    [x[2] * y[1] - y[2] * x[1], x[0] * y[2] - y[0] * x[2], x[1] * y[0] - y[1] * x[0]]
}

/// What sheared coordinates decide, exactly: the weights if the ray hits. All are zero where it sees the triangle edge-on,
/// and NaN where coordinates are beyond the range of `f32`.
#[inline(always)]
fn sheared_weights(x: &[f32; 3], y: &[f32; 3]) -> Option<Weights<f64>> {
    let weights = edge_functions(&x.map(f64::from), &y.map(f64::from));
    let (any_negative, any_positive) = signs_beyond(&weights, 0.0);
    (any_negative != any_positive).then_some(weights)
}

/// Whether any is below `-bound`, and whether any is above `bound`. A NaN is neither.
#[inline(always)]
fn signs_beyond<T: Copy + PartialOrd + Neg<Output = T>>(values: &[T; 3], bound: T) -> (bool, bool) {
    let [a, b, c] = *values;
    ((a < -bound) | (b < -bound) | (c < -bound), (a > bound) | (b > bound) | (c > bound))
}

#[cfg(test)]
mod tests {
    use glam::Vec3;
    use num_bigint::BigInt;
    use num_rational::BigRational;
    use proptest::prelude::*;

    use super::*;

    const WHOLE_LINE: Interval = Interval { t_min: f32::NEG_INFINITY, t_max: f32::INFINITY };

    /// The exact `t`, `u`, `v` of the ray's meeting with the triangle's plane, by Cramer's rule in rationals; `None`
    /// for a ray that is parallel to it.
    fn exact(ray: &Ray, vertices: &[[f32; 3]; 3]) -> Option<[BigRational; 3]> {
        let rational = |v: f32| BigRational::from_float(v).expect("finite");
        let point = |p: [f32; 3]| p.map(rational);
        let [a, b, c] = vertices.map(point);
        let (origin, direction) = (point(ray.origin.to_array()), point(ray.direction.to_array()));
        let minus = |p: &[BigRational; 3], q: &[BigRational; 3]| std::array::from_fn(|axis| &p[axis] - &q[axis]);
        let cross = |p: &[BigRational; 3], q: &[BigRational; 3]| -> [BigRational; 3] {
            std::array::from_fn(|axis| {
                let (next, last) = ((axis + 1) % 3, (axis + 2) % 3);
                &p[next] * &q[last] - &p[last] * &q[next]
            })
        };
        let dot = |p: &[BigRational; 3], q: &[BigRational; 3]| &p[0] * &q[0] + &p[1] * &q[1] + &p[2] * &q[2];
        let (ab, ac, ao) = (minus(&b, &a), minus(&c, &a), minus(&origin, &a));
        let across = cross(&direction, &ac);
        let determinant = dot(&ab, &across);
        if determinant == BigRational::from_integer(BigInt::from(0)) {
            return None;
        }
        let along = cross(&ao, &ab);
        Some([dot(&ac, &along) / &determinant, dot(&ao, &across) / &determinant, dot(&direction, &along) / determinant])
    }

    /// Whether `value` is within `bound` of `truth`.
    fn is_near(value: f32, truth: &BigRational, bound: f64) -> bool {
        let error = BigRational::from_float(value).expect("finite") - truth;
        let bound = BigRational::from_float(bound).expect("finite");
        -&bound <= error && error <= bound
    }

    /// The spacing of floats around `value`.
    fn ulp(value: f32) -> f64 {
        let magnitude = value.abs().max(f32::MIN_POSITIVE);
        f64::from(magnitude.next_up()) - f64::from(magnitude)
    }

    /// A coordinate with a random scale, so that triangles come as needles, far and near.
    fn coordinate() -> impl Strategy<Value = f32> {
        (-1f32..1.0, -20i32..6).prop_map(|(mantissa, exponent)| mantissa * 2f32.powi(exponent))
    }

    fn point() -> impl Strategy<Value = [f32; 3]> {
        [coordinate(), coordinate(), coordinate()]
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(2000))]

        #[test]
        fn accurate_hits_are_within_half_an_ulp(
            vertices in [point(), point(), point()],
            origin in point(),
            weights in (0f32..1.0, 0f32..1.0),
        ) {
            let [a, b, c] = vertices.map(Vec3::from_array);
            let (first, second) = if weights.0 + weights.1 > 1.0 { (1.0 - weights.0, 1.0 - weights.1) } else { weights };
            let target = a + (b - a) * first + (c - a) * second;
            let origin = Vec3::from_array(origin);
            let ray = Ray { origin, t_min: f32::NEG_INFINITY, direction: target - origin, t_max: f32::INFINITY };
            prop_assume!(ray.is_valid());
            let triangle = Triangle::new(vertices, 0, 0);
            prop_assume!(!triangle.has_zero_area());
            let Some([t, u, v]) = exact(&ray, &vertices) else { return Ok(()) };
            let zero = BigRational::from_integer(BigInt::from(0));
            let one = BigRational::from_integer(BigInt::from(1));
            prop_assume!(u >= zero && v >= zero && &u + &v <= one);

            // The target may be within the band of an edge, where a neighbour would be taken: then there is nothing
            // to compare.
            let Some(hit) = TriangleRay::new(&ray).hit::<Accurate>(&triangle, WHOLE_LINE) else { return Ok(()) };
            prop_assert!(is_near(hit.t, &t, 0.51 * ulp(hit.t)), "t is {:e}", hit.t);
            let uv_bound = 0.52 * f64::from(f32::EPSILON) / 2.0;
            prop_assert!(is_near(hit.u, &u, uv_bound) && is_near(hit.v, &v, uv_bound), "u {:e} v {:e}", hit.u, hit.v);
        }
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(2000))]

        /// Where rays leave floors and walls.
        #[test]
        fn hits_near_the_plane_of_a_triangle_across_an_axis_are_within_half_an_ulp(
            vertices in [point(), point(), point()],
            (axis, plane, steps) in (0..3usize, prop_oneof![Just(0.0), coordinate()], -3..3i32),
            weights in (0.1f32..0.4, 0.1f32..0.4),
            (distance, direction) in (prop_oneof![Just(f32::MIN_POSITIVE), Just(f32::from_bits(1))], point()),
        ) {
            let vertices = vertices.map(|mut vertex| {
                vertex[axis] = plane;
                vertex
            });
            let [a, b, c] = vertices.map(Vec3::from_array);
            let mut origin = a + (b - a) * weights.0 + (c - a) * weights.1;
            origin[axis] = match steps {
                0 => plane,
                1.. => (0..steps).fold(plane + distance, |at, _| at.next_up()),
                _ => (steps..0).fold(plane - distance, |at, _| at.next_down()),
            };
            let direction = Vec3::from_array(direction);
            let ray = Ray { origin, t_min: f32::NEG_INFINITY, direction, t_max: f32::INFINITY };
            let triangle = Triangle::new(vertices, 0, 0);
            prop_assume!(ray.is_valid() && direction[axis] != 0.0 && !triangle.has_zero_area());
            let [t, u, v] = exact(&ray, &vertices).expect("not parallel");
            let (zero, one) = (BigRational::from_integer(BigInt::from(0)), BigRational::from_integer(BigInt::from(1)));
            prop_assume!(u > zero && v > zero && &u + &v < one);

            let ray = TriangleRay::new(&ray);
            let (accurate, exact) = (ray.hit::<Accurate>(&triangle, WHOLE_LINE), ray.hit::<Exact>(&triangle, WHOLE_LINE));
            let exact = exact.expect("it is inside");
            prop_assert!(is_near(exact.t, &t, 0.5 * ulp(exact.t)), "t is {:e}", exact.t);
            // It may be within the band of an edge.
            let Some(accurate) = accurate else { return Ok(()) };
            prop_assert!(is_near(accurate.t, &t, 0.51 * ulp(accurate.t)), "t is {:e}", accurate.t);
            let (x, y, _) = ray.shear(&ray.corners(&triangle));
            let (any_negative, any_positive) = signs_beyond(&edge_functions(&x, &y), 0.0);
            if any_negative != any_positive && edge_functions(&x, &y).iter().all(|edge| *edge != 0.0) {
                let certain = match Accurate::evaluate_certain(Scalar, &ray, &ray.corners(&triangle), WHOLE_LINE.t_min) {
                    Some(Evaluation::Inside(hit)) => Some(hit),
                    Some(Evaluation::Near { hit, t, t_error, .. }) => {
                        ray.hit_near::<Accurate>(&triangle, (hit, t, t_error), WHOLE_LINE)
                    }
                    _ => ray.hit::<Accurate>(&triangle, WHOLE_LINE),
                };
                prop_assert_eq!(certain, Some(accurate));
            }
        }
    }

    #[test]
    fn a_ray_from_the_plane_hits_at_exactly_zero() {
        // The origin is in the plane x + y + z = 1 exactly, the vertices too.
        let triangle = Triangle::new([[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]], 0, 0);
        let origin = Vec3::new(0.25, 0.25, 0.5);
        let ray = Ray { origin, t_min: 0.0, direction: Vec3::new(0.3, -0.7, 0.1), t_max: 0.0 };
        let interval = Interval { t_min: 0.0, t_max: 0.0 };
        let hit = TriangleRay::new(&ray).hit::<Accurate>(&triangle, interval).expect("the interval is closed");
        assert_eq!((hit.t, hit.u, hit.v), (0.0, 0.25, 0.5));
    }

    #[test]
    fn a_ray_that_leaves_a_plane_from_a_denormal_distance_misses_it() {
        // One of a floor's bounce rays: 2^-149 above z = 0 and going up, where doubled precision could not tell t
        // from 0.
        let triangle = Triangle::new([[90.0, 150.0, 0.0], [-120.0, 170.0, 0.0], [80.0, -130.0, 0.0]], 0, 0);
        let origin = Vec3::new(-0.003_453_125, 19.7, f32::from_bits(1));
        let ray =
            Ray { origin, t_min: 0.0, direction: Vec3::new(0.704_826, 0.409_943, 0.578_971), t_max: f32::INFINITY };
        let interval = Interval { t_min: 0.0, t_max: f32::INFINITY };
        assert_eq!(TriangleRay::new(&ray).hit::<Accurate>(&triangle, interval), None);
        let down = Ray { direction: -ray.direction, ..ray };
        let hit = TriangleRay::new(&down).hit::<Accurate>(&triangle, interval).expect("it goes through the floor");
        assert_eq!(hit.t, f32::from_bits(2));
    }

    /// Found by gnomon-hard: doubled precision could not tell `t` from another.
    #[test]
    fn a_hit_of_a_triangle_with_a_vertex_at_1e38_is_within_half_an_ulp() {
        let hits = [
            (
                [
                    [1e38, -0.531_099_5, 0.068_102_6],
                    [0.006_702_502_3, -0.344_562_4, -0.133_304_79],
                    [0.172_234_55, -0.565_565_76, -0.225_932_12],
                ],
                [1.762_007_5, -1.787_725_3, 0.626_893_9],
                [-0.911_463_4, 1.947_891, -1.133_371_8],
            ),
            (
                [
                    [1e38, 1.225_553, 0.753_077],
                    [-0.684_383_63, 0.906_593_3, 1.097_764_3],
                    [-0.798_498_5, 1.094_277_4, 0.850_446_5],
                ],
                [1.471_926_9, 2.307_083_4, 2.233_842_1],
                [-0.779_930_7, -1.468_113_7, -1.451_633_9],
            ),
        ];
        for (vertices, origin, direction) in hits {
            let [origin, direction] = [origin, direction].map(Vec3::from_array);
            let ray = Ray { origin, t_min: 0.0, direction, t_max: f32::INFINITY };
            let hit = TriangleRay::new(&ray).hit::<Accurate>(&Triangle::new(vertices, 0, 0), WHOLE_LINE);
            let (hit, [t, u, v]) = (hit.expect("a hit"), exact(&ray, &vertices).expect("not parallel"));
            assert!(is_near(hit.t, &t, 0.51 * ulp(hit.t)), "{ray:?}: t is {:e}", hit.t);
            let uv_bound = 0.52 * f64::from(f32::EPSILON) / 2.0;
            assert!(
                is_near(hit.u, &u, uv_bound) && is_near(hit.v, &v, uv_bound),
                "{ray:?}: u {:e} v {:e}",
                hit.u,
                hit.v
            );
        }
    }

    #[test]
    fn fast_rays_that_leave_an_axis_aligned_plane_miss_it() {
        // Large triangles, seen at every angle from just above: their edge functions are off by more than the distance.
        let triangle = Triangle::new([[-150.0, 77.925, -90.0], [40.0, 77.925, 160.0], [70.0, 77.925, -80.0]], 0, 0);
        let mut directions = 0;
        for x in -9..=9i16 {
            for z in -9..=9i16 {
                let direction = Vec3::new(f32::from(x) * 0.37, 1.0, f32::from(z) * 0.41);
                let origin = Vec3::new(f32::from(x) * 1.7, 77.925f32.next_up(), f32::from(z) * 1.3);
                for (direction, is_hit) in [(direction, false), (-direction, true)] {
                    let ray = Ray { origin, t_min: 0.0, direction, t_max: f32::INFINITY };
                    let interval = Interval { t_min: 0.0, t_max: f32::INFINITY };
                    let hit = TriangleRay::new(&ray).hit::<Fast>(&triangle, interval);
                    assert_eq!(hit.is_some(), is_hit, "{ray:?}: {hit:?}");
                    directions += 1;
                }
            }
        }
        assert_eq!(directions, 2 * 19 * 19);
    }

    #[test]
    fn a_ray_that_leaves_all_of_a_triangle_along_an_axis_misses_it() {
        // Large triangles in a floor, and rays from one float above an edge: within the band of it.
        let interval = Interval { t_min: 0.0, t_max: f32::INFINITY };
        let directions = [(1.0, 0.9), (0.8, -1.0), (-1.0, -1.0), (-0.7, 1.0), (1.0, -1.0), (1.0, 1.0), (0.1, -0.3)];
        for (floor, size) in [(77.925f32, 160.0f32), (0.1, 160.0), (1e-3, 100.0), (3.0, 1000.0), (1e-7, 1.0)] {
            let triangle = Triangle::new([[-size, floor, -size], [size, floor, size], [size, floor, -size]], 0, 0);
            for step in -200..=200i16 {
                let at = f32::from(step) * size / 400.0;
                let origin = Vec3::new(at, floor.next_up(), at);
                for (rise, (x, z)) in [1e-3, 0.1, 0.5, 1.0].into_iter().flat_map(|rise| directions.map(|d| (rise, d))) {
                    let ray = Ray { origin, t_min: 0.0, direction: Vec3::new(x, rise, z), t_max: f32::INFINITY };
                    let ray = TriangleRay::new(&ray);
                    assert_eq!(ray.hit::<Fast>(&triangle, interval), None, "{ray:?}");
                    assert_eq!(ray.hit::<Accurate>(&triangle, interval), None, "{ray:?}");
                    assert_eq!(ray.hit::<Exact>(&triangle, interval), None, "{ray:?}");
                }
            }
        }
    }

    #[test]
    fn an_edge_on_triangle_is_not_hit() {
        let triangle = Triangle::new([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]], 0, 0);
        let ray = Ray { origin: Vec3::new(-1.0, 0.0, 0.25), t_min: 0.0, direction: Vec3::X, t_max: f32::INFINITY };
        assert_eq!(TriangleRay::new(&ray).hit::<Accurate>(&triangle, WHOLE_LINE), None);
    }
}
