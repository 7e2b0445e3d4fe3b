//! Which triangles a ray hits, where, and in what order, decided exactly.
//!
//! With `a`, `b`, `c` the vertices relative to the origin, a point of the ray is `t d = A a + B b + C c`, where the weights sum to
//! one. Multiplied by `b x c`, and so on, that makes `A`, `B`, `C` of the determinants `(d, b, c)`, `(d, c, a)`, `(d, a, b)` over
//! their sum, and `t` of `(a, b, c)` over it. The closed triangle is hit where the three do not differ in sign and their sum is not
//! zero. All are polynomials in `f32`s, whose products and sums expansions hold: their bits lie between 2^-447 and 2^390, those of
//! the products that tell which `t` is less between 2^-894 and 2^780, all in the range of `f64`.
//!
//! Where doubled precision with a bound on its error is enough, nothing is computed exactly
//! (Shewchuk 1997, "Adaptive precision floating-point arithmetic and fast robust geometric predicates").

use std::cmp::Ordering;

use super::Triangle;
use super::evaluation::{Measured, RELATIVE_ERROR, Real};
use super::triangle_hit::{TriangleHit, TriangleRay};
use crate::math::{DoubleDouble, Expansion, nearest_quotient, rounds_alike};

/// What a number type can tell of a ray and a triangle.
enum Verdict {
    /// The ray passes it, for certain.
    Miss,
    /// The ray hits it for certain, within `t_error` of `t`: between those of its corners that have a weight, inside, on an edge or
    /// at a vertex.
    Hit {
        t: f64,
        t_error: f64,
        u: f64,
        v: f64,
        has_weight: [bool; 3],
    },
    Open,
}

impl Verdict {
    /// The hit, or that there is none; an error where that is open, or to which float `t` rounds.
    fn settled(self) -> Result<Option<TriangleHit>, Self> {
        match self {
            Self::Miss => Ok(None),
            Self::Hit { t, t_error, u, v, .. } if rounds_alike(t, t_error) => {
                Ok(Some(TriangleHit { t: t as f32, u: u as f32, v: v as f32 }))
            }
            open => Err(open),
        }
    }
}

impl TriangleRay {
    /// The hit of the line on the closed triangle, its `t` the float nearest to the exact one.
    #[cold]
    #[inline(never)]
    pub(super) fn hit_exactly(&self, triangle: &Triangle) -> Option<TriangleHit> {
        // In a plane across an axis, as rays along a floor are, or beside it.
        if (0..3).any(|at| self.direction[at] == 0.0 && triangle.lies_across(self.axes[at])) {
            return None;
        }
        self.verdict::<f64>(triangle)
            .settled()
            .or_else(|_| self.verdict::<DoubleDouble>(triangle).settled())
            .unwrap_or_else(|_| Meeting::of(self, triangle).hit())
    }

    /// The weights of the vertices where the line meets the plane, up to a common factor, each to within an ulp; all 0 where it
    /// runs in the plane.
    #[cold]
    pub(super) fn exact_weights(&self, triangle: &Triangle) -> [f64; 3] {
        Meeting::of(self, triangle).weights.map(|weight| weight.to_f64())
    }

    /// Whether the line meets the first of two triangles first, both hit; `otherwise` where it meets them in one point.
    #[cold]
    #[inline(never)]
    pub(crate) fn precedes(&self, first: &Triangle, second: &Triangle, otherwise: bool) -> bool {
        match self.order(first, second) {
            Ordering::Less => true,
            Ordering::Equal => otherwise,
            Ordering::Greater => false,
        }
    }

    fn order(&self, first: &Triangle, second: &Triangle) -> Ordering {
        // Both sides of a surface, and decals on planes across an axis: many scenes have those.
        const ALL: [bool; 3] = [true; 3];
        if first.corners_are_among(ALL, second, ALL) || first.lies_across_an_axis_with(second) {
            return Ordering::Equal;
        }
        let verdicts = (self.verdict::<DoubleDouble>(first), self.verdict::<DoubleDouble>(second));
        if let (
            Verdict::Hit { t, t_error, has_weight, .. },
            Verdict::Hit { t: other, t_error: other_error, has_weight: others_weight, .. },
        ) = verdicts
        {
            if (t - other).abs() > 2.0 * (t_error + other_error) {
                return t.total_cmp(&other);
            }
            // On an edge or at a vertex that they share.
            if first.corners_are_among(has_weight, second, others_weight)
                && second.corners_are_among(others_weight, first, has_weight)
            {
                return Ordering::Equal;
            }
        }
        if first.lies_in_plane_of(second) {
            return Ordering::Equal;
        }
        let (first, second) = (Meeting::of(self, first), Meeting::of(self, second));
        let difference = &first.volume * &second.sum() - &second.volume * &first.sum();
        let is_reversed = (first.sum().sign() == Ordering::Less) != (second.sum().sign() == Ordering::Less);
        if is_reversed { difference.sign().reverse() } else { difference.sign() }
    }

    /// See [`Measured`] for the bounds.
    fn verdict<R: Real>(&self, triangle: &Triangle) -> Verdict {
        let measured = Measured::<R>::of(self, triangle);
        let signs = measured.signs(self.grain(triangle));
        if signs.contains(&Some(Ordering::Less)) && signs.contains(&Some(Ordering::Greater)) {
            return Verdict::Miss;
        }
        let has_weight = signs.map(|sign| sign != Some(Ordering::Equal));
        if has_weight == [false; 3] {
            // It runs in the triangle's plane.
            return Verdict::Miss;
        }
        let [a, b, c] =
            std::array::from_fn(|corner| if has_weight[corner] { measured.weights[corner] } else { R::from(0.0) });
        let sum = (a + b + c).to_f64();
        let bound: f64 = measured.bounds.iter().sum();
        // What `u` and `v` need.
        if signs.contains(&None) || bound > RELATIVE_ERROR * sum.abs() {
            return Verdict::Open;
        }
        let [az, bz, cz] = measured.depths;
        let denominator = sum * measured.direction.to_f64();
        let t = (a * az + b * bz + c * cz).to_f64() / denominator;
        // Three roundings of f64, two of them of the parts.
        let t_error = measured.t_bound(sum.abs()) / denominator.abs() * 2.0 + t.abs() * (4.0 * f64::EPSILON);
        Verdict::Hit { t, t_error, u: b.to_f64() / sum, v: c.to_f64() / sum, has_weight }
    }

    /// Edge functions are multiples of this: a sheared coordinate `ax dz - dx az` is one of the grain of the vertices and the origin
    /// times that of the direction, and an edge function one of its square.
    fn grain(&self, triangle: &Triangle) -> f64 {
        let of_positions = triangle.axes.as_flattened().iter().chain(&self.origin[..3]).map(last_place).min();
        let of_direction = self.direction[..3].iter().map(last_place).min();
        of_positions.zip(of_direction).map_or(0.0, |(position, direction)| 2f64.powi(2 * (position + direction)))
    }
}

/// Of which power of two a number is a multiple. Of 0, which is one of all, 2^128.
fn last_place(value: &f32) -> i32 {
    const LEAST: i32 = -149;
    let (exponent, fraction) = (value.to_bits() >> 23 & 0xFF, value.to_bits() & 0x007F_FFFF);
    match (exponent, fraction) {
        (0, 0) => 128,
        (0, _) => LEAST + fraction.trailing_zeros() as i32,
        _ => LEAST + exponent as i32 - 1 + (fraction | 1 << 23).trailing_zeros() as i32,
    }
}

/// The determinants.
struct Meeting {
    weights: [Expansion; 3],
    volume: Expansion,
}

type Vector = [Expansion; 3];

impl Meeting {
    fn of(ray: &TriangleRay, triangle: &Triangle) -> Self {
        let (origin, direction) = (ray.in_scene(&ray.origin), ray.in_scene(&ray.direction));
        let vertex = |corner: usize| -> Vector {
            std::array::from_fn(|axis| Expansion::difference(triangle.axes[axis][corner], origin[axis]))
        };
        let direction: Vector = direction.map(|component| Expansion::difference(component, 0.0));
        let (a, b, c) = (vertex(0), vertex(1), vertex(2));
        let across = cross(&b, &c);
        Self {
            volume: dot(&a, &across),
            weights: [dot(&direction, &across), dot(&direction, &cross(&c, &a)), dot(&direction, &cross(&a, &b))],
        }
    }

    fn sum(&self) -> Expansion {
        let [a, b, c] = &self.weights;
        a.clone() + b.clone() + c.clone()
    }

    fn hit(&self) -> Option<TriangleHit> {
        let signs = self.weights.each_ref().map(Expansion::sign);
        let (any_less, any_greater) = (signs.contains(&Ordering::Less), signs.contains(&Ordering::Greater));
        // All zero: the ray runs in the triangle's plane.
        if any_less == any_greater {
            return None;
        }
        let sum = self.sum();
        let share = |corner: usize| (self.weights[corner].to_f64() / sum.to_f64()) as f32;
        Some(TriangleHit { t: nearest_quotient(&self.volume, &sum), u: share(1), v: share(2) })
    }
}

fn dot(p: &Vector, q: &Vector) -> Expansion {
    &p[0] * &q[0] + &p[1] * &q[1] + &p[2] * &q[2]
}

fn cross(p: &Vector, q: &Vector) -> Vector {
    let minor = |i: usize, j: usize| &p[i] * &q[j] - &p[j] * &q[i];
    [minor(1, 2), minor(2, 0), minor(0, 1)]
}

#[cfg(test)]
mod tests {
    use glam::Vec3;
    use num_bigint::BigInt;
    use num_rational::BigRational;
    use proptest::prelude::*;

    use super::super::Ray;
    use super::super::triangle_hit::{Exact, Interval};
    use super::*;

    const WHOLE_LINE: Interval = Interval { t_min: f32::NEG_INFINITY, t_max: f32::INFINITY };

    fn zero() -> BigRational {
        BigRational::from_integer(BigInt::from(0))
    }

    type Point = [BigRational; 3];

    fn rational_cross(p: &Point, q: &Point) -> Point {
        let minor = |i: usize, j: usize| &p[i] * &q[j] - &p[j] * &q[i];
        [minor(1, 2), minor(2, 0), minor(0, 1)]
    }

    fn rational_dot(p: &Point, q: &Point) -> BigRational {
        &p[0] * &q[0] + &p[1] * &q[1] + &p[2] * &q[2]
    }

    /// By solving `origin + t direction = a + u (b - a) + v (c - a)` in rationals.
    fn truth(ray: &Ray, vertices: &[[f32; 3]; 3]) -> Option<[BigRational; 3]> {
        let point = |p: [f32; 3]| p.map(|v| BigRational::from_float(v).expect("finite"));
        let minus = |p: &Point, q: &Point| -> Point { std::array::from_fn(|axis| &p[axis] - &q[axis]) };
        let [a, b, c] = vertices.map(point);
        let (origin, direction) = (point(ray.origin.to_array()), point(ray.direction.to_array()));
        let (ab, ac, ao) = (minus(&b, &a), minus(&c, &a), minus(&origin, &a));
        let across = rational_cross(&direction, &ac);
        let determinant = rational_dot(&ab, &across);
        if determinant == zero() {
            return None;
        }
        let along = rational_cross(&ao, &ab);
        let u = rational_dot(&ao, &across) / &determinant;
        let v = rational_dot(&direction, &along) / &determinant;
        let is_inside = u >= zero() && v >= zero() && &u + &v <= BigRational::from_integer(BigInt::from(1));
        is_inside.then(|| [rational_dot(&ac, &along) / determinant, u, v])
    }

    fn twice(value: &BigRational) -> BigRational {
        value * BigRational::from_integer(BigInt::from(2))
    }

    /// Whether no float is nearer to the truth than `value`; an infinity stands for the power of two after the last float.
    fn is_nearest(value: f32, truth: &BigRational) -> bool {
        let number = |value: f32| {
            let beyond = f64::from(2f32.powi(127)) * 2.0;
            let value = if value.is_finite() { f64::from(value) } else { beyond.copysign(value.into()) };
            BigRational::from_float(value).expect("finite")
        };
        // Both zeros have both neighbours.
        let value = value + 0.0;
        let below = value == f32::NEG_INFINITY || twice(truth) >= number(value.next_down()) + number(value);
        let above = value == f32::INFINITY || twice(truth) <= number(value.next_up()) + number(value);
        below && above
    }

    fn is_near(value: f32, truth: &BigRational) -> bool {
        let bound = BigRational::from_float(0.52 * f64::from(f32::EPSILON) / 2.0).expect("finite");
        let error = BigRational::from_float(value).expect("finite") - truth;
        -&bound <= error && error <= bound
    }

    fn check(ray: &Ray, vertices: [[f32; 3]; 3]) -> Result<(), TestCaseError> {
        let triangle = Triangle::new(vertices, 0, 0);
        let hit = TriangleRay::new(ray).hit::<Exact>(&triangle, WHOLE_LINE);
        let (Some([t, u, v]), false) = (truth(ray, &vertices), triangle.has_zero_area()) else {
            prop_assert!(hit.is_none(), "{ray:?} misses {vertices:?}, {hit:?}");
            return Ok(());
        };
        let Some(hit) = hit else {
            // A t beyond all floats is no hit.
            prop_assert!(is_nearest(f32::INFINITY, &t) || is_nearest(f32::NEG_INFINITY, &t), "{ray:?} {vertices:?}");
            return Ok(());
        };
        prop_assert!(is_nearest(hit.t, &t), "{ray:?} {vertices:?} t {:e}", hit.t);
        prop_assert!(is_near(hit.u, &u) && is_near(hit.v, &v), "{ray:?} {vertices:?} {hit:?}");
        Ok(())
    }

    /// With a random scale, so that triangles come as needles, far and near.
    fn coordinate() -> impl Strategy<Value = f32> + Clone {
        (-1f32..1.0, -20i32..6).prop_map(|(mantissa, exponent)| mantissa * 2f32.powi(exponent))
    }

    /// Small integers, so that rays meet edges, vertices and planes exactly.
    fn integer() -> impl Strategy<Value = f32> + Clone {
        (-3i8..=3).prop_map(f32::from)
    }

    /// Any finite float.
    fn any_float() -> impl Strategy<Value = f32> + Clone {
        any::<u32>().prop_map(f32::from_bits).prop_filter("finite", |value| value.is_finite())
    }

    fn point(coordinate: impl Strategy<Value = f32> + Clone) -> impl Strategy<Value = [f32; 3]> {
        [coordinate.clone(), coordinate.clone(), coordinate]
    }

    fn ray(origin: [f32; 3], direction: [f32; 3]) -> Ray {
        let (origin, direction) = (Vec3::from_array(origin), Vec3::from_array(direction));
        Ray { origin, t_min: f32::NEG_INFINITY, direction, t_max: f32::INFINITY }
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(3000))]

        #[test]
        fn rays_at_edges_are_decided_exactly(
            vertices in [point(coordinate()), point(coordinate()), point(coordinate())],
            origin in point(coordinate()),
            share in 0f32..=1.0,
        ) {
            let [a, b, _] = vertices.map(Vec3::from_array);
            let target = a + (b - a) * share;
            let ray = ray(origin, (target - Vec3::from_array(origin)).to_array());
            prop_assume!(ray.is_valid());
            check(&ray, vertices)?;
        }

        #[test]
        fn rays_among_integers_are_decided_exactly(
            vertices in [point(integer()), point(integer()), point(integer())],
            origin in point(integer()),
            direction in point(integer()),
        ) {
            let ray = ray(origin, direction);
            prop_assume!(ray.is_valid());
            check(&ray, vertices)?;
        }

        #[test]
        fn rays_of_any_floats_are_decided_exactly(
            vertices in [point(any_float()), point(any_float()), point(any_float())],
            origin in point(any_float()),
            share in (0f32..1.0, 0f32..1.0),
        ) {
            let [a, b, c] = vertices.map(Vec3::from_array);
            let target = a * (1.0 - share.0) + (b * (1.0 - share.1) + c * share.1) * share.0;
            let ray = ray(origin, (target * 0.5 - Vec3::from_array(origin) * 0.5).to_array());
            prop_assume!(ray.is_valid());
            check(&ray, vertices)?;
        }

        #[test]
        fn the_order_of_two_hits_is_exact(
            vertices in [point(coordinate()), point(coordinate()), point(coordinate())],
            apex in point(coordinate()),
            origin in point(coordinate()),
            share in 0f32..=1.0,
        ) {
            // Neighbours across an edge, seen at a point of it.
            let [a, b, c] = vertices.map(Vec3::from_array);
            let target = a + (b - a) * share;
            let ray = ray(origin, (target - Vec3::from_array(origin)).to_array());
            prop_assume!(ray.is_valid());
            let others = [a.to_array(), b.to_array(), apex];
            let (Some([t, ..]), Some([other_t, ..])) = (truth(&ray, &[a, b, c].map(|p| p.to_array())), truth(&ray, &others))
            else {
                return Ok(());
            };
            let (triangle, other) = (Triangle::new(vertices, 0, 0), Triangle::new(others, 0, 1));
            prop_assert_eq!(TriangleRay::new(&ray).order(&triangle, &other), t.cmp(&other_t));
        }
    }

    #[test]
    fn coplanar_triangles_are_met_in_one_point() {
        let ray = ray([0.1, 0.2, -1.0], [0.3, 0.1, 1.0]);
        let triangle = Triangle::new([[-1.0, -1.0, 0.5], [2.0, -1.0, 0.5], [0.0, 2.0, 0.5]], 0, 0);
        let other = Triangle::new([[-3.0, -1.0, 0.5], [2.0, -2.0, 0.5], [0.0, 4.0, 0.5]], 0, 1);
        assert_eq!(TriangleRay::new(&ray).order(&triangle, &other), Ordering::Equal);
        let slanted = Triangle::new([[-3.0, -1.0, 0.5], [2.0, -2.0, 0.5], [0.0, 4.0, 0.5f32.next_up()]], 0, 2);
        assert_eq!(TriangleRay::new(&ray).order(&triangle, &slanted), Ordering::Less);
        assert_eq!(TriangleRay::new(&ray).order(&slanted, &triangle), Ordering::Greater);
    }
}
