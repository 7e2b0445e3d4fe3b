//! Where a ray meets a triangle: watertight decisions in `f32`, and `t`, `u`, `v` to half an ulp.
//!
//! The decision is Woop's (Woop, Benthin, Wald 2013, "Watertight ray/triangle intersection"): the vertices, relative to
//! the origin, are sheared so that the ray becomes an axis; the ray hits where the three edge functions of the remaining
//! two coordinates agree in sign. A vertex is sheared the same way for every triangle that has it, and the signs of
//! the edge functions of the sheared coordinates are exact, so that neighbours agree about the edge between them:
//! nothing slips through.
//!
//! What is inexact is the shear. With `u = 2^-24`, `z` the axis of the largest direction component, `a` the vertex
//! minus the origin, and `|dx / dz| <= 1`, the sheared `x = ax - (dx / dz) az` is off by at most `2u |ax| + 4u |az|`
//! (one rounding of the result, one of each difference, and of the quotient and the product) plus `3 * 2^-149` where
//! something underflows. That is the band: a triangle
//! that the ray passes at less than this distance may be taken for hit, its neighbour then is refused.

use std::ops::{Add, Mul, Sub};

use super::{Ray, Triangle};
use crate::math::DoubleDouble;

/// What a triangle test found. `t` is finite; whether it lies in the ray's interval is the caller's question.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct TriangleHit {
    pub(crate) t: f32,
    pub(crate) u: f32,
    pub(crate) v: f32,
}

/// A ray made ready for triangle tests.
#[derive(Clone, Copy, Debug)]
pub(crate) struct TriangleRay {
    origin: [f32; 3],
    direction: [f32; 3],
    /// x, y and z of the sheared space, as axes of the scene's.
    axes: [usize; 3],
    shear: [f32; 2],
}

/// Edge functions: the weights of the three vertices, up to a common factor.
type Weights<T> = [T; 3];

/// How `t`, `u` and `v` of an accepted triangle are computed.
pub(crate) trait PrecisionMode {
    fn evaluate(ray: &TriangleRay, triangle: &Triangle, sheared: &Weights<f64>) -> Option<TriangleHit>;
}

/// From the coordinates that decided: off by as much as those are.
pub(crate) struct Fast;

/// From the ray and the triangle themselves, in `f64` or, where that is not provably enough, in twice its precision.
pub(crate) struct Accurate;

impl TriangleRay {
    /// Expects a valid ray.
    pub(crate) fn new(ray: &Ray) -> Self {
        let direction = ray.direction.to_array();
        let [x, y, z] = direction.map(f32::abs);
        // The first of equal components, so that the choice is the same everywhere.
        let kz = if x >= y && x >= z {
            0
        } else if y >= z {
            1
        } else {
            2
        };
        let (kx, ky) = ((kz + 1) % 3, (kz + 2) % 3);
        Self {
            origin: ray.origin.to_array(),
            direction,
            axes: [kx, ky, kz],
            shear: [direction[kx] / direction[kz], direction[ky] / direction[kz]],
        }
    }

    /// The closed triangle against the whole line.
    #[inline(always)]
    pub(crate) fn hit<P: PrecisionMode>(&self, triangle: &Triangle) -> Option<TriangleHit> {
        let [kx, ky, kz] = self.axes;
        let from_origin = |axis: usize| triangle.axes[axis].map(|v| v - self.origin[axis]);
        let z = from_origin(kz);
        let shear = |row: [f32; 3], slope: f32| std::array::from_fn(|corner| row[corner] - slope * z[corner]);
        let x: [f32; 3] = shear(from_origin(kx), self.shear[0]);
        let y: [f32; 3] = shear(from_origin(ky), self.shear[1]);

        // Rounding keeps order, so the difference of two rounded products never has the wrong sign: it can only be zero, or
        // NaN where both overflowed. A nonzero sign settles it here; the rest is settled in f64, where these products are exact.
        let edges = edge_functions(&x, &y);
        let (any_negative, any_positive) = signs(&edges);
        if any_negative && any_positive {
            return None;
        }
        self.settle::<P>(triangle, &x, &y)
    }

    /// The exact decision on sheared coordinates, and the hit's parameters.
    #[inline(never)]
    fn settle<P: PrecisionMode>(&self, triangle: &Triangle, x: &[f32; 3], y: &[f32; 3]) -> Option<TriangleHit> {
        let weights = edge_functions(&x.map(f64::from), &y.map(f64::from));
        match signs(&weights) {
            // All zero: seen edge-on, or NaN from coordinates beyond the range of f32.
            (true, true) | (false, false) => None,
            _ => P::evaluate(self, triangle, &weights).filter(|hit| hit.t.is_finite()),
        }
    }

    /// Interpolates `t`, `u` and `v` by weights that agree in sign; `z` are distances along the ray's main axis.
    fn interpolate(&self, weights: &Weights<f64>, z: &[f64; 3]) -> TriangleHit {
        let [a, b, c] = weights;
        let sum = a + b + c;
        let t = (a * z[0] + b * z[1] + c * z[2]) / (sum * f64::from(self.direction[self.axes[2]]));
        TriangleHit { t: t as f32, u: (b / sum) as f32, v: (c / sum) as f32 }
    }

    fn main_axis_distances(&self, triangle: &Triangle) -> [f64; 3] {
        let kz = self.axes[2];
        triangle.axes[kz].map(|v| f64::from(v) - f64::from(self.origin[kz]))
    }
}

impl PrecisionMode for Fast {
    fn evaluate(ray: &TriangleRay, triangle: &Triangle, sheared: &Weights<f64>) -> Option<TriangleHit> {
        Some(ray.interpolate(sheared, &ray.main_axis_distances(triangle)))
    }
}

impl PrecisionMode for Accurate {
    fn evaluate(ray: &TriangleRay, triangle: &Triangle, sheared: &Weights<f64>) -> Option<TriangleHit> {
        let evaluation = match Evaluation::of::<f64>(ray, triangle) {
            Evaluation::Uncertain { .. } => Evaluation::of::<DoubleDouble>(ray, triangle),
            certain => certain,
        };
        Some(match evaluation {
            Evaluation::Inside(hit) => hit,
            // The band: no point of the triangle lies on the ray. The weights that decided name a point of the triangle
            // within the band of it.
            Evaluation::Outside => ray.interpolate(sheared, &ray.main_axis_distances(triangle)),
            Evaluation::Uncertain { hit } => {
                let mut hit = hit.unwrap_or_else(|| ray.interpolate(sheared, &ray.main_axis_distances(triangle)));
                if triangle.plane_contains(ray.origin) {
                    hit.t = 0.0;
                }
                hit
            }
        })
    }
}

/// The number types that a hit is evaluated in.
trait Real: Copy + From<f64> + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> {
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
enum Evaluation {
    /// `t` is within 2^-31 of the exact one, relatively, before its only rounding to `f32`; so are `u` and `v`, absolutely.
    /// That is 0.008 ulp on top of the half.
    Inside(TriangleHit),
    /// The ray passes the triangle, certainly.
    Outside,
    /// The error bound is too large to tell. `hit` is there where the weights are good and only `t` is too near to 0.
    Uncertain { hit: Option<TriangleHit> },
}

impl Evaluation {
    /// Shears without a division, `x = ax dz - dx az`, so that everything is a polynomial in the input.
    ///
    /// With `e` the relative error of one operation, `m` the largest distance of a vertex from the origin along an axis and
    /// `r = m |dz|`: a sheared coordinate is off by at most `3e (|ax dz| + |dx az|) <= 6 e r`; so an edge function of the vertices b and c by at
    /// most `6 e r s + 72 e^2 r^2` from that, `s = |bx| + |by| + |cx| + |cy|`, and by `2e (|bx cy| + |by cx|) + e s 2r <= 6 e r s` from its own three operations:
    /// together less than `16 e r (s + 16 e r)`.
    fn of<R: Real>(ray: &TriangleRay, triangle: &Triangle) -> Self {
        const RELATIVE_ERROR: f64 = 1.0 / (1u64 << 31) as f64;

        let [kx, ky, kz] = ray.axes;
        let [dx, dy, dz] = [kx, ky, kz].map(|axis| R::from(f64::from(ray.direction[axis])));
        let from_origin =
            |axis: usize| triangle.axes[axis].map(|v| R::difference(f64::from(v), f64::from(ray.origin[axis])));
        let [ax, ay, az] = [kx, ky, kz].map(from_origin);
        let x: [R; 3] = std::array::from_fn(|corner| ax[corner] * dz - dx * az[corner]);
        let y: [R; 3] = std::array::from_fn(|corner| ay[corner] * dz - dy * az[corner]);
        let weights = edge_functions(&x, &y);

        let magnitude = |values: &[R; 3]| values.iter().fold(0.0, |most: f64, v| most.max(v.to_f64().abs()));
        let distance = magnitude(&ax).max(magnitude(&ay)).max(magnitude(&az));
        let reach = distance * dz.to_f64().abs();
        let size: [f64; 3] = std::array::from_fn(|corner| x[corner].to_f64().abs() + y[corner].to_f64().abs());
        let bound: [f64; 3] = std::array::from_fn(|corner| {
            let edge_size = size[(corner + 1) % 3] + size[(corner + 2) % 3];
            16.0 * R::UNIT_ROUNDOFF * reach * (edge_size + 16.0 * R::UNIT_ROUNDOFF * reach)
        });

        let certain_sign = |corner: usize| {
            let weight = weights[corner].to_f64();
            if weight.abs() > bound[corner] { weight } else { 0.0 }
        };
        let (any_negative, any_positive) = signs(&[certain_sign(0), certain_sign(1), certain_sign(2)]);
        if any_negative && any_positive {
            return Self::Outside;
        }

        // What is left on the wrong side of an edge is so by rounding: it lies on the edge.
        let inside = weights.map(|weight| {
            let wrong_side = if any_negative { weight.to_f64() > 0.0 } else { weight.to_f64() < 0.0 };
            if wrong_side { R::from(0.0) } else { weight }
        });
        let sum = inside[0] + inside[1] + inside[2];
        let weighted = inside[0] * az[0] + inside[1] * az[1] + inside[2] * az[2];
        let (sum_size, bound) = (sum.to_f64().abs(), bound[0] + bound[1] + bound[2]);
        if bound > RELATIVE_ERROR * sum_size || sum_size == 0.0 {
            return Self::Uncertain { hit: None };
        }
        let t = weighted.to_f64() / (sum.to_f64() * dz.to_f64());
        let hit = TriangleHit {
            t: t as f32,
            u: (inside[1].to_f64() / sum.to_f64()) as f32,
            v: (inside[2].to_f64() / sum.to_f64()) as f32,
        };
        let depths = az.map(R::to_f64);
        let range = depths.iter().copied().fold(f64::NEG_INFINITY, f64::max)
            - depths.iter().copied().fold(f64::INFINITY, f64::min);
        // Wrong weights move the hit within the triangle; five roundings make the weighted sum and its terms.
        let t_bound = bound * range + 5.0 * R::UNIT_ROUNDOFF * sum_size * magnitude(&az);
        if t_bound > RELATIVE_ERROR * weighted.to_f64().abs() {
            return Self::Uncertain { hit: Some(hit) };
        }
        Self::Inside(hit)
    }
}

/// Twice the signed area between the origin and each edge, seen along the ray: the weight of the vertex opposite.
#[inline(always)]
fn edge_functions<T: Copy + Sub<Output = T> + Mul<Output = T>>(x: &[T; 3], y: &[T; 3]) -> Weights<T> {
    [x[2] * y[1] - y[2] * x[1], x[0] * y[2] - y[0] * x[2], x[1] * y[0] - y[1] * x[0]]
}

/// Whether any is below zero, and whether any is above. A NaN is neither.
#[inline(always)]
fn signs<T: Copy + PartialOrd + Default>(values: &[T; 3]) -> (bool, bool) {
    let zero = T::default();
    let [a, b, c] = *values;
    ((a < zero) | (b < zero) | (c < zero), (a > zero) | (b > zero) | (c > zero))
}
