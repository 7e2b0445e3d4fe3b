//! Single rays and triangles, by all precisions.

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
    let ray = Ray { origin, t_min: 0.0, direction: Vec3::new(0.704_826, 0.409_943, 0.578_971), t_max: f32::INFINITY };
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
        assert!(is_near(hit.u, &u, uv_bound) && is_near(hit.v, &v, uv_bound), "{ray:?}: u {:e} v {:e}", hit.u, hit.v);
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
