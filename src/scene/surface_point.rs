//! Where a ray hit, as a point that other rays can leave from.

use glam::Vec3;

use super::{Content, Scene, SurfaceError};
use crate::accel::{AnyPrimitive, OutOfMemory, Precision};
use crate::geometry::{Accurate, Exact, Fast, Hit, HitPoint, Ray};

/// A hit's point, a bound on its error, and what it takes to leave the surface there.
#[derive(Clone, Copy, Debug)]
pub struct SurfacePoint {
    /// The hit's point, rounded once from `f64`.
    pub position: Vec3,
    /// Along each axis the surface's point, which the exact ray meets, is no further from `position` than this. Where
    /// [`Precision::Fast`] or [`Precision::Accurate`] took a triangle that the exact ray passes within the band, it is a point
    /// of the triangle within the band of the ray.
    pub error: Vec3,
    /// Of unit length, on the side that [`Hit::normal`] points to; of a triangle within 0.51 x 2^-24 in each component.
    pub normal: Vec3,
    /// What it is a point of; its ids have no meaning.
    pub(crate) surface: AnyPrimitive,
    /// Of the scene.
    pub(crate) precision: Precision,
}

impl SurfacePoint {
    fn rounded(point: &HitPoint, surface: AnyPrimitive, precision: Precision) -> Self {
        let position = point.position.as_vec3();
        // What this rounding did is known, and exactly, as numbers are so near. The bound is a sum of a few roundings itself.
        let error = (position.as_dvec3() - point.position).abs() + point.error * (1.0 + 8.0 * f64::EPSILON);
        let error = Vec3::from_array(error.to_array().map(rounded_up));
        Self { position, error, normal: point.normal.as_vec3(), surface, precision }
    }

    /// An origin for a ray with that direction and `t_min` 0: strictly on the side of the surface that the direction leads
    /// to, such that a scene of the same precision does not answer the ray with the surface that it leaves, and off it by
    /// little more than `error`. A ray into a sphere hits it where it leaves it, and only there.
    pub fn offset_origin(&self, direction: Vec3) -> Result<Vec3, SurfaceError> {
        if !direction.is_finite() || direction == Vec3::ZERO {
            return Err(SurfaceError::NoDirection { direction: direction.to_array() });
        }
        let (position, error) = (self.position, self.error);
        let origin = match (&self.surface, self.precision) {
            (AnyPrimitive::Sphere(sphere), _) => sphere.offset_origin(position, error, direction),
            (AnyPrimitive::Triangle(triangle), Precision::Fast) => {
                triangle.offset_origin::<Fast>(position, error, direction)
            }
            (AnyPrimitive::Triangle(triangle), Precision::Accurate) => {
                triangle.offset_origin::<Accurate>(position, error, direction)
            }
            (AnyPrimitive::Triangle(triangle), Precision::Exact) => {
                triangle.offset_origin::<Exact>(position, error, direction)
            }
        };
        origin.ok_or(SurfaceError::NoOrigin)
    }
}

impl Scene {
    /// The point where the ray hit, `hit` being what this scene answered to it: computed anew from the ray and the surface.
    ///
    /// The first call makes a table of four bytes for each triangle and sphere, which the scene keeps.
    pub fn surface_point(&self, ray: &Ray, hit: &Hit) -> Result<SurfacePoint, SurfaceError> {
        if !hit.is_hit() {
            return Err(SurfaceError::Miss);
        }
        if !ray.is_valid() {
            return Err(SurfaceError::InvalidRay);
        }
        let (geometry_id, primitive_id) = (hit.geometry_id, hit.primitive_id);
        let surface = self.primitive(self.copies.stored((geometry_id, primitive_id)))?;
        let surface = surface.ok_or(SurfaceError::NotInScene { geometry_id, primitive_id })?;
        let point = match &surface {
            AnyPrimitive::Triangle(triangle) => triangle.hit_point(ray),
            AnyPrimitive::Sphere(sphere) => sphere.hit_point(ray, hit.t),
        };
        let point = point.ok_or(SurfaceError::Passed { geometry_id, primitive_id })?;
        Ok(SurfacePoint::rounded(&point, surface, self.precision))
    }

    fn primitive(&self, ids: (u32, u32)) -> Result<Option<AnyPrimitive>, OutOfMemory> {
        let triangle = match &self.content {
            Content::Spheres(_) => None,
            Content::Triangles(triangles) => self.triangle_places.find(triangles, ids)?,
            Content::Both(both) => self.triangle_places.find(&both.0, ids)?,
        };
        if let Some(triangle) = triangle {
            return Ok(Some(AnyPrimitive::Triangle(triangle)));
        }
        let sphere = match &self.content {
            Content::Triangles(_) => None,
            Content::Spheres(spheres) => self.sphere_places.find(spheres, ids)?,
            Content::Both(both) => self.sphere_places.find(&both.1, ids)?,
        };
        Ok(sphere.map(AnyPrimitive::Sphere))
    }
}

fn rounded_up(value: f64) -> f32 {
    let nearest = value as f32;
    if f64::from(nearest) < value { nearest.next_up() } else { nearest }
}

#[cfg(test)]
mod tests {
    use num_rational::BigRational;
    use proptest::prelude::*;

    use super::*;
    use crate::geometry::rational::{Vector, along, cross, dot, exact, magnitude, minus, zero};
    use crate::geometry::{Interval, PrecisionMode, Sphere, SphereRay, Triangle, TriangleRay};

    const AHEAD: Interval = Interval { t_min: 0.0, t_max: f32::INFINITY };

    fn unit() -> impl Strategy<Value = Vec3> {
        [-1f32..1.0, -1f32..1.0, -1f32..1.0].prop_map(|v| Vec3::from_array(v).normalize_or(Vec3::X))
    }

    /// Of lengths that renderers have, and of others.
    fn direction() -> impl Strategy<Value = Vec3> {
        (unit(), prop_oneof![3 => 0i32..1, 1 => -60i32..60]).prop_map(|(unit, exponent)| unit * 2f32.powi(exponent))
    }

    /// Vertices, and how far off the ray begins, in sizes of the triangle.
    fn triangle() -> impl Strategy<Value = ([Vec3; 3], f32)> {
        let corners = |scale: f32| [unit(), unit(), unit()].prop_map(move |v| v.map(|v| v * scale));
        let needle = (unit(), unit(), unit(), 3i32..8, 0f32..1.0).prop_map(|(tail, along, across, thinness, foot)| {
            [tail, tail + along, tail + foot * along + 10f32.powi(-thinness) * across]
        });
        let floor =
            (corners(1000.0), -3f32..3.0).prop_map(|(v, height)| v.map(|v| Vec3::new(v.x, v.y, height.trunc())));
        let mixed = [(unit(), -20i32..6), (unit(), -20i32..6), (unit(), -20i32..6)]
            .prop_map(|v| v.map(|(v, exponent)| v * 2f32.powi(exponent)));
        prop_oneof![
            (corners(1.0), Just(1.0)),
            (needle, Just(1.0)),
            (corners(1e6), Just(1.0)),
            (corners(1e6), Just(1e-6)),
            (corners(1.0), Just(1e5)),
            (corners(1e-3).prop_map(|v| v.map(|v| v + Vec3::new(0.7, -0.2, 0.4))), Just(1.0)),
            (corners(1e-30), Just(1.0)),
            (corners(2f32.powi(-140)), Just(1.0)),
            (floor, Just(1.0)),
            (mixed, Just(1.0)),
        ]
    }

    fn point_on(triangle: &Triangle, ray: &Ray) -> Option<SurfacePoint> {
        let point = triangle.hit_point(ray)?;
        Some(SurfacePoint::rounded(&point, AnyPrimitive::Triangle(*triangle), Precision::Accurate))
    }

    /// A triangle with area, and a ray at a point of it.
    fn aimed((vertices, distance): ([Vec3; 3], f32), from: Vec3, weights: (f32, f32)) -> Option<(Triangle, Ray)> {
        let triangle = Triangle::new(vertices.map(|v| v.to_array()), 0, 0);
        let [a, b, c] = vertices;
        let (u, v) = if weights.0 + weights.1 > 1.0 { (1.0 - weights.0, 1.0 - weights.1) } else { weights };
        let target = a + u * (b - a) + v * (c - a);
        let size = (b - a).abs().max((c - a).abs()).max_element();
        let origin = target + distance * size * from;
        let ray = Ray { origin, t_min: 0.0, direction: target - origin, t_max: f32::INFINITY };
        (ray.is_valid() && !triangle.has_zero_area()).then_some((triangle, ray))
    }

    struct Plane {
        point: Vector,
        normal: Vector,
    }

    impl Plane {
        fn of(triangle: &Triangle) -> Self {
            let [a, b, c] = triangle.vertices().map(exact);
            Self { normal: cross(&minus(&b, &a), &minus(&c, &a)), point: a }
        }

        fn height(&self, point: Vec3) -> BigRational {
            dot(&self.normal, &minus(&exact(point.to_array()), &self.point))
        }

        /// Where the ray meets it, if that is in the triangle.
        fn meets(&self, ray: &Ray, triangle: &Triangle) -> Option<Vector> {
            let (origin, direction) = (exact(ray.origin.to_array()), exact(ray.direction.to_array()));
            let per_t = dot(&self.normal, &direction);
            if per_t == zero() {
                return None;
            }
            let t = dot(&self.normal, &minus(&self.point, &origin)) / per_t;
            let met = along(&origin, &t, &direction);
            let [a, b, c] = triangle.vertices().map(exact);
            let is_left =
                |from: &Vector, to: &Vector| dot(&cross(&minus(to, from), &minus(&met, from)), &self.normal) >= zero();
            (is_left(&a, &b) && is_left(&b, &c) && is_left(&c, &a)).then_some(met)
        }
    }

    fn rational(value: f32) -> BigRational {
        BigRational::from_float(value).expect("finite")
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(4000))]

        #[test]
        fn error_bounds_the_distance_to_where_the_exact_ray_meets_the_triangle(
            shape in triangle(),
            from in unit(),
            weights in (0f32..1.0, 0f32..1.0),
        ) {
            let Some((triangle, ray)) = aimed(shape, from, weights) else { return Ok(()) };
            let Some(point) = point_on(&triangle, &ray) else { return Ok(()) };
            let plane = Plane::of(&triangle);
            let allowed: BigRational =
                (0..3).map(|axis| magnitude(&plane.normal[axis]) * rational(point.error[axis])).sum();
            prop_assert!(magnitude(&plane.height(point.position)) <= allowed, "off the plane");
            if let Some(met) = plane.meets(&ray, &triangle) {
                for (axis, met) in met.iter().enumerate() {
                    let distance = magnitude(&(met - rational(point.position[axis])));
                    prop_assert!(distance <= rational(point.error[axis]), "axis {axis} of {point:?}");
                }
            }
        }

        #[test]
        fn normal_is_within_its_bound(shape in triangle(), from in unit()) {
            let Some((triangle, ray)) = aimed(shape, from, (0.3, 0.3)) else { return Ok(()) };
            let Some(SurfacePoint { normal, .. }) = point_on(&triangle, &ray) else { return Ok(()) };
            // Its square is rational, and its sign that of the component.
            let exact = Plane::of(&triangle).normal;
            let square = dot(&exact, &exact);
            for axis in 0..3 {
                let bound = 0.51 / f64::from(1 << 24);
                let signed_square = |value: BigRational| &value * magnitude(&value);
                let limit = |value: f64| signed_square(BigRational::from_float(value).expect("finite")) * &square;
                let truth = signed_square(exact[axis].clone());
                let component = f64::from(normal[axis]);
                prop_assert!(limit(component - bound) <= truth && truth <= limit(component + bound), "{normal}");
            }
        }

        #[test]
        fn offset_origin_is_strictly_on_the_side_of_the_direction_and_not_far(
            shape in triangle(),
            from in unit(),
            weights in (0f32..1.0, 0f32..1.0),
            towards in direction(),
            flatness in prop_oneof![2 => Just(1.0f32), 1 => 1e-9f32..1e-2, 1 => Just(0.0)],
        ) {
            let Some((triangle, ray)) = aimed(shape, from, weights) else { return Ok(()) };
            let Some(point) = point_on(&triangle, &ray) else { return Ok(()) };
            // Along the surface but for a part.
            let along_normal = towards.dot(point.normal) * point.normal;
            let direction = towards - (1.0 - flatness) * along_normal;
            prop_assume!(direction.is_finite() && direction != Vec3::ZERO);
            let plane = Plane::of(&triangle);
            let side = if dot(&plane.normal, &exact(direction.to_array())) < zero() { -1.0 } else { 1.0 };
            for precision in [Precision::Fast, Precision::Accurate, Precision::Exact] {
                let origin = SurfacePoint { precision, ..point }.offset_origin(direction).expect("there is one");
                prop_assert!(plane.height(origin) * rational(side) > zero(), "{origin} is not off {triangle:?}");
                let next = Ray { origin, t_min: 0.0, direction, t_max: f32::INFINITY };
                match precision {
                    Precision::Fast => prop_assert!(misses::<Fast>(&triangle, &next)),
                    Precision::Accurate => prop_assert!(misses::<Accurate>(&triangle, &next)),
                    Precision::Exact => prop_assert!(misses::<Exact>(&triangle, &next)),
                }
            }
        }

        #[test]
        fn points_of_spheres_are_within_their_error_and_left_on_the_right_side(
            centre in unit(),
            scale in prop_oneof![Just(1.0f32), Just(1e6), Just(1e-3)],
            radius_exponent in -24i32..3,
            distance in prop_oneof![Just(2.0f32), Just(1e5)],
            from in unit(),
            beside in -1f32..1.0,
            towards in direction(),
        ) {
            let radius = scale * 2f32.powi(radius_exponent);
            let sphere = Sphere { centre: (scale * centre).to_array(), radius, geometry_id: 0, primitive_id: 0 };
            let origin = scale * centre + distance * radius * from;
            let target = scale * centre + radius * beside * from.any_orthonormal_vector();
            let ray = Ray { origin, t_min: 0.0, direction: target - origin, t_max: f32::INFINITY };
            prop_assume!(ray.is_valid());
            let Some(hit) = sphere.hit(&SphereRay::new(&ray), AHEAD) else { return Ok(()) };
            let point = sphere.hit_point(&ray, hit.t).expect("it is hit");
            let point = SurfacePoint::rounded(&point, AnyPrimitive::Sphere(sphere), Precision::Accurate);
            // The sphere passes through the box of the errors.
            let (c, r) = (exact(sphere.centre), rational(radius));
            let square = |grow: f32| -> BigRational {
                (0..3)
                    .map(|axis| {
                        let distance = magnitude(&(rational(point.position[axis]) - &c[axis]));
                        let reach = distance + rational(grow) * rational(point.error[axis]);
                        let reach = if reach < zero() { zero() } else { reach };
                        &reach * &reach
                    })
                    .sum()
            };
            prop_assert!(square(-1.0) <= &r * &r && &r * &r <= square(1.0), "{point:?}");

            let leaving = point.offset_origin(towards).expect("there is one");
            let from_centre = minus(&exact(leaving.to_array()), &c);
            let outside = dot(&from_centre, &from_centre) - &r * &r;
            let next = Ray { origin: leaving, t_min: 0.0, direction: towards, t_max: f32::INFINITY };
            let again = sphere.hit(&SphereRay::new(&next), AHEAD);
            if (point.position.as_dvec3() - Vec3::from_array(sphere.centre).as_dvec3()).dot(towards.as_dvec3()) >= 0.0 {
                prop_assert!(outside > zero() && again.is_none());
            } else {
                prop_assert!(outside < zero() && again.is_some_and(|hit| hit.t > 0.0));
            }
        }
    }

    fn misses<P: PrecisionMode>(triangle: &Triangle, ray: &Ray) -> bool {
        TriangleRay::new(ray).hit::<P>(triangle, AHEAD).is_none()
    }

    #[test]
    fn ray_along_the_surface_leaves_on_the_side_of_the_normal() {
        let triangle = Triangle::new([[0.0, 0.0, 1.0], [4.0, 0.0, 1.0], [0.0, 4.0, 1.0]], 0, 0);
        let ray = Ray { origin: Vec3::new(1.0, 1.0, 3.0), t_min: 0.0, direction: -Vec3::Z, t_max: f32::INFINITY };
        let point = point_on(&triangle, &ray).expect("it is hit");
        assert_eq!((point.position, point.normal), (Vec3::ONE, Vec3::Z));
        let origin = point.offset_origin(Vec3::X).expect("there is one");
        assert_eq!(origin, Vec3::new(1.0, 1.0, 1.0f32.next_up()));
        let origin = point.offset_origin(Vec3::new(1.0, 0.0, -f32::from_bits(1))).expect("there is one");
        assert_eq!(origin, Vec3::new(1.0, 1.0, 1.0f32.next_down()));
    }
}
