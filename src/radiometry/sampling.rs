//! Random directions, each with the density with which it is drawn.
//!
//! `u` and `v` are independent and uniform in `[0, 1]`. Densities are exact for the `f64` direction.

use std::f64::consts::PI;

use glam::DVec3;

use super::direction::from_local;
use super::solid_angle::{SPHERE_SR, cone_sr, triangle_sr};

/// A direction, and how densely its neighbourhood is sampled.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DirectionSample {
    /// Of unit length.
    pub direction: DVec3,
    /// In 1/sr: it integrates to 1 over all directions. 0: there is nothing to sample.
    pub density_per_sr: f64,
}

/// Uniform over all directions.
pub fn sample_sphere(u: f64, v: f64) -> DirectionSample {
    let direction = around_z(1.0 - 2.0 * u, 4.0 * u * (1.0 - u), v);
    DirectionSample { direction, density_per_sr: 1.0 / SPHERE_SR }
}

/// Uniform over the side of a unit normal.
pub fn sample_hemisphere(normal: DVec3, u: f64, v: f64) -> DirectionSample {
    let direction = from_local(normal, around_z(u, (1.0 - u) * (1.0 + u), v));
    DirectionSample { direction, density_per_sr: 2.0 / SPHERE_SR }
}

/// Over the side of a unit normal, with the density `cosine / pi`: as a Lambertian surface scatters.
pub fn sample_cosine_hemisphere(normal: DVec3, u: f64, v: f64) -> DirectionSample {
    let cosine = (1.0 - u).sqrt();
    DirectionSample { direction: from_local(normal, around_z(cosine, u, v)), density_per_sr: cosine / PI }
}

/// Uniform over a cone around a unit axis, its half angle in `(0, pi]`.
pub fn sample_cone(axis: DVec3, half_angle_rad: f64, u: f64, v: f64) -> DirectionSample {
    let solid_angle_sr = cone_sr(half_angle_rad);
    let height = u * solid_angle_sr / (2.0 * PI); // 1 - cosine, without cancellation
    let direction = from_local(axis, around_z(1.0 - height, height * (2.0 - height), v));
    DirectionSample { direction, density_per_sr: 1.0 / solid_angle_sr }
}

/// Uniform in the solid angle of a triangle. Where that is 0 the density is 0, and the direction leads to the first vertex.
///
/// Source: Arvo 1995, "Stratified sampling of spherical triangles", in the form of Peters 2021, "BRDF importance sampling for polygonal
/// lights", section 4, which needs no angles; the last step as a difference of nearby directions, so that small triangles are sampled as
/// evenly as large ones.
pub fn sample_triangle(point: DVec3, vertices: [DVec3; 3], u: f64, v: f64) -> DirectionSample {
    let solid_angle_sr = triangle_sr(point, vertices);
    let rays = vertices.map(|vertex| vertex - point);
    let [a, b, c] = rays.map(DVec3::normalize_or_zero);
    let is_seen = solid_angle_sr > 0.0; // false for a NaN
    if !is_seen {
        return DirectionSample { direction: a, density_per_sr: 0.0 };
    }
    // The third vertex moves along the arc from a to c until the triangle has u of its solid angle.
    let volume = rays[0].dot((vertices[1] - vertices[0]).cross(vertices[2] - vertices[0])).abs()
        / (rays[0].length() * rays[1].length() * rays[2].length());
    let (sine, cosine) = (0.5 * u * solid_angle_sr).sin_cos();
    let offset = (volume * cosine - (a.dot(c) + b.dot(c)) * sine) * a + ((1.0 + a.dot(b)) * sine) * c;
    let moved = match offset.try_normalize() {
        Some(middle) => 2.0 * a.dot(middle) * middle - a,
        None => a, // u is 0
    };
    // Along the arc from b to it, the cosine of the distance from b uniform.
    let height = 0.5 * b.distance_squared(moved); // 1 - cosine
    let share = (v * (2.0 - v * height) / (2.0 - height)).sqrt();
    let direction = b + share * (moved - b) + height * (share - v) * b;
    DirectionSample { direction: direction.normalize(), density_per_sr: 1.0 / solid_angle_sr }
}

/// The unit vector with that z, and a share `v` of a turn around it.
fn around_z(z: f64, squared_radius: f64, v: f64) -> DVec3 {
    let (sine, cosine) = (2.0 * PI * v).sin_cos();
    let radius = squared_radius.sqrt();
    DVec3::new(radius * cosine, radius * sine, z)
}

#[cfg(test)]
mod tests {
    use super::super::solid_angle::{polygon_sr, signed_triangle_sr};
    use super::*;

    /// The midpoints of a grid over the unit square.
    fn grid() -> impl Iterator<Item = (f64, f64)> {
        const SIDE: u32 = 512;
        let at = |index: u32| (f64::from(index) + 0.5) / f64::from(SIDE);
        (0..SIDE * SIDE).map(move |index| (at(index / SIDE), at(index % SIDE)))
    }

    /// The integral of a function by samples.
    fn integral(sample: impl Fn(f64, f64) -> DirectionSample, function: impl Fn(DVec3) -> f64) -> f64 {
        let (sum, count) = grid().fold((0.0, 0.0), |(sum, count), (u, v)| {
            let DirectionSample { direction, density_per_sr } = sample(u, v);
            assert!((direction.length() - 1.0).abs() < 1e-14, "{direction}");
            (sum + function(direction) / density_per_sr, count + 1.0)
        });
        sum / count
    }

    fn assert_near(found: f64, expected: f64, what: &str) {
        // The midpoint rule on 512 x 512 points, of functions with square roots at the ends.
        assert!((found - expected).abs() < 1e-4, "{what}: {found}, not {expected}");
    }

    #[test]
    fn densities_integrate_to_one_and_samples_follow_them() {
        let axis = DVec3::new(0.3, -0.5, -0.8).normalize();
        let other = axis.any_orthonormal_vector();
        let along = |direction: DVec3| axis.dot(direction);
        assert_near(integral(sample_sphere, |_| 1.0), SPHERE_SR, "sphere");
        assert_near(integral(sample_sphere, along), 0.0, "sphere, cosine");
        assert_near(
            integral(sample_sphere, |direction| along(direction).powi(2)),
            SPHERE_SR / 3.0,
            "sphere, squared cosine",
        );

        let hemisphere = |u, v| sample_hemisphere(axis, u, v);
        assert_near(integral(hemisphere, |_| 1.0), 2.0 * PI, "hemisphere");
        assert_near(integral(hemisphere, along), PI, "hemisphere, cosine");
        assert_near(integral(hemisphere, |direction| other.dot(direction)), 0.0, "hemisphere, across");

        let cosine = |u, v| sample_cosine_hemisphere(axis, u, v);
        assert_near(integral(cosine, along), PI, "cosine");
        assert_near(integral(cosine, |direction| along(direction).powi(2)), 2.0 * PI / 3.0, "cosine, squared cosine");
        assert_near(
            integral(cosine, |direction| along(direction) * other.dot(direction).powi(2)),
            PI / 4.0,
            "cosine, across",
        );

        for half_angle in [1e-3, 0.4, 1.9, PI] {
            let cone = |u, v| sample_cone(axis, half_angle, u, v);
            let scale = cone_sr(half_angle);
            assert_near(integral(cone, |_| 1.0) / scale, 1.0, "cone");
            // The mean height of a cap of directions.
            assert_near(integral(cone, along) / scale, 0.5 * (1.0 + half_angle.cos()), "cone, cosine");
            assert!(grid().step_by(97).all(|(u, v)| along(cone(u, v).direction) >= half_angle.cos() - 1e-14));
        }
    }

    fn triangles() -> [(&'static str, DVec3, [DVec3; 3]); 6] {
        let v = DVec3::new;
        [
            ("octant", DVec3::ZERO, [DVec3::X, DVec3::Y, DVec3::Z]),
            ("tilted", v(0.3, -0.2, 0.1), [v(1.0, 0.2, 0.4), v(-0.3, 1.2, 0.9), v(0.2, -0.7, 1.4)]),
            ("the other way round", v(0.3, -0.2, 0.1), [v(1.0, 0.2, 0.4), v(0.2, -0.7, 1.4), v(-0.3, 1.2, 0.9)]),
            ("far", v(0.1, 0.2, 0.3), [v(1e5, 0.0, 0.0), v(1e5, 1.0, 0.0), v(1e5, 0.0, 1.0)]),
            ("needle", DVec3::ZERO, [v(-1.0, 0.0, 1.0), v(1.0, 0.0, 1.0), v(0.3, 1e-6, 1.0)]),
            ("close", v(0.0, 0.0, 1e-3), [v(-1.0, -1.0, 0.0), v(2.0, -0.5, 0.0), v(-0.5, 1.5, 0.0)]),
        ]
    }

    #[test]
    fn triangles_are_sampled_evenly() {
        for (name, point, vertices) in triangles() {
            let sample = |u, v| sample_triangle(point, vertices, u, v);
            let solid_angle_sr = triangle_sr(point, vertices);
            assert_near(integral(sample, |_| 1.0) / solid_angle_sr, 1.0, name);
            // Each third of it, around its centroid, gets its share.
            let [a, b, c] = vertices;
            let centroid = (a + b + c) / 3.0;
            for (edge, part) in [[a, b, centroid], [b, c, centroid], [c, a, centroid]].into_iter().enumerate() {
                let planes = [0, 1, 2].map(|corner| (part[corner] - point).cross(part[(corner + 1) % 3] - point));
                let turn = signed_triangle_sr(point, part).signum();
                let is_in = |direction: DVec3| planes.iter().all(|plane| plane.dot(direction) * turn <= 0.0);
                let share = integral(sample, |direction| f64::from(u8::from(is_in(direction)))) / solid_angle_sr;
                let expected = triangle_sr(point, part) / solid_angle_sr;
                assert!((share - expected).abs() < 4e-3, "{name}, part {edge}: {share}, not {expected}");
            }
        }
    }

    #[test]
    fn samples_of_a_triangle_meet_it() {
        for (name, point, vertices) in triangles() {
            let rays = vertices.map(|vertex| (vertex - point).normalize());
            let turn = signed_triangle_sr(point, vertices).signum();
            for (u, v) in grid().step_by(13).chain([(0.0, 0.0), (0.0, 1.0), (1.0, 0.0), (1.0, 1.0), (0.5, 0.0)]) {
                let direction = sample_triangle(point, vertices, u, v).direction;
                for corner in 0..3 {
                    let plane = rays[corner].cross(rays[(corner + 1) % 3]);
                    let height = -turn * plane.dot(direction);
                    assert!(height >= -1e-15, "{name}, edge {corner}, ({u}, {v}): {height:e}");
                }
            }
        }
    }

    #[test]
    fn a_triangle_without_solid_angle_has_nothing_to_sample() {
        let flat = sample_triangle(DVec3::ZERO, [DVec3::X, DVec3::Y, DVec3::X + DVec3::Y], 0.3, 0.6);
        assert_eq!(flat, DirectionSample { direction: DVec3::X, density_per_sr: 0.0 });
        assert_eq!(polygon_sr(DVec3::ZERO, &[DVec3::X, DVec3::Y, DVec3::X + DVec3::Y]), 0.0);
    }
}
