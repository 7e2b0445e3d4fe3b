//! Spheres, and where a ray meets one.
//!
//! With `w` the origin seen from the centre, hits are the roots of `a t^2 + 2 h t + k`, `a = d.d`, `h = w.d`,
//! `k = w.w - r^2`. In `f64`, the discriminant is `a D` with `D = r^2 - |w - (h/a) d|^2`, which does not cancel for small
//! spheres far away, and one root is `q / a`, the other one `k / q`, with `q = -h -+ sqrt(a D)`, which add up
//! (Haines, Guenther, Akenine-Moeller 2019, "Precision improvements for ray/sphere intersection", Ray Tracing Gems,
//! chapter 7). Where a bound on the error is too large everything is computed in twice the precision, and exactly where
//! that is not enough either.

use glam::{DVec3, Vec3};

use super::{Aabb, Interval, Ray, TriangleHit};
use crate::math::{DoubleDouble, Expansion};

/// A sphere as every structure stores it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Sphere {
    pub(crate) centre: [f32; 3],
    /// Above 0; nothing hits one of radius 0.
    pub(crate) radius: f32,
    pub(crate) geometry_id: u32,
    pub(crate) primitive_id: u32,
}

/// A ray made ready for spheres.
#[derive(Clone, Copy, Debug)]
pub(crate) struct SphereRay {
    origin: [f32; 3],
    pub(super) direction: [f32; 3],
    d: DVec3,
    /// `d.d`, and its inverse.
    a: f64,
    per_a: f64,
}

/// Relative to what it bounds, an error so small that `t` is within 0.51 ulp.
const RELATIVE_ERROR: f64 = 1.0 / (1u64 << 30) as f64;
const E: f64 = f64::EPSILON / 2.0;

/// What is known of a ray's two meetings with a sphere.
enum Roots {
    None,
    /// In their order along the ray.
    Two([f64; 2]),
    Uncertain,
}

impl Sphere {
    /// Whether everything is finite and the radius not below 0.
    pub(crate) fn is_valid(&self) -> bool {
        self.centre.iter().all(|c| c.is_finite()) && self.radius.is_finite() && self.radius >= 0.0
    }

    /// Rounded outward.
    pub(crate) fn bounds(&self) -> Aabb {
        let (centre, radius) = (Vec3::from_array(self.centre).as_dvec3(), f64::from(self.radius));
        // A sum of two floats may need more than 53 bits, so it is rounded twice: one step further covers that.
        let below = (centre - radius).to_array().map(|v| (v as f32).next_down().max(f32::MIN));
        let above = (centre + radius).to_array().map(|v| (v as f32).next_up().min(f32::MAX));
        Aabb { lower: Vec3::from_array(below), upper: Vec3::from_array(above) }
    }

    /// Whether the surface has a point in the closed box; may say so of one that passes within a rounding.
    ///
    /// It has where the box's nearest point to the centre is no further than the radius and its farthest no nearer. Squares
    /// of distances make six roundings.
    pub(crate) fn overlaps(&self, lower: DVec3, upper: DVec3) -> bool {
        let centre = DVec3::from_array(self.centre.map(f64::from));
        let (below, above) = (lower - centre, centre - upper);
        let nearest = below.max(above).max(DVec3::ZERO).length_squared();
        let farthest = below.abs().max(above.abs()).length_squared();
        let square = f64::from(self.radius) * f64::from(self.radius);
        let error = 8.0 * E * (farthest + square);
        nearest <= square + error && farthest >= square - error
    }

    /// From the centre to the hit: as long as the radius, outward on either side.
    pub(crate) fn normal_at(&self, ray: &Ray, t: f32) -> Vec3 {
        let from_centre = ray.origin.as_dvec3() - Vec3::from_array(self.centre).as_dvec3();
        (from_centre + f64::from(t) * ray.direction.as_dvec3()).as_vec3()
    }

    /// Above 0 outside, below 0 inside, 0 on the surface. Exact.
    pub(super) fn side_of_point(&self, point: Vec3) -> f64 {
        let from_centre = point.as_dvec3() - DVec3::from_array(self.centre.map(f64::from));
        let (ww, rr) = (from_centre.length_squared(), f64::from(self.radius) * f64::from(self.radius));
        let k = ww - rr;
        if k.abs() > 8.0 * E * (ww + rr) {
            return k;
        }
        let w: [Expansion; 3] = std::array::from_fn(|axis| Expansion::difference(point[axis], self.centre[axis]));
        let radius = Expansion::difference(self.radius, 0.0);
        (&w[0] * &w[0] + &w[1] * &w[1] + &w[2] * &w[2] - &radius * &radius).to_f64()
    }

    /// In `f64`. With `e` its roundoff: `h` is off by `4 e sum |w_i d_i|` at most, each component of `w - (h/a) d` by
    /// `11 e |w|`, hence `D` by `40 e |w| |q| + 400 e^2 w.w + 5 e q.q`, and `k` by `8 e (w.w + r^2)`.
    #[inline(always)]
    fn roots(&self, ray: &SphereRay) -> Roots {
        let w = DVec3::from_array(ray.origin.map(f64::from)) - DVec3::from_array(self.centre.map(f64::from));
        let radius = f64::from(self.radius);
        let (ww, rr) = (w.length_squared(), radius * radius);
        let h = w.dot(ray.d);
        let beside = w - ray.d * (h * ray.per_a);
        let qq = beside.length_squared();
        let d = rr - qq;
        // Far outside, without the square root.
        if d < -rr - ww * RELATIVE_ERROR {
            return Roots::None;
        }
        let bound = 64.0 * E * ((ww * qq).sqrt() + qq + 16.0 * E * ww);
        if d < -bound {
            return Roots::None;
        }
        let root = (d * ray.a).sqrt();
        let q = -(h + root.copysign(h));
        let h_bound = 4.0 * E * w.abs().dot(ray.d.abs());
        let is_certain = bound <= RELATIVE_ERROR * d && h_bound <= RELATIVE_ERROR * q.abs();
        let k = ww - rr;
        let k_bound = 8.0 * E * (ww + rr);
        if !is_certain || k_bound > RELATIVE_ERROR * k.abs() {
            return Roots::Uncertain;
        }
        in_order(q * ray.per_a, k / q)
    }

    /// In twice the precision, of which the discriminant is off by 64 roundings of `a (w.w + r^2)` at most.
    #[cold]
    #[inline(never)]
    fn roots_slowly(&self, ray: &SphereRay) -> Roots {
        const U: f64 = DoubleDouble::UNIT_ROUNDOFF;
        let line = self.line(ray);
        let (discriminant, size) = (line.discriminant().to_f64(), line.size());
        let (a, h, k) = (line.a.to_f64(), line.h.to_f64(), (line.ww - line.rr).to_f64());
        let bound = 64.0 * U * a * size;
        if discriminant < -bound {
            return Roots::None;
        }
        let q = -(h + discriminant.sqrt().copysign(h));
        let h_bound = 8.0 * U * (a * size).sqrt();
        let is_certain = bound <= RELATIVE_ERROR * discriminant
            && h_bound <= RELATIVE_ERROR * q.abs()
            && 16.0 * U * size <= RELATIVE_ERROR * k.abs();
        if is_certain { in_order(q / a, k / q) } else { self.roots_exactly(ray) }
    }

    pub(super) fn line(&self, ray: &SphereRay) -> Line {
        let difference =
            |axis: usize| DoubleDouble::difference(f64::from(ray.origin[axis]), f64::from(self.centre[axis]));
        let w = [difference(0), difference(1), difference(2)];
        let d = ray.direction.map(|d| DoubleDouble::from(f64::from(d)));
        let dot = |p: [DoubleDouble; 3], q: [DoubleDouble; 3]| p[0] * q[0] + p[1] * q[1] + p[2] * q[2];
        let radius = DoubleDouble::from(f64::from(self.radius));
        Line { w, d, a: dot(d, d), h: dot(w, d), ww: dot(w, w), rr: radius * radius }
    }

    fn roots_exactly(&self, ray: &SphereRay) -> Roots {
        let w: [Expansion; 3] = std::array::from_fn(|axis| Expansion::difference(ray.origin[axis], self.centre[axis]));
        let d = ray.direction.map(|d| Expansion::difference(d, 0.0));
        let radius = Expansion::difference(self.radius, 0.0);
        let dot = |p: &[Expansion; 3], q: &[Expansion; 3]| &p[0] * &q[0] + &p[1] * &q[1] + &p[2] * &q[2];
        let (a, h, k) = (dot(&d, &d), dot(&w, &d), dot(&w, &w) - &radius * &radius);
        let discriminant = (&h * &h - &a * &k).to_f64();
        if discriminant < 0.0 {
            return Roots::None;
        }
        let (a, h, k) = (a.to_f64(), h.to_f64(), k.to_f64());
        let q = -(h + discriminant.sqrt().copysign(h));
        // Tangent at the origin itself: both roots are 0.
        if q == 0.0 { Roots::Two([0.0; 2]) } else { in_order(q / a, k / q) }
    }

    /// Where the line of the ray meets the closed surface, in their order along it, decided exactly; within 0.51 ulp when rounded.
    #[inline(always)]
    pub(super) fn meetings(&self, ray: &SphereRay) -> Option<[f64; 2]> {
        match self.roots(ray) {
            Roots::None => None,
            Roots::Two(roots) => Some(roots),
            Roots::Uncertain => match self.roots_slowly(ray) {
                Roots::Two(roots) => Some(roots),
                Roots::None | Roots::Uncertain => None,
            },
        }
    }

    /// The first of them in the closed interval.
    #[inline(always)]
    pub(crate) fn hit(&self, ray: &SphereRay, interval: Interval) -> Option<TriangleHit> {
        let is_hit = |t: f64| interval.contains(t as f32) && (t as f32).is_finite();
        let first = self.meetings(ray)?.into_iter().find(|&t| is_hit(t));
        first.map(|t| TriangleHit { t: t as f32, u: 0.0, v: 0.0 })
    }

    /// The one with the other's `t` is the same hit.
    #[inline(always)]
    pub(crate) fn each_hit(&self, ray: &SphereRay, interval: Interval, mut then: impl FnMut(TriangleHit)) {
        let Some([enter, leave]) = self.meetings(ray).map(|meetings| meetings.map(|t| t as f32)) else { return };
        for t in [Some(enter), Some(leave).filter(|&leave| leave != enter)].into_iter().flatten() {
            if interval.contains(t) && t.is_finite() {
                then(TriangleHit { t, u: 0.0, v: 0.0 });
            }
        }
    }
}

/// A line seen from the centre, in twice the precision of `f64`.
pub(super) struct Line {
    pub(super) w: [DoubleDouble; 3],
    pub(super) d: [DoubleDouble; 3],
    /// `d.d`, `w.d`, `w.w` and `r^2`.
    pub(super) a: DoubleDouble,
    pub(super) h: DoubleDouble,
    ww: DoubleDouble,
    rr: DoubleDouble,
}

impl Line {
    pub(super) fn discriminant(&self) -> DoubleDouble {
        self.h * self.h - self.a * (self.ww - self.rr)
    }

    /// What errors are relative to.
    pub(super) fn size(&self) -> f64 {
        self.ww.to_f64() + self.rr.to_f64()
    }
}

/// What planes leave of a sphere: of the whole sphere in a box, which planes across axes cut.
#[derive(Clone, Copy, Debug)]
pub(crate) struct SpherePart {
    centre: DVec3,
    radius: f64,
    lower: DVec3,
    upper: DVec3,
}

impl SpherePart {
    pub(crate) fn of(sphere: &Sphere) -> Self {
        let (centre, bounds) = (DVec3::from_array(sphere.centre.map(f64::from)), sphere.bounds());
        let (lower, upper) = (bounds.lower.as_dvec3(), bounds.upper.as_dvec3());
        Self { centre, radius: f64::from(sphere.radius), lower, upper }
    }

    /// The part where `height`, an affine function, is not positive, or more; `None` where there is no point of it.
    pub(crate) fn below(&self, height: impl Fn(DVec3) -> f64) -> Option<Self> {
        if self.extent(&height).0 > 0.0 {
            return None;
        }
        let mut part = *self;
        let slope = self.slope(&height);
        for axis in 0..3 {
            // A plane across this axis: the others do not count.
            if slope[axis] != 0.0 && slope[(axis + 1) % 3] == 0.0 && slope[(axis + 2) % 3] == 0.0 {
                let at_centre = height(self.centre);
                let plane = self.centre[axis] - at_centre / slope[axis];
                let error = 16.0 * E * (plane.abs() + self.centre[axis].abs() + self.radius);
                if slope[axis] > 0.0 {
                    part.upper[axis] = part.upper[axis].min(plane + error).max(part.lower[axis]);
                } else {
                    part.lower[axis] = part.lower[axis].max(plane - error).min(part.upper[axis]);
                }
            }
        }
        Some(part)
    }

    /// The least and the greatest height, or beyond.
    pub(crate) fn extent(&self, height: impl Fn(DVec3) -> f64) -> (f64, f64) {
        let slope = self.slope(&height);
        let around = |centre: DVec3, reach: f64| {
            let middle = height(centre);
            let reach = reach + 16.0 * E * (middle.abs() + reach + slope.abs().dot(centre.abs()));
            (middle - reach, middle + reach)
        };
        let of_sphere = around(self.centre, slope.length() * self.radius);
        let half = 0.5 * (self.upper - self.lower);
        let of_box = around(self.lower + half, slope.abs().dot(half));
        (of_sphere.0.max(of_box.0), of_sphere.1.min(of_box.1))
    }

    pub(crate) fn bounds(&self) -> (DVec3, DVec3) {
        (self.lower, self.upper)
    }

    /// How much a height grows along each axis: over a distance in which the centre's rounding does not show.
    fn slope(&self, height: impl Fn(DVec3) -> f64) -> DVec3 {
        let at = |axis: DVec3| height(axis) - height(DVec3::ZERO);
        DVec3::new(at(DVec3::X), at(DVec3::Y), at(DVec3::Z))
    }
}

fn in_order(s: f64, t: f64) -> Roots {
    Roots::Two(if s <= t { [s, t] } else { [t, s] })
}

impl SphereRay {
    /// Expects a valid ray.
    #[inline(always)]
    pub(crate) fn new(ray: &Ray) -> Self {
        let d = ray.direction.as_dvec3();
        let a = d.length_squared();
        Self { origin: ray.origin.to_array(), direction: ray.direction.to_array(), d, a, per_a: 1.0 / a }
    }
}

#[cfg(test)]
mod tests {
    use num_bigint::BigInt;
    use num_rational::BigRational;
    use proptest::prelude::*;

    use super::*;

    const WHOLE_LINE: Interval = Interval { t_min: f32::NEG_INFINITY, t_max: f32::INFINITY };

    fn rational(value: f64) -> BigRational {
        BigRational::from_float(value).expect("finite")
    }

    /// `a t^2 + 2 h t + k` and its discriminant, exactly.
    fn exact(ray: &Ray, sphere: &Sphere) -> ([BigRational; 3], BigRational) {
        let [w, d] = [0, 1].map(|which| -> [BigRational; 3] {
            std::array::from_fn(|axis| {
                let (o, c, d) = (ray.origin[axis], sphere.centre[axis], ray.direction[axis]);
                if which == 0 { rational(o.into()) - rational(c.into()) } else { rational(d.into()) }
            })
        });
        let dot = |p: &[BigRational; 3], q: &[BigRational; 3]| &p[0] * &q[0] + &p[1] * &q[1] + &p[2] * &q[2];
        let radius = rational(sphere.radius.into());
        let (a, h, k) = (dot(&d, &d), dot(&w, &d), dot(&w, &w) - &radius * &radius);
        let discriminant = &h * &h - &a * &k;
        ([a, h, k], discriminant)
    }

    /// Whether a root of the polynomial lies within `ulps` of `t`: its value changes sign there, or is a double root.
    fn has_root_near([a, h, k]: &[BigRational; 3], t: f32, ulps: f64) -> bool {
        let two = BigRational::from_integer(BigInt::from(2));
        let zero = BigRational::from_integer(BigInt::from(0));
        let value = |t: &BigRational| (a * t + &two * h) * t + k;
        let ulp = f64::from(t.abs().max(f32::MIN_POSITIVE).next_up()) - f64::from(t.abs().max(f32::MIN_POSITIVE));
        let (below, above) = (rational(f64::from(t) - ulps * ulp), rational(f64::from(t) + ulps * ulp));
        let vertex = -h / a;
        let (at_below, at_above) = (value(&below), value(&above));
        (at_below <= zero) != (at_above < zero) || (below <= vertex && vertex <= above && value(&vertex) <= zero)
    }

    fn coordinate() -> impl Strategy<Value = f32> {
        (-1f32..1.0, -20i32..10).prop_map(|(mantissa, exponent)| mantissa * 2f32.powi(exponent))
    }

    fn point() -> impl Strategy<Value = [f32; 3]> {
        [coordinate(), coordinate(), coordinate()]
    }

    /// Rays at the sphere, past it, tangent to within roundings, and from its surface.
    fn check(sphere: &Sphere, origin: Vec3, target: Vec3) -> Result<(), TestCaseError> {
        let ray = Ray { origin, t_min: f32::NEG_INFINITY, direction: target - origin, t_max: f32::INFINITY };
        prop_assume!(ray.is_valid() && sphere.radius > 0.0);
        let (polynomial, discriminant) = exact(&ray, sphere);
        let zero = BigRational::from_integer(BigInt::from(0));
        let prepared = SphereRay::new(&ray);
        let hit = sphere.hit(&prepared, WHOLE_LINE);
        prop_assert_eq!(hit.is_some(), discriminant >= zero);
        let Some(TriangleHit { t: first, .. }) = hit else { return Ok(()) };
        prop_assert!(has_root_near(&polynomial, first, 0.51), "{first:e} {:?}", polynomial);
        let later = Interval { t_min: first.next_up(), t_max: f32::INFINITY };
        if let Some(TriangleHit { t: second, .. }) = sphere.hit(&prepared, later) {
            prop_assert!(has_root_near(&polynomial, second, 0.51), "{second:e}");
        }
        Ok(())
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(3000))]

        #[test]
        fn hits_are_decided_exactly_and_within_half_an_ulp(
            centre in point(),
            radius in coordinate(),
            origin in point(),
            towards in point(),
        ) {
            let sphere = Sphere { centre, radius: radius.abs(), geometry_id: 0, primitive_id: 0 };
            let target = Vec3::from_array(centre) + Vec3::from_array(towards).normalize_or_zero() * radius;
            check(&sphere, Vec3::from_array(origin), target)?;
        }

        #[test]
        fn tangents_and_rays_from_the_surface_are_no_different(
            centre in point(),
            radius in coordinate(),
            outward in point(),
            along in point(),
        ) {
            let sphere = Sphere { centre, radius: radius.abs(), geometry_id: 0, primitive_id: 0 };
            let outward = Vec3::from_array(outward).normalize_or_zero();
            let on_surface = Vec3::from_array(centre) + outward * sphere.radius;
            let tangent = outward.cross(Vec3::from_array(along).normalize_or_zero());
            check(&sphere, on_surface - tangent * sphere.radius * 3.0, on_surface)?;
            check(&sphere, on_surface, on_surface + tangent * sphere.radius)?;
            check(&sphere, on_surface, Vec3::from_array(along))?;
        }
    }

    #[test]
    fn surface_overlaps_the_boxes_that_it_passes_through() {
        let sphere = Sphere { centre: [1.0, 0.0, 0.0], radius: 2.0, geometry_id: 0, primitive_id: 0 };
        let overlaps = |lower: [f64; 3], upper: [f64; 3]| sphere.overlaps(lower.into(), upper.into());
        assert!(overlaps([2.5, -0.1, -0.1], [3.5, 0.1, 0.1]), "across");
        assert!(overlaps([3.0, 0.0, 0.0], [4.0, 1.0, 1.0]), "touched from outside");
        assert!(overlaps([-9.0; 3], [9.0; 3]), "around");
        assert!(!overlaps([0.5, -0.5, -0.5], [1.5, 0.5, 0.5]), "inside");
        assert!(!overlaps([2.2, 1.7, 0.0], [3.0, 2.0, 1.0]), "beside, in the corner of its box");
    }

    #[test]
    fn a_ray_from_inside_hits_the_far_side() {
        let sphere = Sphere { centre: [1.0, 2.0, 3.0], radius: 2.0, geometry_id: 4, primitive_id: 5 };
        let ray = Ray { origin: Vec3::new(1.0, 2.0, 3.0), t_min: 0.0, direction: Vec3::new(0.0, 4.0, 0.0), t_max: 9.0 };
        let hit = sphere.hit(&SphereRay::new(&ray), Interval { t_min: 0.0, t_max: 9.0 }).expect("it is around");
        assert_eq!(hit.t, 0.5);
        assert_eq!(sphere.normal_at(&ray, hit.t), Vec3::new(0.0, 2.0, 0.0));
        assert!(sphere.hit(&SphereRay::new(&ray), Interval { t_min: 0.0, t_max: 0.49 }).is_none());
    }
}
