//! `t`, `u` and `v` of a hit from the ray and the triangle themselves, with a bound on their error.

use std::cmp::Ordering;
use std::ops::{Add, Mul, Sub};

use super::Triangle;
use super::triangle_hit::{Corners, PrecisionMode, TriangleHit, TriangleRay, edge_functions};
use crate::math::{DoubleDouble, rounds_alike, widen};
use crate::simd::Simd;

/// The number types that a hit is evaluated in.
pub(super) trait Real: Copy + From<f64> + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> {
    /// Bounds the relative error of one operation.
    const UNIT_ROUNDOFF: f64;
    fn difference(a: f64, b: f64) -> Self;
    fn to_f64(self) -> f64;
}

impl Real for f64 {
    const UNIT_ROUNDOFF: f64 = f64::EPSILON * 0.5;

    fn difference(a: f64, b: f64) -> Self {
        a - b
    }

    fn to_f64(self) -> f64 {
        self
    }
}

impl Real for DoubleDouble {
    const UNIT_ROUNDOFF: f64 = DoubleDouble::UNIT_ROUNDOFF;

    fn difference(a: f64, b: f64) -> Self {
        DoubleDouble::difference(a, b)
    }

    fn to_f64(self) -> f64 {
        self.to_f64()
    }
}

/// A hit evaluated from the true ray with a bound on the error.
pub(crate) enum Evaluation {
    /// `t` is within 2^-31 of the exact one, relatively, before its only rounding to `f32`; so are `u` and `v`,
    /// absolutely. That is 0.008 ulp on top of the half.
    Inside(TriangleHit),
    /// As good but for `t`, which is so near to 0 that its relative error is too large: it is off by at most
    /// `t_error`. The exact one is `t_per_volume`, which is good to 2^-31, times the volume between the triangle and
    /// the ray's origin.
    Near { hit: TriangleHit, t: f64, t_error: f64, t_per_volume: f64 },
    /// `t` is below 0, certainly, and does not round to 0: told only where `t_min` is not below 0.
    Behind,
    /// The ray passes the triangle, certainly.
    Outside,
    /// The error bound is too large to tell: the triangle is seen edge-on, or is a sliver far away.
    Uncertain,
}

/// What [`Evaluation::Inside`] promises.
pub(super) const RELATIVE_ERROR: f64 = 1.0 / (1u64 << 31) as f64;

/// See [`Evaluation::inside`].
pub(super) const LEAST_NORMAL: f64 = 1.0 / (1u128 << 70) as f64;

impl Evaluation {
    /// As [`Evaluation::of`] in `f64`, for rays that pass well inside the triangle, as nearly all do; `None` for others, but
    /// for those that pass well outside where that is asked for: for [exact](PrecisionMode::IS_EXACT) hits.
    ///
    /// With coarser bounds: `s` is the sum over all three vertices, and `m |dz| <= s + |dz| max |az|`, because
    /// `ax dz = x + dx az` and `|dx| <= |dz|`.
    ///
    /// For these also `None` where the error of `t` leaves open to which float it rounds, and where a number read as zero for
    /// being denormal would count: of coordinates that are off by `n = 2^-126` so, `x` is off by `4 n |dz| + 2 n m` at the most,
    /// less than 2^-49 of `s + |dz| max |az|` as long as `|dz|` and `max |az|` are 2^-70 or more.
    #[inline(always)]
    pub(super) fn inside<S: Simd, P: PrecisionMode>(
        simd: S,
        ray: &TriangleRay,
        corners: &Corners,
        t_min: f32,
    ) -> Option<Self> {
        const E: f64 = f64::UNIT_ROUNDOFF;
        /// With vertices this far away for each length of the direction, `t` beyond its bound is no denormal.
        const LEAST_DEPTH: f64 = 1.0 / (1u128 << 64) as f64;
        let ([ox, oy, oz, _], [dx, dy, dz, _]) = (ray.origin, ray.direction);
        let (ox, oy, oz) = (simd.splat3(ox), simd.splat3(oy), simd.splat3(oz));
        let (dx, dy, dz) = (simd.splat3(dx), simd.splat3(dy), simd.splat3(dz));
        // A lane a vertex.
        let ax = simd.sub3(simd.widen3(corners[0]), ox);
        let ay = simd.sub3(simd.widen3(corners[1]), oy);
        let az = simd.sub3(simd.widen3(corners[2]), oz);
        let x = simd.sub3(simd.mul3(ax, dz), simd.mul3(az, dx));
        let y = simd.sub3(simd.mul3(ay, dz), simd.mul3(az, dy));
        let first = simd.mul3(simd.third_first(x), simd.second_first(y));
        let weights = simd.sub3(first, simd.mul3(simd.third_first(y), simd.second_first(x)));

        let [a, b, c] = simd.values3(simd.add3(simd.abs3(x), simd.abs3(y)));
        let size = a + b + c;
        let [a, b, c] = simd.values3(simd.abs3(az));
        let depth = greatest3(a, b, c);
        let dz = f64::from(ray.direction[2]);
        let reach = 16.0 * E * (size + depth * dz.abs());
        let bound = reach * (size + reach);
        let [a, b, c] = simd.values3(weights);
        let sum = a + b + c;
        if !simd.beyond3(weights, bound) || 3.0 * bound > RELATIVE_ERROR * sum.abs() {
            let is_outside = P::IS_EXACT && greatest3(a, b, c) > bound && -greatest3(-a, -b, -c) < -bound;
            return (is_outside && lesser(depth, dz.abs()) >= LEAST_NORMAL).then_some(Self::Outside);
        }
        if P::IS_EXACT && lesser(depth, dz.abs()) < LEAST_NORMAL {
            return None;
        }
        let [az, bz, cz] = simd.values3(simd.mul3(weights, az));
        let weighted = az + bz + cz;
        let t_bound = (6.0 * bound + 5.0 * E * sum.abs()) * depth;
        // A ray that leaves a surface finds its own triangle so, without waiting for the division.
        if (t_min >= 0.0) & (weighted * sum * dz < 0.0) & (weighted.abs() > t_bound) & (depth > LEAST_DEPTH * dz.abs())
        {
            return Some(Self::Behind);
        }
        let inverse = 1.0 / (sum * dz);
        let t = weighted * inverse;
        let per_sum = dz * inverse;
        let hit = TriangleHit { t: t as f32, u: (b * per_sum) as f32, v: (c * per_sum) as f32 };
        if t_bound > RELATIVE_ERROR * weighted.abs() {
            return Some(Self::Near { hit, t, t_error: 2.0 * t_bound * inverse.abs(), t_per_volume: -dz / sum });
        }
        // Three times the bound instead of twice: for the roundings of the sum and the difference.
        if P::IS_EXACT && !rounds_alike(t, 3.0 * t_bound * inverse.abs()) {
            return None;
        }
        Some(Self::Inside(hit))
    }

    /// By the roundings of [`Measured`].
    pub(super) fn of<R: Real>(ray: &TriangleRay, triangle: &Triangle) -> Self {
        let measured = Measured::<R>::of(ray, triangle);
        let Some(inside) = measured.weights_inside() else { return Self::Outside };
        let az = measured.depths;
        let sum = inside[0] + inside[1] + inside[2];
        let weighted = inside[0] * az[0] + inside[1] * az[1] + inside[2] * az[2];
        let (sum_size, bound) = (sum.to_f64().abs(), measured.bounds.iter().sum::<f64>());
        if bound > RELATIVE_ERROR * sum_size || sum_size == 0.0 {
            return Self::Uncertain;
        }
        let dz = measured.direction.to_f64();
        let denominator = sum.to_f64() * dz;
        let t = weighted.to_f64() / denominator;
        let hit = TriangleHit {
            t: t as f32,
            u: (inside[1].to_f64() / sum.to_f64()) as f32,
            v: (inside[2].to_f64() / sum.to_f64()) as f32,
        };
        let t_bound = measured.t_bound(sum_size);
        if t_bound > RELATIVE_ERROR * weighted.to_f64().abs() {
            // Twice, for the rounding of the division and of the bound itself.
            let t_error = 2.0 * t_bound / denominator.abs();
            // With n the normal, t = volume / (n . d); and the weights' sum is -(n . d) dz, seen along the sheared ray.
            let t_per_volume = -dz / sum.to_f64();
            return Self::Near { hit, t, t_error, t_per_volume };
        }
        Self::Inside(hit)
    }
}

/// A triangle as a ray sees it, with bounds on the errors.
///
/// Sheared without a division, `x = ax dz - dx az`, so that everything is a polynomial in the input.
///
/// With `e` the relative error of one operation, `m` the largest distance of a vertex from the origin along an
/// axis and `r = m |dz|`: a sheared coordinate is off by at most `3e (|ax dz| + |dx az|) <= 6 e r`; so an edge
/// function of the vertices b and c by at most `6 e r s + 72 e^2 r^2` from that, `s = |bx| + |by| + |cx| + |cy|`,
/// and by `2e (|bx cy| + |by cx|) + e s 2r <= 6 e r s` from its own three operations: together less than `16 e r
/// (s + 16 e r)`.
pub(super) struct Measured<R> {
    /// Edge functions.
    pub(super) weights: [R; 3],
    /// How far each is off at the most.
    pub(super) bounds: [f64; 3],
    /// Of the vertices, along the ray's main axis.
    pub(super) depths: [R; 3],
    /// Along that axis.
    pub(super) direction: R,
}

impl<R: Real> Measured<R> {
    pub(super) fn of(ray: &TriangleRay, triangle: &Triangle) -> Self {
        let [dx, dy, dz, _] = ray.direction.map(|component| R::from(widen(component)));
        let from_origin =
            |at: usize| triangle.axes[ray.axes[at]].map(|v| R::difference(widen(v), widen(ray.origin[at])));
        let [ax, ay, az] = [0, 1, 2].map(from_origin);
        let x: [R; 3] = std::array::from_fn(|corner| ax[corner] * dz - dx * az[corner]);
        let y: [R; 3] = std::array::from_fn(|corner| ay[corner] * dz - dy * az[corner]);

        let distance = magnitude(&ax).max(magnitude(&ay)).max(magnitude(&az));
        let reach = distance * dz.to_f64().abs();
        let size: [f64; 3] = std::array::from_fn(|corner| x[corner].to_f64().abs() + y[corner].to_f64().abs());
        let bounds = std::array::from_fn(|corner| {
            let edge_size = size[(corner + 1) % 3] + size[(corner + 2) % 3];
            16.0 * R::UNIT_ROUNDOFF * reach * (edge_size + 16.0 * R::UNIT_ROUNDOFF * reach)
        });
        Self { weights: edge_functions(&x, &y), bounds, depths: az, direction: dz }
    }

    /// Of the exact weights, which are multiples of `grain`; `None` where rounding leaves it open.
    pub(super) fn signs(&self, grain: f64) -> [Option<Ordering>; 3] {
        std::array::from_fn(|corner| {
            let (weight, bound) = (self.weights[corner].to_f64(), self.bounds[corner]);
            if weight.abs() > bound {
                Some(weight.total_cmp(&0.0))
            } else {
                // Half of it, for the rounding of the sum.
                (weight.abs() + bound < 0.5 * grain).then_some(Ordering::Equal)
            }
        })
    }

    /// The weights of a point of the triangle: none where the ray passes it for certain.
    pub(super) fn weights_inside(&self) -> Option<[R; 3]> {
        let signs = self.signs(0.0);
        let any_negative = signs.contains(&Some(Ordering::Less));
        if any_negative && signs.contains(&Some(Ordering::Greater)) {
            return None;
        }
        // What is left on the wrong side of an edge is so by rounding: it lies on the edge.
        Some(self.weights.map(|weight| {
            let wrong_side = if any_negative { weight.to_f64() > 0.0 } else { weight.to_f64() < 0.0 };
            if wrong_side { R::from(0.0) } else { weight }
        }))
    }

    /// How far the weighted sum of the depths is off at the most, where the sum of the weights is of this size. Wrong weights
    /// move the hit within the triangle; five roundings make the weighted sum and its terms.
    pub(super) fn t_bound(&self, sum: f64) -> f64 {
        let depths = self.depths.map(R::to_f64);
        let range = depths.iter().copied().fold(f64::NEG_INFINITY, f64::max)
            - depths.iter().copied().fold(f64::INFINITY, f64::min);
        self.bounds.iter().sum::<f64>() * range + 5.0 * R::UNIT_ROUNDOFF * sum * magnitude(&self.depths)
    }
}

fn magnitude<R: Real>(values: &[R; 3]) -> f64 {
    values.iter().fold(0.0, |most: f64, v| most.max(v.to_f64().abs()))
}

/// Without `f64::min`'s care for NaN.
#[inline(always)]
fn lesser(a: f64, b: f64) -> f64 {
    if a < b { a } else { b }
}

/// Without `f64::max`'s care for NaN.
#[inline(always)]
fn greatest3(a: f64, b: f64, c: f64) -> f64 {
    let greater = if a > b { a } else { b };
    if greater > c { greater } else { c }
}
