//! Solid angles [sr]: how much of the sphere of directions a shape covers.

use std::f64::consts::PI;

use glam::DVec3;

/// All directions.
pub const SPHERE_SR: f64 = 4.0 * PI;

/// `sin(theta) dtheta dphi`: of a small patch at the angle `theta` from the pole.
pub fn differential_sr(theta_rad: f64, dtheta_rad: f64, dphi_rad: f64) -> f64 {
    theta_rad.sin() * dtheta_rad * dphi_rad
}

/// The integral of [`differential_sr`] over a patch of latitude and longitude. As precise for thin patches as for wide ones.
pub fn patch_sr(theta_min_rad: f64, theta_max_rad: f64, phi_min_rad: f64, phi_max_rad: f64) -> f64 {
    // cos(a) - cos(b) = 2 sin((a + b) / 2) sin((b - a) / 2), without cancellation.
    let middle = 0.5 * (theta_min_rad + theta_max_rad);
    2.0 * middle.sin() * (0.5 * (theta_max_rad - theta_min_rad)).sin() * (phi_max_rad - phi_min_rad)
}

/// Of a circular cone around an axis: `2 pi (1 - cos)`, without cancellation; a NaN unless the half angle is in `[0, pi]`.
pub fn cone_sr(half_angle_rad: f64) -> f64 {
    if !(0.0..=PI).contains(&half_angle_rad) {
        return f64::NAN;
    }
    let sine = (0.5 * half_angle_rad).sin();
    4.0 * PI * sine * sine
}

/// Of a cap of a sphere, seen from the sphere's centre: `2 pi height / radius`; a NaN unless the height is in `[0, 2 radius]`.
pub fn cap_sr(height: f64, radius: f64) -> f64 {
    if !(0.0..=2.0 * radius).contains(&height) || radius <= 0.0 {
        return f64::NAN;
    }
    2.0 * PI * (height / radius)
}

/// Of a sphere whose centre is that far away: all directions from inside, half of them from its surface; a NaN where either is
/// negative or a NaN.
pub fn sphere_sr(distance: f64, radius: f64) -> f64 {
    if !(distance >= 0.0 && radius >= 0.0) {
        return f64::NAN;
    }
    if distance < radius {
        return SPHERE_SR;
    }
    if radius == 0.0 {
        return 0.0;
    }
    let sine = radius / distance;
    let cosine = ((1.0 - sine) * (1.0 + sine)).sqrt();
    2.0 * PI * sine * sine / (1.0 + cosine)
}

/// Of a triangle: 0 to `2 pi`, whichever way round its vertices go. `2 pi` from a point inside it, 0 from one of its plane outside it, and on
/// its border.
///
/// Relative error some `2^-50`; within a distance `d` of the triangle's edges, seen from so near that the vertices are `r` away, an absolute
/// one of `2^-50 r / d`.
/// Source: Van Oosterom and Strackee 1983, "The solid angle of a plane triangle", equation 8; the numerator from edges, so that it
/// does not cancel for a small triangle.
pub fn triangle_sr(point: DVec3, vertices: [DVec3; 3]) -> f64 {
    signed_triangle_sr(point, vertices).abs()
}

/// As [`triangle_sr`]; positive where the vertices go counter-clockwise, seen from the point.
pub(super) fn signed_triangle_sr(point: DVec3, vertices: [DVec3; 3]) -> f64 {
    let [a, b, c] = vertices;
    let (to_a, to_b, to_c) = (a - point, b - point, c - point);
    // Seen from where the normal points to, the vertices go counter-clockwise, and the rays to them against the normal.
    let volume = -to_a.dot((b - a).cross(c - a));
    let (length_a, length_b, length_c) = (to_a.length(), to_b.length(), to_c.length());
    let rest = length_a * length_b * length_c
        + to_a.dot(to_b) * length_c
        + to_b.dot(to_c) * length_a
        + to_c.dot(to_a) * length_b;
    2.0 * volume.atan2(rest)
}

/// Of a planar polygon with its vertices in order, which may be concave.
///
/// A border that is not planar, or crosses itself, counts each direction as often as it goes around it, up to multiples of
/// `4 pi`. Fewer than three vertices cover nothing.
pub fn polygon_sr(point: DVec3, vertices: &[DVec3]) -> f64 {
    let Some((&first, others)) = vertices.split_first() else { return 0.0 };
    let fan = others.windows(2).map(|pair| signed_triangle_sr(point, [first, pair[0], pair[1]]));
    fan.sum::<f64>().abs()
}

/// Of an axis-aligned box: all directions from inside, half of them from a face, a quarter from an edge, an eighth from a corner.
/// `lower` must not be above `upper` on any axis, or it covers nothing.
pub fn box_sr(point: DVec3, lower: DVec3, upper: DVec3) -> f64 {
    if !lower.cmple(upper).all() {
        return 0.0;
    }
    if point.cmpge(lower).all() && point.cmple(upper).all() {
        let is_flat = lower.cmpeq(upper).any();
        let touched_count = (point.cmpeq(lower) | point.cmpeq(upper)).bitmask().count_ones();
        return if is_flat { 0.0 } else { SPHERE_SR / f64::from(1u32 << touched_count) };
    }
    // The faces that can be seen from outside do not cover one another.
    (0..3).map(|axis| face_sr(axis, point, lower, upper)).sum()
}

/// Of the face across an axis that can be seen from the point, if any.
fn face_sr(axis: usize, point: DVec3, lower: DVec3, upper: DVec3) -> f64 {
    let plane = if point[axis] < lower[axis] {
        lower[axis]
    } else if point[axis] > upper[axis] {
        upper[axis]
    } else {
        return 0.0;
    };
    let (next, last) = ((axis + 1) % 3, (axis + 2) % 3);
    let corner = |at_next: f64, at_last: f64| {
        let mut corner = DVec3::ZERO;
        (corner[axis], corner[next], corner[last]) = (plane, at_next, at_last);
        corner
    };
    let corners = [
        corner(lower[next], lower[last]),
        corner(upper[next], lower[last]),
        corner(upper[next], upper[last]),
        corner(lower[next], upper[last]),
    ];
    polygon_sr(point, &corners)
}

#[cfg(test)]
mod tests {
    use std::f64::consts::FRAC_PI_2;

    use gauss_quad::GaussLegendre;
    use proptest::prelude::*;

    use super::super::quadrature::over_triangle;
    use super::*;

    fn assert_close(found: f64, expected: f64, relative: f64, what: &str) {
        assert!(
            (found / expected - 1.0).abs() <= relative,
            "{what}: {found}, not {expected}: {:e}",
            found / expected - 1.0
        );
    }

    #[test]
    fn the_sphere_has_four_pi_by_quadrature_and_at_random() {
        let rule = GaussLegendre::new(30.try_into().expect("not 0"));
        let ring = |theta: f64| 2.0 * PI * differential_sr(theta, 1.0, 1.0);
        assert_close(rule.integrate(0.0, PI, ring), SPHERE_SR, 1e-14, "quadrature");

        // The differential at random angles.
        let mut state = 1u64;
        let count = 100_000;
        let (mut sum, mut squares) = (0.0, 0.0);
        for _ in 0..count {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            let theta = PI * (state >> 11) as f64 / (1u64 << 53) as f64;
            let sample = differential_sr(theta, PI, 2.0 * PI);
            (sum, squares) = (sum + sample, squares + sample * sample);
        }
        let mean = sum / f64::from(count);
        let error = ((squares / f64::from(count) - mean * mean) / f64::from(count)).sqrt();
        assert!((mean - SPHERE_SR).abs() < 4.0 * error && error < 0.02, "{mean} +- {error}");
    }

    #[test]
    fn cones_caps_and_spheres_agree() {
        assert_eq!(cone_sr(0.0), 0.0);
        assert_close(cone_sr(FRAC_PI_2), 2.0 * PI, 1e-15, "half of all");
        assert_close(cone_sr(PI), SPHERE_SR, 1e-15, "all");
        for half_angle in [1e-8, 1e-4, 0.3, 1.5, 2.0, 3.1] {
            assert_close(
                cone_sr(half_angle),
                patch_sr(0.0, half_angle, 0.0, 2.0 * PI),
                1e-14,
                "a patch around the pole",
            );
            let height = 2.0 * (0.5 * half_angle).sin().powi(2);
            assert_close(cone_sr(half_angle), cap_sr(3.0 * height, 3.0), 1e-14, "a cap");
            if half_angle < FRAC_PI_2 {
                assert_close(cone_sr(half_angle), sphere_sr(2.0, 2.0 * half_angle.sin()), 1e-13, "a sphere");
            }
        }
        // The sun from the earth: 6.8e-5 sr.
        assert_close(sphere_sr(149.6e9, 696e6), 6.80e-5, 1e-3, "sun");
        assert_eq!(sphere_sr(1.0, 1.0), 2.0 * PI);
        assert_eq!(sphere_sr(0.5, 1.0), SPHERE_SR);
        assert_eq!(sphere_sr(0.0, 0.0), 0.0);
        for bad in
            [cone_sr(-0.1), cone_sr(3.2), cone_sr(f64::NAN), cap_sr(2.1, 1.0), cap_sr(-0.1, 1.0), cap_sr(0.0, 0.0)]
        {
            assert!(bad.is_nan());
        }
        assert!(sphere_sr(-1.0, 1.0).is_nan() && sphere_sr(1.0, f64::NAN).is_nan());
    }

    #[test]
    fn thin_patches_keep_their_digits() {
        let (theta, width) = (1.0, 1e-9);
        let patch = patch_sr(theta, theta + width, 0.0, 1.0);
        let expected = differential_sr(theta + 0.5 * width, (theta + width) - theta, 1.0);
        assert_close(patch, expected, 1e-14, "a ring");
    }

    fn triangles() -> Vec<(&'static str, DVec3, [DVec3; 3])> {
        let v = DVec3::new;
        vec![
            ("octant", DVec3::ZERO, [DVec3::X, DVec3::Y, DVec3::Z]),
            ("tilted", v(0.3, -0.2, 0.1), [v(1.0, 0.2, 0.4), v(-0.3, 1.2, 0.9), v(0.2, -0.7, 1.4)]),
            ("far", v(0.1, 0.2, 0.3), [v(1e5, 0.0, 0.0), v(1e5, 1.0, 0.0), v(1e5, 0.0, 1.0)]),
            ("needle", DVec3::ZERO, [v(-1.0, 0.0, 1.0), v(1.0, 0.0, 1.0), v(0.3, 1e-6, 1.0)]),
            ("needle, end on", DVec3::ZERO, [v(0.0, 0.0, 1.0), v(0.01, 0.0, 10.0), v(0.0, 0.02, 10.0)]),
            ("close", v(0.0, 0.0, 0.05), [v(-1.0, -1.0, 0.0), v(2.0, -0.5, 0.0), v(-0.5, 1.5, 0.0)]),
            (
                "nearly all of a side",
                v(0.0, 0.0, 1.0),
                [v(-900.0, -500.0, 0.0), v(900.0, -500.0, 0.0), v(0.0, 1000.0, 0.0)],
            ),
            ("seen at a thousandth", v(5.0, 0.0, 0.005), [v(-1.0, -1.0, 0.0), v(1.0, -1.0, 0.0), v(0.0, 1.0, 0.0)]),
        ]
    }

    #[test]
    fn triangles_have_the_solid_angle_of_the_quadrature() {
        for (name, point, [a, b, c]) in triangles() {
            let expected = over_triangle(point, [a, b, c], 1e-15, &|_| 1.0);
            for vertices in [[a, b, c], [b, c, a], [c, b, a]] {
                assert_close(triangle_sr(point, vertices), expected, 1e-12, name);
            }
        }
        assert_close(triangle_sr(DVec3::ZERO, [DVec3::X, DVec3::Y, DVec3::Z]), FRAC_PI_2, 1e-15, "an eighth of 4 pi");
    }

    #[test]
    fn triangles_from_their_plane_cover_half_of_all_or_nothing() {
        let triangle = [DVec3::new(-1.0, -1.0, 0.0), DVec3::new(2.0, -1.0, 0.0), DVec3::new(-1.0, 2.0, 0.0)];
        assert_eq!(triangle_sr(DVec3::new(-0.2, -0.1, 0.0), triangle), 2.0 * PI);
        assert_eq!(triangle_sr(DVec3::new(5.0, 5.0, 0.0), triangle), 0.0);
        assert_eq!(triangle_sr(triangle[0], triangle), 0.0);
        assert_eq!(triangle_sr(DVec3::Z, [DVec3::X, DVec3::X, DVec3::Y]), 0.0);
        assert_eq!(triangle_sr(DVec3::Z, [DVec3::ZERO, DVec3::X, 2.0 * DVec3::X]), 0.0);
    }

    #[test]
    fn polygons_add_up() {
        // An L, concave, and its mirror image.
        let l = [(0.0, 0.0), (2.0, 0.0), (2.0, 1.0), (1.0, 1.0), (1.0, 3.0), (0.0, 3.0)]
            .map(|(x, y)| DVec3::new(x, y, 0.0));
        let point = DVec3::new(1.7, 2.2, 0.4);
        let parts = [[l[0], l[1], l[2]], [l[0], l[2], l[3]], [l[0], l[3], l[4]], [l[0], l[4], l[5]]];
        let expected: f64 = parts.into_iter().map(|part| over_triangle(point, part, 1e-15, &|_| 1.0)).sum();
        assert_close(polygon_sr(point, &l), expected, 1e-12, "an L");
        let mut back = l;
        back.reverse();
        assert_close(polygon_sr(point, &back), expected, 1e-12, "an L the other way round");
        // From a vertex of which no triangle of a fan is convex.
        let turned: Vec<DVec3> = l.iter().cycle().skip(4).take(6).copied().collect();
        assert_close(polygon_sr(point, &turned), expected, 1e-12, "an L from another vertex");
        assert_eq!(polygon_sr(point, &l[..2]), 0.0);
        assert_eq!(polygon_sr(point, &[]), 0.0);
    }

    #[test]
    fn boxes_cover_what_their_faces_do() {
        let (lower, upper) = (DVec3::new(-1.0, -2.0, -3.0), DVec3::new(1.0, 2.0, 3.0));
        assert_eq!(box_sr(DVec3::ZERO, lower, upper), SPHERE_SR);
        assert_eq!(box_sr(DVec3::new(1.0, 0.0, 0.0), lower, upper), 2.0 * PI);
        assert_eq!(box_sr(DVec3::new(1.0, -2.0, 0.0), lower, upper), PI);
        assert_eq!(box_sr(upper, lower, upper), FRAC_PI_2);
        assert_eq!(box_sr(DVec3::ZERO, upper, lower), 0.0);
        // A cube's face from its centre is a sixth of all.
        let face = box_sr(DVec3::ZERO, DVec3::new(1.0, -1.0, -1.0), DVec3::new(1.0, 1.0, 1.0));
        assert_close(face, SPHERE_SR / 6.0, 1e-15, "a face");
        // Just outside a face it is nearly half of all; far away it looks as large as its silhouette.
        assert_close(box_sr(DVec3::new(1.0 + 1e-9, 0.3, 0.2), lower, upper), 2.0 * PI, 1e-8, "just outside");
        let diagonal = DVec3::ONE.normalize();
        let silhouette = diagonal.dot(DVec3::new(24.0, 12.0, 8.0));
        assert_close(box_sr(1e6 * diagonal, lower, upper), silhouette / 1e12, 1e-5, "far away");
        // One face, two, three in sight.
        for point in [DVec3::new(4.0, 0.5, 0.2), DVec3::new(4.0, 5.0, 0.2), DVec3::new(-4.0, 5.0, -6.0)] {
            let axes = [(0, 1, 2), (1, 2, 0), (2, 0, 1)];
            let expected: f64 = axes.into_iter().map(|axes| seen_face(point, lower, upper, axes)).sum();
            assert_close(box_sr(point, lower, upper), expected, 1e-12, "outside");
        }
    }

    fn seen_face(point: DVec3, lower: DVec3, upper: DVec3, (axis, next, last): (usize, usize, usize)) -> f64 {
        if (lower[axis]..=upper[axis]).contains(&point[axis]) {
            return 0.0;
        }
        let plane = if point[axis] < lower[axis] { lower } else { upper };
        let (mut b, mut d) = (plane, plane);
        (b[next], d[last]) = (lower[next] + upper[next] - plane[next], lower[last] + upper[last] - plane[last]);
        let mut c = b;
        c[last] = d[last];
        over_triangle(point, [plane, b, c], 1e-15, &|_| 1.0) + over_triangle(point, [plane, c, d], 1e-15, &|_| 1.0)
    }

    proptest! {
        #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(2000) })]

        /// Any triangle from any point: its parts add up, and neither turning nor scaling changes it.
        #[test]
        fn any_triangle_is_the_sum_of_its_parts(
            point in prop::array::uniform3(-1.0..1.0f64), a in prop::array::uniform3(-1.0..1.0f64),
            b in prop::array::uniform3(-1.0..1.0f64), c in prop::array::uniform3(-1.0..1.0f64),
            share in 0.0..1.0f64, exponent in -20..20i32,
        ) {
            let [point, a, b, c] = [point, a, b, c].map(DVec3::from_array);
            let whole = triangle_sr(point, [a, b, c]);
            prop_assert!((0.0..=2.0 * PI).contains(&whole));
            // Where the point is near an edge or the plane of a part, a rounding of the cut moves it by that much.
            let cut = b.lerp(c, share);
            let parts = triangle_sr(point, [a, b, cut]) + triangle_sr(point, [a, cut, c]);
            let nearest = [a, b, c, cut].map(|vertex| vertex.distance(point)).into_iter().fold(f64::MAX, f64::min);
            let height = (b - a).cross(c - a).normalize().dot(point - a).abs();
            let tolerance = 1e-14 / (nearest.min(height)).max(1e-14);
            prop_assert!((whole - parts).abs() <= tolerance, "{whole} {parts} {tolerance:e}");
            let scale = 2f64.powi(exponent);
            prop_assert_eq!(triangle_sr(scale * point, [a, b, c].map(|vertex| scale * vertex)), whole);
            let turned = |v: DVec3| DVec3::new(v.y, v.z, v.x);
            let difference = (triangle_sr(turned(point), [a, b, c].map(turned)) - whole).abs();
            prop_assert!(difference <= tolerance, "{difference:e} {tolerance:e}");
        }

        /// A tetrahedron around a point covers all directions, one beside it each direction as often from both sides.
        #[test]
        fn closed_surfaces_cover_all_or_nothing(vertices in prop::array::uniform4(prop::array::uniform3(-1.0..1.0f64))) {
            let [a, b, c, d] = vertices.map(DVec3::from_array);
            let volume = (b - a).cross(c - a).dot(d - a);
            prop_assume!(volume.abs() > 1e-3);
            let sides = [[a, b, c], [a, d, b], [b, d, c], [c, d, a]];
            let all = |point: DVec3| sides.into_iter().map(|side| signed_triangle_sr(point, side)).sum::<f64>().abs();
            prop_assert!((all(0.25 * (a + b + c + d)) - SPHERE_SR).abs() < 1e-11);
            prop_assert!(all(DVec3::new(2.0, 2.0, 2.0)) < 1e-11);
        }
    }
}
