//! Where a ray begins that leaves a surface, so that it does not hit it again.
//!
//! The idea is that of Waechter and Binder 2019 ("A fast and robust method for avoiding self-intersection", Ray Tracing Gems,
//! chapter 6) and of Pharr, Jakob and Humphreys (PBRT 4, section 6.8): off the computed point along the normal by the bound on
//! its error, each coordinate rounded away from the surface. Here nothing rests on the bound: what comes out is asked, and
//! where it does not do, the step is doubled.

use glam::{DVec3, Vec3};

use super::sphere::SphereRay;
use super::{Interval, PrecisionMode, Ray, Sphere, Triangle, TriangleHit, TriangleRay};

/// Of the size of a surface, so little that nobody sees it, and so much that `f64` tells the side at once: its bound on `t`
/// is about 100 roundings, 2^-46 of the size, for a triangle as wide as high.
const LEAST_STEP: f64 = 1.0 / (1u64 << 40) as f64;

/// All of a ray ahead of its origin.
const AHEAD: Interval = Interval { t_min: 0.0, t_max: f32::INFINITY };

/// The first of ever longer steps that leads away. None where none does.
fn step_away(first: f64, origin: impl Fn(f64) -> Vec3, is_away: impl Fn(Vec3) -> bool) -> Option<Vec3> {
    /// As many lead from the least step to many times the size of the surface.
    const MOST_STEPS: i32 = 64;
    (0..MOST_STEPS).map(|doublings| origin(first * f64::powi(2.0, doublings))).find(|&origin| is_away(origin))
}

/// Each coordinate as a float, no less far in the direction than it was.
fn rounded_along(direction: DVec3, point: DVec3) -> Vec3 {
    let along = |axis: usize| {
        let nearest = point[axis] as f32;
        if direction[axis] > 0.0 && f64::from(nearest) < point[axis] {
            nearest.next_up()
        } else if direction[axis] < 0.0 && f64::from(nearest) > point[axis] {
            nearest.next_down()
        } else {
            nearest
        }
    };
    Vec3::new(along(0), along(1), along(2))
}

impl Triangle {
    /// An origin near `position`, which is off from a point of the triangle by `error` along each axis: strictly on the side of
    /// the plane that the direction leads to, and such that the ray from it does not hit the triangle. On the normal's side
    /// for a direction along the plane. None where no float does.
    ///
    /// `position` is off the plane by `sum |n_i| error_i` at the most, so the step, a little longer than that, leads to the
    /// side; it takes more only where roundings of the triangle itself, within its band, take a ray beside it for one through
    /// it, at a `t` that is none of the plane's.
    pub(crate) fn offset_origin<P: PrecisionMode>(&self, position: Vec3, error: Vec3, direction: Vec3) -> Option<Vec3> {
        let normal = self.certain_normal();
        let side: f64 = if self.side_of_direction(normal, direction) < 0.0 { -1.0 } else { 1.0 };
        let outward = side * normal.0.normalize();
        let bounds = self.bounds();
        let size = (bounds.upper.as_dvec3() - bounds.lower.as_dvec3()).max_element();
        let first = outward.abs().dot(error.as_dvec3()) + LEAST_STEP * size;
        step_away(
            first,
            |step| rounded_along(outward, position.as_dvec3() + step * outward),
            |origin| {
                let ray = Ray { origin, t_min: AHEAD.t_min, direction, t_max: AHEAD.t_max };
                side * self.side_of_point(origin.to_array()) > 0.0
                    && TriangleRay::new(&ray).hit::<P>(self, AHEAD).is_none()
            },
        )
    }
}

impl Sphere {
    /// As [`Triangle::offset_origin`]: strictly outside for a direction that leads outward or along the surface, and such that
    /// the ray does not hit the sphere; else strictly inside, and such that the ray hits it ahead alone, where it leaves it.
    ///
    /// A position off by `error` from a point of the sphere is no further from it than that is long. From the inside no step
    /// leads beyond the centre.
    pub(crate) fn offset_origin(&self, position: Vec3, error: Vec3, direction: Vec3) -> Option<Vec3> {
        let centre = DVec3::from_array(self.centre.map(f64::from));
        let from_centre = position.as_dvec3() - centre;
        let is_outside = from_centre.dot(direction.as_dvec3()) >= 0.0;
        // A sphere may be so small that its points round to its centre.
        let along = if from_centre == DVec3::ZERO { direction.as_dvec3() } else { from_centre };
        let outward = if is_outside { along.normalize() } else { -along.normalize() };
        let first = error.as_dvec3().length() + LEAST_STEP * f64::from(self.radius);
        step_away(
            first,
            |step| {
                let is_beyond = !is_outside && step >= from_centre.length();
                let target = if is_beyond { centre } else { position.as_dvec3() + step * outward };
                rounded_along(outward, target)
            },
            |origin| {
                let ray = Ray { origin, t_min: AHEAD.t_min, direction, t_max: AHEAD.t_max };
                let hit = self.hit(&SphereRay::new(&ray), AHEAD);
                match self.side_of_point(origin) {
                    side if side > 0.0 => is_outside && hit.is_none(),
                    side if side < 0.0 => !is_outside && matches!(hit, Some(TriangleHit { t, .. }) if t > 0.0),
                    _ => false,
                }
            },
        )
    }
}
