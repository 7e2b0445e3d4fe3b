//! What planes leave of a triangle, in `f64`.
//!
//! Source: Sutherland and Hodgman 1974, "Reentrant polygon clipping".

use glam::DVec3;

use super::Triangle;

/// A convex polygon.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Polygon {
    vertices: [DVec3; MOST_VERTICES],
    count: u32,
}

/// A triangle that all six sides of a box cut has nine. What would have more stays as it was: it covers what it should.
const MOST_VERTICES: usize = 9;

impl Polygon {
    pub(crate) fn of(triangle: &Triangle) -> Self {
        let mut vertices = [DVec3::ZERO; MOST_VERTICES];
        for (corner, vertex) in vertices[..3].iter_mut().enumerate() {
            *vertex = DVec3::from_array(triangle.axes.map(|row| f64::from(row[corner])));
        }
        Self { vertices, count: 3 }
    }

    /// A parallelogram around its centre.
    pub(crate) fn parallelogram(centre: DVec3, half_sides: [DVec3; 2]) -> Self {
        let [a, b] = half_sides;
        let mut vertices = [DVec3::ZERO; MOST_VERTICES];
        vertices[..4].copy_from_slice(&[centre - a - b, centre + a - b, centre + a + b, centre - a + b]);
        Self { vertices, count: 4 }
    }

    #[inline(always)]
    pub(crate) fn vertices(&self) -> &[DVec3] {
        &self.vertices[..self.count as usize]
    }

    /// The part where `height`, an affine function, is not positive; `None` where there is no point of it. Each vertex
    /// that is made is off by three roundings of the coordinates.
    #[inline(always)]
    pub(crate) fn below(&self, height: impl Fn(DVec3) -> f64) -> Option<Self> {
        let mut kept = Self { vertices: [DVec3::ZERO; MOST_VERTICES], count: 0 };
        let mut count = 0;
        let mut push = |vertex| {
            if let Some(place) = kept.vertices.get_mut(count) {
                *place = vertex;
            }
            count += 1;
        };
        let vertices = self.vertices();
        let mut from = *vertices.last()?;
        let mut from_height = height(from);
        for &to in vertices {
            let to_height = height(to);
            if (from_height > 0.0) != (to_height > 0.0) && from_height != 0.0 && to_height != 0.0 {
                // From the lower end, so that both sides of a plane get the same vertex.
                let (low, high) = if to_height > 0.0 { (from, to) } else { (to, from) };
                let (low_height, high_height) = (from_height.min(to_height), from_height.max(to_height));
                push(low + (high - low) * (low_height / (low_height - high_height)));
            }
            if to_height <= 0.0 {
                push(to);
            }
            (from, from_height) = (to, to_height);
        }
        kept.count = count as u32;
        match count {
            0 => None,
            1..=MOST_VERTICES => Some(kept),
            _ => Some(*self),
        }
    }

    /// The least and the greatest of `height` over it.
    #[inline(always)]
    pub(crate) fn extent(&self, height: impl Fn(DVec3) -> f64) -> (f64, f64) {
        self.vertices()
            .iter()
            .map(|&vertex| height(vertex))
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(least, greatest), h| (least.min(h), greatest.max(h)))
    }

    /// Its corners' least and greatest coordinates.
    #[inline(always)]
    pub(crate) fn bounds(&self) -> (DVec3, DVec3) {
        let none = (DVec3::INFINITY, DVec3::NEG_INFINITY);
        self.vertices().iter().fold(none, |(lower, upper), &vertex| (lower.min(vertex), upper.max(vertex)))
    }

    /// Twice its area, as a vector normal to it.
    pub(crate) fn doubled_area(&self) -> DVec3 {
        self.doubled_area_below(|_| 0.0)
    }

    /// Of the part that [`Polygon::below`] gives.
    #[inline(always)]
    pub(crate) fn doubled_area_below(&self, height: impl Fn(DVec3) -> f64) -> DVec3 {
        let mut sum = DVec3::ZERO;
        let mut corners: Option<(DVec3, DVec3)> = None;
        let mut push = |vertex: DVec3| {
            let (first, last) = corners.map_or((vertex, DVec3::ZERO), |(first, last)| (first, last));
            let arm = vertex - first;
            sum += last.cross(arm);
            corners = Some((first, arm));
        };
        let vertices = self.vertices();
        let Some(&(mut from)) = vertices.last() else { return sum };
        let mut from_height = height(from);
        for &to in vertices {
            let to_height = height(to);
            if (from_height > 0.0) != (to_height > 0.0) {
                push(from + (to - from) * (from_height / (from_height - to_height)));
            }
            if to_height <= 0.0 {
                push(to);
            }
            (from, from_height) = (to, to_height);
        }
        sum
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn triangle(vertices: [[f32; 3]; 3]) -> Polygon {
        Polygon::of(&Triangle::new(vertices, 0, 0))
    }

    /// SplitMix64 (Steele, Lea, Flood 2014), in `[-1, 1)`.
    fn random(state: &mut u64) -> f32 {
        *state = state.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let z = (*state ^ (*state >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        ((z ^ (z >> 31)) >> 40) as f32 / (1u64 << 23) as f32 - 1.0
    }

    #[test]
    fn parts_hold_every_sample_of_the_triangle_on_their_side() {
        for seed in 0..2000 {
            let mut state = seed;
            let whole = triangle([[0; 3]; 3].map(|vertex| vertex.map(|_: i32| random(&mut state))));
            let normal = DVec3::from_array([0; 3].map(|_| f64::from(random(&mut state))));
            let height = |point: DVec3| normal.dot(point) - 0.1;
            let parts = [whole.below(height), whole.below(|point| -height(point))];
            let [a, b, c] = [0, 1, 2].map(|corner| whole.vertices()[corner]);
            for sample in 0..64 {
                let (u, v) = (f64::from(sample % 8) / 7.0, f64::from(sample / 8) / 7.0);
                let point = if u + v > 1.0 {
                    a + (b - a) * (1.0 - u) + (c - a) * (1.0 - v)
                } else {
                    a + (b - a) * u + (c - a) * v
                };
                let part = parts[usize::from(height(point) > 0.0)].expect("a part on the side of the sample");
                let (lower, upper) = part.bounds();
                let slack = DVec3::splat(8.0 * f64::EPSILON);
                assert!(
                    point.cmpge(lower - slack).all() && point.cmple(upper + slack).all(),
                    "seed {seed}: {point:?} is not in {part:?}"
                );
            }
            let area = parts.into_iter().flatten().map(|part| part.doubled_area().length()).sum::<f64>();
            assert!((area - whole.doubled_area().length()).abs() < 1e3 * f64::EPSILON, "seed {seed}");
            let below = whole.doubled_area_below(height);
            assert!((below - parts[0].map_or(DVec3::ZERO, |part| part.doubled_area())).length() < 1e3 * f64::EPSILON);
        }
    }

    #[test]
    fn a_triangle_with_all_vertices_outside_leaves_its_part_in_a_cell() {
        let whole = triangle([[-4.0, 0.5, -3.0], [5.0, 0.5, -3.0], [0.5, 0.5, 6.0]]);
        let mut part = Some(whole);
        for axis in 0..3 {
            part = part.and_then(|part| part.below(|point| point[axis] - 1.0));
            part = part.and_then(|part| part.below(|point| -point[axis]));
        }
        let part = part.expect("the triangle covers the whole cut of the cell");
        assert_eq!(part.bounds(), (DVec3::new(0.0, 0.5, 0.0), DVec3::new(1.0, 0.5, 1.0)));
        assert_eq!(part.doubled_area(), DVec3::new(0.0, -2.0, 0.0));
    }

    #[test]
    fn what_lies_in_the_plane_or_touches_it_stays() {
        let flat = triangle([[0.0, 1.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 1.0]]);
        assert_eq!(flat.below(|point| point.y - 1.0).map(|part| part.bounds()), Some(flat.bounds()));
        assert!(flat.below(|point| point.x).is_some_and(|part| part.bounds().1.x == 0.0));
        assert!(flat.below(|point| point.y - 0.5).is_none());
    }
}
