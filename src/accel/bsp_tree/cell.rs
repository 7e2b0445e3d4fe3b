//! A convex cell as the polygons around it. It serves the estimate of a ray's chances alone.

use glam::DVec3;

use crate::geometry::{Aabb, Polygon};

#[derive(Clone, Debug)]
pub(super) struct Cell {
    /// Counterclockwise, seen from outside.
    faces: Vec<Polygon>,
    half_area: f64,
}

impl Cell {
    /// A flat box is taken for one of some thickness: faces without area do not bound anything.
    pub(super) fn of(bounds: &Aabb) -> Self {
        const LEAST_THICKNESS: f64 = 1.0 / (1 << 10) as f64;
        let (lower, upper) = (bounds.lower.as_dvec3(), bounds.upper.as_dvec3());
        let (centre, half) = ((lower + upper) * 0.5, (upper - lower) * 0.5);
        let half = half.max(DVec3::splat(LEAST_THICKNESS * half.max_element()));
        let sides = |axis: usize| {
            let [to_face, u, v] = [axis, axis + 1, axis + 2].map(|axis| DVec3::AXES[axis % 3] * half[axis % 3]);
            [Polygon::parallelogram(centre + to_face, [u, v]), Polygon::parallelogram(centre - to_face, [v, u])]
        };
        Self::with((0..3).flat_map(sides).collect())
    }

    fn with(faces: Vec<Polygon>) -> Self {
        let half_area = faces.iter().map(|face| face.doubled_area().length()).sum::<f64>() * 0.25;
        Self { faces, half_area }
    }

    pub(super) fn half_area(&self) -> f64 {
        self.half_area
    }

    /// The least and the greatest height along the normal.
    pub(super) fn extent(&self, normal: DVec3) -> (f64, f64) {
        let none = (f64::INFINITY, f64::NEG_INFINITY);
        self.faces.iter().fold(none, |(least, greatest), face| {
            let (low, high) = face.extent(|point| normal.dot(point));
            (least.min(low), greatest.max(high))
        })
    }

    /// Half the surface of the part below the plane, of that above it, and half of the cut between them, all as shares
    /// of the whole. The surface of a closed body is zero as a vector, and so the cut is what the rest lacks.
    pub(super) fn shares(&self, normal: DVec3, distance: f64) -> [f64; 3] {
        let (mut area, mut open) = (0.0, DVec3::ZERO);
        for face in &self.faces {
            let face = face.doubled_area_below(|point| normal.dot(point) - distance);
            area += face.length();
            open += face;
        }
        // A polygon's doubled area twice.
        let whole = 4.0 * self.half_area;
        let (below, cut) = (area / whole, open.length() / whole);
        [below + cut, (1.0 - below).max(0.0) + cut, cut]
    }

    /// What is below the plane, and what is above.
    pub(super) fn divide(&self, normal: DVec3, distance: f64) -> [Self; 2] {
        let height = |point: DVec3| normal.dot(point) - distance;
        let mut below: Vec<Polygon> = self.faces.iter().filter_map(|face| face.below(height)).collect();
        let mut above: Vec<Polygon> = self.faces.iter().filter_map(|face| face.below(|point| -height(point))).collect();
        if let Some([lid, floor]) = self.cut(normal, distance) {
            below.push(lid);
            above.push(floor);
        }
        [Self::with(below), Self::with(above)]
    }

    /// The plane's part in the cell, seen from above and from below.
    fn cut(&self, normal: DVec3, distance: f64) -> Option<[Polygon; 2]> {
        let (lower, upper) = self.faces.iter().map(Polygon::bounds).reduce(|a, b| (a.0.min(b.0), a.1.max(b.1)))?;
        let centre = (lower + upper) * 0.5;
        let nearest = centre - normal * ((normal.dot(centre) - distance) / normal.length_squared());
        // Reaches from anywhere in the cell to anywhere else in it.
        let size = 2.0 * (upper - lower).length();
        let (u, v) = normal.normalize().any_orthonormal_pair();
        let sides = [u * size, v * size];
        let within = |mut polygon: Polygon| {
            for face in &self.faces {
                let (outward, corner) = (face.doubled_area(), face.vertices()[0]);
                polygon = polygon.below(|point| outward.dot(point - corner))?;
            }
            Some(polygon)
        };
        Some([
            within(Polygon::parallelogram(nearest, sides))?,
            within(Polygon::parallelogram(nearest, [sides[1], sides[0]]))?,
        ])
    }
}

#[cfg(test)]
mod tests {
    use glam::Vec3;

    use super::*;

    fn assert_near(values: [f64; 2], expected: [f64; 2]) {
        let is_near =
            values.iter().zip(expected).all(|(value, expected)| (value - expected).abs() < 64.0 * f64::EPSILON);
        assert!(is_near, "{values:?} instead of {expected:?}");
    }

    #[test]
    fn parts_of_a_cube_have_the_surface_that_is_estimated_for_them() {
        let cube = Cell::of(&Aabb { lower: Vec3::ZERO, upper: Vec3::ONE });
        assert_eq!(cube.half_area(), 3.0);
        let prism = 1.5 + f64::sqrt(0.5);
        let planes = [(DVec3::X, 0.25, [1.5, 2.5]), (DVec3::new(1.0, 1.0, 0.0), 1.0, [prism; 2])];
        for (normal, distance, half_areas) in planes {
            let parts = cube.divide(normal, distance);
            assert_near(parts.each_ref().map(Cell::half_area), half_areas);
            let [below, above, _] = cube.shares(normal, distance);
            assert_near([3.0 * below, 3.0 * above], half_areas);
        }
    }

    #[test]
    fn a_flat_cell_is_divided_as_one_of_little_thickness() {
        let flat = Cell::of(&Aabb { lower: Vec3::ZERO, upper: Vec3::new(2.0, 1.0, 0.0) });
        let parts = flat.divide(DVec3::X, 1.0);
        let [tip, _] = parts[0].divide(DVec3::new(1.0, 1.0, 0.0), 1.0);
        for (part, half_area) in [(&flat, 2.0), (&parts[0], 1.0), (&parts[1], 1.0), (&tip, 0.5)] {
            assert!((half_area..half_area + 0.01).contains(&part.half_area()), "{}", part.half_area());
        }
        assert_near(parts[0].extent(DVec3::Y).into(), [0.0, 1.0]);
    }

    #[test]
    fn a_corner_cut_off_twice_stays_closed() {
        let cube = Cell::of(&Aabb { lower: Vec3::ZERO, upper: Vec3::ONE });
        let [corner, _] = cube.divide(DVec3::ONE, 1.0);
        let [tip, rest] = corner.divide(DVec3::X, 0.5);
        for part in [&corner, &tip, &rest] {
            let open: DVec3 = part.faces.iter().map(Polygon::doubled_area).sum();
            assert!(open.length() < 64.0 * f64::EPSILON, "{part:?} lacks {open:?}");
        }
        assert_near([corner.half_area(), 0.0], [0.75 + f64::sqrt(0.1875), 0.0]);
    }
}
