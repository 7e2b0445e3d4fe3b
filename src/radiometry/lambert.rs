//! Projected solid angles: solid angles weighted by the cosine to a normal, of the part above the horizon. Times a radiance they are the
//! irradiance of what looks equally bright all over.

use std::f64::consts::PI;

use arrayvec::ArrayVec;
use glam::DVec3;

/// Of a planar polygon whose vertices are in order: 0 to pi, whichever way round they go.
///
/// Relative error some `2^-50` over the polygon's angular size and the sines of the angles at which the two planes are met.
/// Source: Lambert 1760, "Photometria"; as in Arvo 1995, "Analytic methods for simulated light transport", section 2.5.1. Clipped at the
/// horizon before.
pub fn projected_polygon_sr(point: DVec3, normal: DVec3, vertices: &[DVec3]) -> f64 {
    let Some(&last) = vertices.last() else { return 0.0 };
    let mut sum = Loop::new(normal);
    let mut before = last - point;
    let mut height_before = normal.dot(before);
    for &vertex in vertices {
        let ray = vertex - point;
        let height = normal.dot(ray);
        if (height > 0.0) != (height_before > 0.0) {
            sum.go_to(crossing(before, height_before, ray, height));
        }
        if height > 0.0 {
            sum.go_to(ray);
        }
        (before, height_before) = (ray, height);
    }
    sum.close().abs()
}

/// The part of a triangle above the horizon of the coordinates' origin: up to four vertices.
pub(super) fn above_horizon(normal: DVec3, rays: [DVec3; 3]) -> ArrayVec<DVec3, 4> {
    let mut kept = ArrayVec::new();
    for (corner, &ray) in rays.iter().enumerate() {
        let before = rays[(corner + 2) % 3];
        let (height_before, height) = (normal.dot(before), normal.dot(ray));
        if (height > 0.0) != (height_before > 0.0) {
            kept.push(crossing(before, height_before, ray, height));
        }
        if height > 0.0 {
            kept.push(ray);
        }
    }
    kept
}

/// Where the way from one ray to another, on different sides, meets the horizon.
fn crossing(from: DVec3, from_height: f64, to: DVec3, to_height: f64) -> DVec3 {
    from + (from_height / (from_height - to_height)) * (to - from)
}

/// A closed way around a polygon, seen from its point.
struct Loop {
    normal: DVec3,
    first: Option<DVec3>,
    last: DVec3,
    sum: f64,
}

impl Loop {
    fn new(normal: DVec3) -> Self {
        Self { normal, first: None, last: DVec3::ZERO, sum: 0.0 }
    }

    fn go_to(&mut self, ray: DVec3) {
        match self.first {
            None => self.first = Some(ray),
            Some(_) => self.sum += self.edge(ray),
        }
        self.last = ray;
    }

    /// The angle that the edge covers, times the cosine between the normal and that of the plane through edge and point.
    fn edge(&self, ray: DVec3) -> f64 {
        let across = self.last.cross(ray - self.last);
        let area = across.length();
        if area == 0.0 {
            return 0.0; // the edge is seen end on, or the point lies on it
        }
        area.atan2(self.last.dot(ray)) * (self.normal.dot(across) / area)
    }

    fn close(mut self) -> f64 {
        if let Some(first) = self.first {
            self.go_to(first);
        }
        0.5 * self.sum
    }
}

/// Of a sphere, from outside: 0 to pi. 0 from inside, where its outer side cannot be seen.
///
/// Source: Lagarde and de Rousiers 2014, "Moving Frostbite to physically based rendering", section 4.7.2, after Snyder 1996, "Area
/// light sources for real-time graphics"; in terms of sines, so that small spheres lose nothing.
pub fn projected_sphere_sr(point: DVec3, normal: DVec3, centre: DVec3, radius: f64) -> f64 {
    let to_centre = centre - point;
    let distance = to_centre.length();
    if !(distance > radius && radius > 0.0) {
        return 0.0;
    }
    let sine = radius / distance; // of the angle under which the radius is seen
    let cosine = ((1.0 - sine) * (1.0 + sine)).sqrt();
    let height = normal.dot(to_centre) / distance; // the cosine between the normal and the centre
    if height >= sine {
        return PI * sine * sine * height;
    }
    if height <= -sine {
        return 0.0;
    }
    // The horizon cuts the disc of directions.
    let side = ((1.0 - height) * (1.0 + height)).sqrt();
    let cut = (-(cosine * height) / (sine * side)).clamp(-1.0, 1.0);
    let half_chord = ((1.0 - cut) * (1.0 + cut)).sqrt();
    let disc = sine * sine * (height * cut.acos() - (cosine / sine) * side * half_chord);
    (disc + (side * half_chord * sine / cosine).atan()).clamp(0.0, PI)
}

#[cfg(test)]
mod tests {
    use gauss_quad::GaussLegendre;
    use proptest::prelude::*;

    use super::super::quadrature::over_triangle;
    use super::super::solid_angle::triangle_sr;
    use super::*;

    #[test]
    fn triangles_have_the_projected_solid_angle_of_the_quadrature() {
        let v = DVec3::new;
        let normal = v(0.2, -0.3, 1.0).normalize();
        for (name, point, [a, b, c]) in [
            ("above", v(0.3, -0.2, 0.1), [v(1.0, 0.2, 0.9), v(-0.3, 1.2, 0.9), v(0.2, -0.7, 1.4)]),
            ("far", v(0.1, 0.2, 0.3), [v(0.0, 0.0, 1e4), v(0.0, 1.0, 1e4), v(1.0, 0.0, 1e4)]),
            ("needle", DVec3::ZERO, [v(-1.0, 0.0, 1.0), v(1.0, 0.0, 1.0), v(0.3, 1e-5, 1.0)]),
            ("close", v(0.0, 0.0, -0.05), [v(-1.0, -1.0, 0.5), v(2.0, -0.5, 0.5), v(-0.5, 1.5, 1.0)]),
        ] {
            let expected = over_triangle(point, [a, b, c], 1e-15, &|direction| normal.dot(direction));
            for vertices in [[a, b, c], [b, c, a], [c, b, a]] {
                let found = projected_polygon_sr(point, normal, &vertices);
                assert!((found / expected - 1.0).abs() < 2e-11, "{name}: {found}, not {expected}");
            }
        }
    }

    #[test]
    fn what_lies_below_the_horizon_counts_nothing() {
        let v = DVec3::new;
        let below = [v(1.0, 0.0, -0.1), v(0.0, 1.0, -0.2), v(1.0, 1.0, -1e-9)];
        assert_eq!(projected_polygon_sr(DVec3::ZERO, DVec3::Z, &below), 0.0);
        assert!(above_horizon(DVec3::Z, below).is_empty());
        assert_eq!(projected_polygon_sr(DVec3::ZERO, DVec3::Z, &[]), 0.0);
        // A triangle through the horizon, one or two vertices above it: as the part above, cut by hand.
        let (top, left, right) = (v(1.0, 0.0, 2.0), v(1.0, -1.0, -1.0), v(1.0, 2.0, -2.0));
        let cut = |from: DVec3, to: DVec3| from + (to - from) * (from.z / (from.z - to.z));
        let part = [top, cut(top, left), cut(top, right)];
        let expected = over_triangle(DVec3::ZERO, part, 1e-15, &|direction| direction.z);
        let found = projected_polygon_sr(DVec3::ZERO, DVec3::Z, &[top, left, right]);
        assert!((found / expected - 1.0).abs() < 1e-12, "{found}, not {expected}");
        let flipped = [top, left, right].map(|vertex| v(vertex.x, vertex.y, -vertex.z));
        let [low, a, b] = flipped;
        let quad = [a, b, cut(b, low), cut(a, low)];
        let expected: f64 = [[quad[0], quad[1], quad[2]], [quad[0], quad[2], quad[3]]]
            .into_iter()
            .map(|part| over_triangle(DVec3::ZERO, part, 1e-15, &|direction| direction.z))
            .sum();
        let found = projected_polygon_sr(DVec3::ZERO, DVec3::Z, &flipped);
        assert!((found / expected - 1.0).abs() < 1e-12, "{found}, not {expected}");
        assert_eq!(above_horizon(DVec3::Z, flipped).len(), 4);
    }

    /// Howell, "A catalog of radiation heat transfer configuration factors", C-11: from an element to a parallel rectangle above it, a
    /// corner right over the element.
    #[test]
    fn a_rectangle_has_its_configuration_factor() {
        for (a, b) in [(0.5f64, 2.0f64), (1.0, 1.0), (10.0, 0.1), (1e4, 1e4)] {
            let part = |a: f64, b: f64| a / a.hypot(1.0) * (b / a.hypot(1.0)).atan();
            let expected = 0.5 * (part(a, b) + part(b, a));
            let rectangle = [(0.0, 0.0), (a, 0.0), (a, b), (0.0, b)].map(|(x, y)| DVec3::new(x, y, 1.0));
            let found = projected_polygon_sr(DVec3::ZERO, DVec3::Z, &rectangle);
            assert!((found / expected - 1.0).abs() < 1e-13, "{a} {b}: {found}, not {expected}");
        }
    }

    #[test]
    fn spheres_have_the_projected_solid_angle_of_the_quadrature() {
        let rule = GaussLegendre::new(200.try_into().expect("not 0"));
        for sine in [1e-6, 0.1, 0.5, 0.9, 0.999f64] {
            for angle in [0.0, 0.4, 1.0, 1.5, 1.57, 1.6, 2.2, 3.1f64] {
                let normal = DVec3::new(angle.sin(), 0.0, angle.cos());
                // Around the sphere's centre; the cosine of a ring, integrated around it, clipped at the horizon.
                let ring = |theta: f64| {
                    let (flat, steep) = (theta.cos() * angle.cos(), theta.sin() * angle.sin());
                    let lit = if flat >= steep {
                        PI
                    } else if flat <= -steep {
                        0.0
                    } else {
                        (-flat / steep).acos()
                    };
                    2.0 * theta.sin() * (flat * lit + steep * lit.sin())
                };
                let (half, kink) = (sine.asin(), (std::f64::consts::FRAC_PI_2 - angle).abs());
                let expected = if kink < half {
                    rule.integrate(0.0, kink, ring) + rule.integrate(kink, half, ring)
                } else {
                    rule.integrate(0.0, half, ring)
                };
                let found = projected_sphere_sr(DVec3::ONE, normal, DVec3::ONE + 3.0 * DVec3::Z, 3.0 * sine);
                let error = (found - expected).abs();
                assert!(error < 1e-6 * PI * sine * sine, "{sine} {angle}: {found}, not {expected}");
            }
        }
        assert_eq!(projected_sphere_sr(DVec3::ZERO, DVec3::Z, DVec3::Z, 1.0), 0.0);
        assert_eq!(projected_sphere_sr(DVec3::ZERO, DVec3::Z, DVec3::Z, 0.0), 0.0);
    }

    proptest! {
        #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(200) })]

        /// Above the horizon of a normal and of its opposite together there is as much as the difference tells; and no more than the
        /// solid angle.
        #[test]
        fn any_triangle_has_its_parts_above_and_below(
            point in prop::array::uniform3(-1.0..1.0f64), a in prop::array::uniform3(-1.0..1.0f64),
            b in prop::array::uniform3(-1.0..1.0f64), c in prop::array::uniform3(-1.0..1.0f64),
            normal in prop::array::uniform3(-1.0..1.0f64),
        ) {
            let [point, a, b, c, normal] = [point, a, b, c, normal].map(DVec3::from_array);
            prop_assume!(normal.length() > 0.1);
            let normal = normal.normalize();
            let height = (b - a).cross(c - a).normalize_or_zero().dot(point - a).abs();
            prop_assume!(height > 1e-3);
            let above = projected_polygon_sr(point, normal, &[a, b, c]);
            let below = projected_polygon_sr(point, -normal, &[a, b, c]);
            prop_assert!(above >= 0.0 && below >= 0.0 && above <= PI && below <= PI);
            prop_assert!(above + below <= triangle_sr(point, [a, b, c]) + 1e-11);
            let part = |rays: ArrayVec<DVec3, 4>| -> f64 {
                (2..rays.len()).map(|i| triangle_sr(DVec3::ZERO, [rays[0], rays[i - 1], rays[i]])).sum()
            };
            let rays = [a, b, c].map(|vertex| vertex - point);
            let parts = part(above_horizon(normal, rays)) + part(above_horizon(-normal, rays));
            prop_assert!((parts - triangle_sr(point, [a, b, c])).abs() < 1e-10);
            // As an integral over the surface.
            let expected = over_triangle(point, [a, b, c], 1e-6, &|direction| normal.dot(direction).max(0.0));
            prop_assert!((above - expected).abs() < 1e-4, "{above}, not {expected}");
        }
    }
}
