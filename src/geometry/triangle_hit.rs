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
use super::float_hit::{edges, in_floats};
use super::{BEHIND, Ray, Triangle};
use crate::math::{DoubleDouble, UNIT_ROUNDOFF, rounds_alike, widen};
use crate::simd::{One, Scalar, Simd};

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
        let edges = [edges(One, &corners[0]), edges(One, &corners[1]), edges(One, &corners[2])];
        let first = [corners[0][0] - ray.origin[0], corners[1][0] - ray.origin[1], z[0]];
        let [t, u, v] = in_floats(One, ray, edges, first, weights, z);
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
mod tests;
