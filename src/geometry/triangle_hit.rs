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

/// What a triangle test found. `t` is finite.
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
    fn excludes(&self, t: f64, error: f64) -> bool {
        t + error < f64::from(self.t_min.next_down()) || t - error > f64::from(self.t_max.next_up())
    }
}

/// How `t`, `u` and `v` of an accepted triangle are computed.
pub(crate) trait PrecisionMode {
    /// A hit outside the interval may be given or not: the caller looks.
    fn evaluate(
        ray: &TriangleRay,
        triangle: &Triangle,
        sheared: &Weights<f64>,
        interval: Interval,
    ) -> Option<TriangleHit>;
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

    /// The closed triangle against the closed interval of the line.
    #[inline(always)]
    pub(crate) fn hit<P: PrecisionMode>(&self, triangle: &Triangle, interval: Interval) -> Option<TriangleHit> {
        let [kx, ky, kz] = self.axes;
        let from_origin = |axis: usize| triangle.axes[axis].map(|v| v - self.origin[axis]);
        let z = from_origin(kz);
        let shear = |row: [f32; 3], slope: f32| std::array::from_fn(|corner| row[corner] - slope * z[corner]);
        let x: [f32; 3] = shear(from_origin(kx), self.shear[0]);
        let y: [f32; 3] = shear(from_origin(ky), self.shear[1]);

        // Rounding keeps order, so the difference of two rounded products never has the wrong sign: it can only be
        // zero, or NaN where both overflowed. A nonzero sign settles it here; the rest is settled in f64, where these
        // products are exact.
        let edges = edge_functions(&x, &y);
        let (any_negative, any_positive) = signs(&edges);
        if any_negative && any_positive {
            return None;
        }
        // A hit's t lies between those of its vertices.
        let is_behind = z.iter().all(|z| z * self.direction[kz] < 0.0);
        if is_behind && interval.t_min >= 0.0 {
            return None;
        }
        self.settle::<P>(triangle, &x, &y, interval).filter(|hit| interval.contains(hit.t) && hit.t.is_finite())
    }

    /// The exact decision on sheared coordinates, and the hit's parameters.
    #[inline(never)]
    fn settle<P: PrecisionMode>(
        &self,
        triangle: &Triangle,
        x: &[f32; 3],
        y: &[f32; 3],
        interval: Interval,
    ) -> Option<TriangleHit> {
        let weights = edge_functions(&x.map(f64::from), &y.map(f64::from));
        match signs(&weights) {
            // All zero: seen edge-on, or NaN from coordinates beyond the range of f32.
            (true, true) | (false, false) => None,
            _ => P::evaluate(self, triangle, &weights, interval),
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
    fn evaluate(
        ray: &TriangleRay,
        triangle: &Triangle,
        sheared: &Weights<f64>,
        _interval: Interval,
    ) -> Option<TriangleHit> {
        Some(ray.interpolate(sheared, &ray.main_axis_distances(triangle)))
    }
}

impl PrecisionMode for Accurate {
    fn evaluate(
        ray: &TriangleRay,
        triangle: &Triangle,
        sheared: &Weights<f64>,
        interval: Interval,
    ) -> Option<TriangleHit> {
        match Evaluation::of::<f64>(ray, triangle) {
            Evaluation::Inside(hit) => Some(hit),
            Evaluation::Near { t, t_error, .. } if interval.excludes(t, t_error) => None,
            Evaluation::Near { hit, .. } => Some(near_the_origin(ray, triangle, hit)),
            Evaluation::Outside => Some(within_the_band(ray, triangle, sheared)),
            Evaluation::Uncertain => Some(match Evaluation::of::<DoubleDouble>(ray, triangle) {
                Evaluation::Inside(hit) => hit,
                Evaluation::Near { hit, .. } => near_the_origin(ray, triangle, hit),
                Evaluation::Outside | Evaluation::Uncertain => within_the_band(ray, triangle, sheared),
            }),
        }
    }
}

/// No point of the triangle lies on the ray, as far as can be told: the weights that decided name a point of the triangle within
/// the band of it.
#[cold]
fn within_the_band(ray: &TriangleRay, triangle: &Triangle, sheared: &Weights<f64>) -> TriangleHit {
    ray.interpolate(sheared, &ray.main_axis_distances(triangle))
}

/// Where `t` is so small beside the triangle's extent that its relative error grows: in twice the precision that happens 2^-70 of the extent
/// from the origin, and there at least an exact zero is told.
#[cold]
fn near_the_origin(ray: &TriangleRay, triangle: &Triangle, hit: TriangleHit) -> TriangleHit {
    if triangle.plane_contains(ray.origin) {
        return TriangleHit { t: 0.0, ..hit };
    }
    match Evaluation::of::<DoubleDouble>(ray, triangle) {
        Evaluation::Inside(hit) | Evaluation::Near { hit, .. } => hit,
        // On the edge to within double precision, and off it to within twice that: the same point.
        Evaluation::Outside | Evaluation::Uncertain => hit,
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
    /// `t` is within 2^-31 of the exact one, relatively, before its only rounding to `f32`; so are `u` and `v`,
    /// absolutely. That is 0.008 ulp on top of the half.
    Inside(TriangleHit),
    /// As good but for `t`, which is too near to 0 to have a relative error: it is off by at most `t_error`.
    Near { hit: TriangleHit, t: f64, t_error: f64 },
    /// The ray passes the triangle, certainly.
    Outside,
    /// The error bound is too large to tell: the triangle is seen edge-on, or is a sliver far away.
    Uncertain,
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
            return Self::Uncertain;
        }
        let denominator = sum.to_f64() * dz.to_f64();
        let t = weighted.to_f64() / denominator;
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
            // Twice, for the rounding of the division and of the bound itself.
            return Self::Near { hit, t, t_error: 2.0 * t_bound / denominator.abs() };
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

#[cfg(test)]
mod tests {
    use glam::Vec3;
    use num_bigint::BigInt;
    use num_rational::BigRational;
    use proptest::prelude::*;

    use super::*;

    const WHOLE_LINE: Interval = Interval { t_min: f32::NEG_INFINITY, t_max: f32::INFINITY };

    /// The exact `t`, `u`, `v` of the ray's meeting with the triangle's plane, by Cramer's rule in rationals; `None` for a ray that is
    /// parallel to it.
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

            // The target may be within the band of an edge, where a neighbour would be taken: then there is nothing to compare.
            let Some(hit) = TriangleRay::new(&ray).hit::<Accurate>(&triangle, WHOLE_LINE) else { return Ok(()) };
            prop_assert!(is_near(hit.t, &t, 0.51 * ulp(hit.t)), "t is {:e}", hit.t);
            let uv_bound = 0.52 * f64::from(f32::EPSILON) / 2.0;
            prop_assert!(is_near(hit.u, &u, uv_bound) && is_near(hit.v, &v, uv_bound), "u {:e} v {:e}", hit.u, hit.v);
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
    fn an_edge_on_triangle_is_not_hit() {
        let triangle = Triangle::new([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]], 0, 0);
        let ray = Ray { origin: Vec3::new(-1.0, 0.0, 0.25), t_min: 0.0, direction: Vec3::X, t_max: f32::INFINITY };
        assert_eq!(TriangleRay::new(&ray).hit::<Accurate>(&triangle, WHOLE_LINE), None);
    }
}
