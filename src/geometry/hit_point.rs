//! The point where a ray meets a surface, with a bound on its error along each axis.

use glam::DVec3;

use super::evaluation::{Measured, Real};
use super::sphere::SphereRay;
use super::{Ray, Sphere, Triangle, TriangleRay};
use crate::math::DoubleDouble;

/// A point of a surface as `f64` has it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct HitPoint {
    pub(crate) position: DVec3,
    /// The point of the surface is no further from `position` along each axis.
    pub(crate) error: DVec3,
    /// Of unit length, off by less than 2^-29 in each component where the surface is a triangle.
    pub(crate) normal: DVec3,
}

const E: f64 = f64::EPSILON / 2.0;

/// What is known of the weights of a triangle's vertices where a line meets it.
enum Weights {
    /// They have one sign; and all their errors together, relative to their sum.
    Known([f64; 3], f64),
    /// The line passes the triangle, certainly.
    None,
    Uncertain,
}

impl Weights {
    fn of<R: Real>(ray: &TriangleRay, triangle: &Triangle) -> Self {
        /// Well below the rounding of positions to `f32`.
        const RELATIVE_ERROR: f64 = 1.0 / (1u64 << 31) as f64;
        let measured = Measured::<R>::of(ray, triangle);
        let Some(weights) = measured.weights_inside() else { return Self::None };
        let weights = weights.map(R::to_f64);
        let error = measured.bounds.iter().sum::<f64>() / weights.iter().sum::<f64>().abs();
        // Not where both are 0, which makes a NaN.
        if error < RELATIVE_ERROR { Self::Known(weights, error) } else { Self::Uncertain }
    }

    fn of_exact(ray: &TriangleRay, triangle: &Triangle) -> Self {
        let weights = ray.exact_weights(triangle);
        let has = |is_such: fn(&f64) -> bool| weights.iter().any(is_such);
        // All are 0 where the line lies in the plane.
        if has(|&w| w < 0.0) == has(|&w| w > 0.0) { Self::None } else { Self::Known(weights, 0.0) }
    }
}

impl Triangle {
    /// Where the ray's line meets the closed triangle. Where the line passes it, but within the band in which `f32` may take
    /// it for hit, a point of the triangle within that band of the line. None where it is not taken for hit either.
    ///
    /// With `X` the point, `w` the exact weights and `w + e` those that are used, `sum (w + e) V / sum (w + e)` is off from it
    /// by `sum e (V - X) / sum (w + e)`, along each axis at most the relative error of the weights times the triangle's
    /// extent, which `X` is in. A rounding of each weight counts among their errors. Products and their sums make three
    /// roundings of the largest coordinate, the sum of the weights two, its inverse and the product with that one each.
    pub(crate) fn hit_point(&self, ray: &Ray) -> Option<HitPoint> {
        let ready = TriangleRay::new(ray);
        let mut known = Weights::of::<f64>(&ready, self);
        if let Weights::Uncertain = known {
            known = Weights::of::<DoubleDouble>(&ready, self);
        }
        if let Weights::Uncertain = known {
            known = Weights::of_exact(&ready, self);
        }
        let ([a, b, c], relative_error) = match known {
            Weights::Known(weights, error) => (weights, error),
            // Each is a difference of two exact products, rounded once.
            Weights::None | Weights::Uncertain => (ready.deciding_weights(self)?, 0.0),
        };
        let per_sum = 1.0 / (a + b + c);
        let along = |axis: usize| {
            let [p, q, r] = self.axes[axis].map(f64::from);
            let (least, most) = (p.min(q).min(r), p.max(q).max(r));
            let position = (a * p + b * q + c * r) * per_sum;
            let error = (relative_error + 4.0 * E) * (most - least) + 16.0 * E * least.abs().max(most.abs());
            (position, error)
        };
        let ((x, dx), (y, dy), (z, dz)) = (along(0), along(1), along(2));
        let normal = self.certain_normal().0.normalize();
        Some(HitPoint { position: DVec3::new(x, y, z), error: DVec3::new(dx, dy, dz), normal })
    }
}

impl Sphere {
    /// Where the ray's line meets the sphere at `t`, of the two points the one nearer to that. None where it passes.
    ///
    /// With `w` the origin seen from the centre that is `(a w - h d) / a -+ (sqrt(h^2 - a k) / a) d` from the centre. In doubled
    /// precision, of roundoff `U`, `a w - h d` is off by at most `24 U a |w|`, and the discriminant by `D = 64 U a (w.w + r^2)`,
    /// hence its root by `sqrt(D)`, and by `D` over the root. In `f64`, of roundoff `E`, what is no longer than the radius is
    /// rounded ten times, and the sum with the centre once.
    pub(crate) fn hit_point(&self, ray: &Ray, t: f32) -> Option<HitPoint> {
        let ready = SphereRay::new(ray);
        let [first, second] = self.meetings(&ready)?.map(|root| (root as f32 - t).abs());
        let side = if second < first { 1.0 } else { -1.0 };

        let line = self.line(&ready);
        let (a, size) = (line.a.to_f64(), line.size());
        let root = line.discriminant().to_f64().max(0.0).sqrt();
        let discriminant_bound = 64.0 * DoubleDouble::UNIT_ROUNDOFF * a * size;
        let root_bound = discriminant_bound.sqrt().min(discriminant_bound / root);
        let distance_bound = 24.0 * DoubleDouble::UNIT_ROUNDOFF * size.sqrt();
        let radius = f64::from(self.radius);
        let along = |axis: usize| {
            let (d, centre) = (f64::from(ready.direction[axis]), f64::from(self.centre[axis]));
            let beside = (line.a * line.w[axis] - line.h * line.d[axis]).to_f64() / a;
            let from_centre = beside + side * (root / a) * d;
            let error = distance_bound + root_bound / a * d.abs() + 16.0 * E * (radius + centre.abs());
            (from_centre, error)
        };
        let ((x, dx), (y, dy), (z, dz)) = (along(0), along(1), along(2));
        let (from_centre, error) = (DVec3::new(x, y, z), DVec3::new(dx, dy, dz));
        let centre = DVec3::from_array(self.centre.map(f64::from));
        Some(HitPoint { position: centre + from_centre, error, normal: from_centre.normalize() })
    }
}
