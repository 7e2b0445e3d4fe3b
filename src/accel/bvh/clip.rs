//! Triangles cut by planes across an axis, and the boxes of the parts.

use glam::Vec4;

use super::chopped_bins::{MOST_BINS, Slabs};
use crate::accel::reference::Bounds8;
use crate::geometry::Triangle;
use crate::simd::Simd;

/// How far a part's box reaches beyond the part along each axis, in lengths of the whole triangle's largest extent:
/// [`halves`] has the reason.
const OVERLAP: f64 = 8.0 * EPSILON;
const EPSILON: f64 = 1.0 / (1 << 24) as f64;

/// The boxes of what a plane leaves, on either side, of the part of a triangle that is inside `bounds`; empty where
/// nothing is.
///
/// A ray must meet one of the parts' boxes wherever it hits the triangle, and it hits where it passes a point of the
/// triangle, of one part, within the band. Along an axis where it moves, the slack of [`crate::geometry::SlabRay`] covers
/// the band. Along another there is no slack: there, with `u = 2^-24`, the sheared coordinates of the vertices are exact
/// but for the rounding of `vertex - origin`, so relatively by `u`, and the ray passes the point within `u` times the
/// triangle's extent. Nor is there slack where a part's box ends behind the origin ([`crate::geometry::BEHIND`]), but not the triangle:
/// the point that the ray passes then is no more than `4u` of the largest extent behind the origin, and the box would reach
/// beyond it; so it belongs to another part. The boxes reach twice as far, but never beyond the triangle's own, beside which hits
/// are refused exactly. What is to spare exceeds by far what the roundings in `f64` take. `bounds` reaches as far beyond its part, so
/// cutting again loses nothing.
pub(super) fn halves(triangle: &Triangle, bounds: &Bounds8, axis: usize, plane: f32) -> [Bounds8; 2] {
    let plane = f64::from(plane);
    let vertices: [[f64; 3]; 3] = std::array::from_fn(|corner| triangle.axes.map(|row| f64::from(row[corner])));
    let mut sides = [Extents::EMPTY; 2];
    for (corner, start) in vertices.iter().enumerate() {
        let end = &vertices[(corner + 1) % 3];
        if start[axis] <= plane {
            sides[0].grow(start);
        }
        if start[axis] >= plane {
            sides[1].grow(start);
        }
        if start[axis].min(end[axis]) < plane && plane < start[axis].max(end[axis]) {
            let share = (plane - start[axis]) / (end[axis] - start[axis]);
            let mut point: [f64; 3] = std::array::from_fn(|axis| start[axis] + share * (end[axis] - start[axis]));
            point[axis] = plane;
            sides[0].grow(&point);
            sides[1].grow(&point);
        }
    }
    let extents = triangle.axes.map(|[a, b, c]| f64::from(a.max(b).max(c)) - f64::from(a.min(b).min(c)));
    let overlap = OVERLAP * extents.into_iter().fold(0.0, f64::max);
    sides.map(|side| side.enlarged(overlap).intersection_with(bounds))
}

struct Extents {
    lower: [f64; 3],
    upper: [f64; 3],
}

impl Extents {
    const EMPTY: Self = Self { lower: [f64::INFINITY; 3], upper: [f64::NEG_INFINITY; 3] };

    fn grow(&mut self, point: &[f64; 3]) {
        for (axis, &coordinate) in point.iter().enumerate() {
            self.lower[axis] = self.lower[axis].min(coordinate);
            self.upper[axis] = self.upper[axis].max(coordinate);
        }
    }

    fn enlarged(mut self, by: f64) -> Self {
        for axis in 0..3 {
            self.lower[axis] -= by;
            self.upper[axis] += by;
        }
        self
    }

    /// Rounded outward.
    fn intersection_with(&self, bounds: &Bounds8) -> Bounds8 {
        let mut both = *bounds;
        for axis in 0..3 {
            both.0[axis] = both.0[axis].max(round_down(self.lower[axis]));
            both.0[axis + 4] = both.0[axis + 4].max(round_down(-self.upper[axis]));
        }
        if both.size().truncate().cmplt(glam::Vec3::ZERO).any() { Bounds8::EMPTY } else { both }
    }
}

fn round_down(value: f64) -> f32 {
    let nearest = value as f32;
    if f64::from(nearest) > value { nearest.next_down() } else { nearest }
}

/// The boxes of what of a triangle is in each slab from the first to the last; these have what is beyond them, too. For
/// costs: they are not rounded outward.
#[inline(always)]
pub(super) fn chop<S: Simd>(
    simd: S,
    triangle: &Triangle,
    axis: usize,
    slabs: &Slabs,
    [first, last]: [usize; 2],
    parts: &mut [Bounds8; MOST_BINS],
) {
    let [x, y, z] = triangle.axes;
    let vertices: [Vec4; 3] = std::array::from_fn(|corner| Vec4::new(x[corner], y[corner], z[corner], 0.0));
    let of_vertices = vertices.map(|vertex| slabs.of(vertex)[axis].clamp(first, last));
    parts[first..=last].fill(Bounds8::EMPTY);
    let mut grow = |slab: usize, point: Vec4| parts[slab].grow(simd, &Bounds8::from_corners(point, point));
    for corner in 0..3 {
        let next = (corner + 1) % 3;
        grow(of_vertices[corner], vertices[corner]);
        let is_ascending = of_vertices[corner] <= of_vertices[next];
        let (start, end) = if is_ascending { (corner, next) } else { (next, corner) };
        if of_vertices[start] == of_vertices[end] {
            continue;
        }
        let (from, to) = (vertices[start], vertices[end]);
        let step = (to - from) / (to[axis] - from[axis]);
        for slab in of_vertices[start]..of_vertices[end] {
            let point = from + step * (slabs.plane(axis, slab + 1) - from[axis]);
            grow(slab, point);
            grow(slab + 1, point);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::accel::reference::Reference;

    fn whole(triangle: &Triangle) -> Bounds8 {
        *Reference::new(&triangle.bounds(), 0, 0).bounds()
    }

    fn long(coordinates: [[f32; 3]; 3]) -> Triangle {
        Triangle::new(coordinates, 0, 0)
    }

    #[test]
    fn halves_are_smaller_and_overlap_within_the_triangles_box() {
        let triangle = long([[0.0, 0.0, 0.0], [8.0, 8.0, 1.0], [8.0, 7.0, 2.0]]);
        let [left, right] = halves(&triangle, &whole(&triangle), 0, 4.0).map(|part| part.to_aabb());
        let all = triangle.bounds();
        assert!(all.contains(&left) && all.contains(&right));
        assert!(left.upper.y < 4.001 && right.lower.y > 3.499);
        let overlap = 8.0 / (1 << 22) as f32;
        assert!(left.upper.x >= 4.0 + overlap && right.lower.x <= 4.0 - overlap);
    }

    #[test]
    fn halves_beside_the_plane_are_empty() {
        let triangle = long([[0.0, 0.0, 0.0], [1.0, 8.0, 1.0], [1.0, 7.0, 2.0]]);
        let [left, right] = halves(&triangle, &whole(&triangle), 0, 4.0);
        assert!(!left.is_empty() && right.is_empty());
        assert_eq!(left.to_aabb(), triangle.bounds());
    }

    #[test]
    fn halves_of_halves_contain_every_point_far_from_the_origin() {
        // One ulp is more than the overlap there.
        let triangle = long([[1e6, 1e6, 0.0], [1e6 + 8.0, 1e6 + 5.0, 1.0], [1e6 + 7.0, 1e6, 3.0]]);
        let mut parts = vec![whole(&triangle)];
        for (axis, plane) in [(0, 1e6 + 3.0), (1, 1e6 + 2.0), (2, 0.7), (0, 1e6 + 5.5)] {
            parts = parts.iter().flat_map(|part| halves(&triangle, part, axis, plane)).collect();
        }
        for i in 0..=40 {
            for j in 0..=40 - i {
                let weights = [i, j, 40 - i - j].map(|weight| f64::from(weight) / 40.0);
                let point = triangle.axes.map(|[a, b, c]| {
                    (f64::from(a) * weights[0] + f64::from(b) * weights[1] + f64::from(c) * weights[2]) as f32
                });
                let has_point =
                    |part: &Bounds8| (0..3).all(|axis| part.0[axis] <= point[axis] && point[axis] <= -part.0[axis + 4]);
                assert!(parts.iter().any(has_point), "{point:?}");
            }
        }
    }
}
