//! A triangle as every structure stores it.

use glam::{DVec3, Vec3};
use robust::{Coord, Coord3D};

use super::Aabb;
use crate::math::{Expansion, gamma, widen};

/// The vertices, a row for each axis: `axes[1][2]` is the y of the third vertex. A ray's axis permutation then is a
/// choice of rows.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Triangle {
    pub(crate) axes: [[f32; 3]; 3],
    pub(crate) geometry_id: u32,
    pub(crate) primitive_id: u32,
}

impl Triangle {
    pub(crate) fn new(vertices: [[f32; 3]; 3], geometry_id: u32, primitive_id: u32) -> Self {
        let axes = std::array::from_fn(|axis| vertices.map(|vertex| vertex[axis]));
        Self { axes, geometry_id, primitive_id }
    }

    fn vertex(&self, corner: usize) -> [f32; 3] {
        self.axes.map(|row| row[corner])
    }

    pub(crate) fn bounds(&self) -> Aabb {
        let [a, b, c] = std::array::from_fn(|corner| Vec3::from_array(self.vertex(corner)));
        Aabb { lower: a.min(b).min(c), upper: a.max(b).max(c) }
    }

    /// `(p1 - p0) x (p2 - p0)`, each component rounded once from `f64`.
    pub(crate) fn normal(&self) -> Vec3 {
        let [a, b, c] = std::array::from_fn(|corner| Vec3::from_array(self.vertex(corner)).as_dvec3());
        DVec3::cross(b - a, c - a).as_vec3()
    }

    /// Whether the three points lie on a line, exactly: then so do their projections along each axis
    /// (Shewchuk 1997, "Adaptive precision floating-point arithmetic and fast robust geometric predicates": orient2d).
    #[inline(always)]
    pub(crate) fn has_zero_area(&self) -> bool {
        !self.surely_has_area() && self.has_exactly_zero_area()
    }

    /// Decides most triangles in `f32`. A component of the cross product of two edges is off by four roundings in each
    /// product (one for each edge, one of its own, one in the difference), and by underflow; a NaN or an infinity
    /// leaves it open.
    #[inline(always)]
    fn surely_has_area(&self) -> bool {
        let edges = |axis: usize| {
            let [a, b, c] = self.axes[axis];
            (b - a, c - a)
        };
        let (x, y, z) = (edges(0), edges(1), edges(2));
        let is_sure = |p: (f32, f32), q: (f32, f32)| {
            let (first, second) = (p.0 * q.1, q.0 * p.1);
            (first - second).abs() > gamma(8) * (first.abs() + second.abs()) + f32::MIN_POSITIVE
        };
        is_sure(x, y) | is_sure(y, z) | is_sure(z, x)
    }

    #[cold]
    fn has_exactly_zero_area(&self) -> bool {
        [(0, 1), (1, 2), (2, 0)].into_iter().all(|(x, y)| {
            let [a, b, c] = std::array::from_fn(|corner| Coord {
                x: f64::from(self.axes[x][corner]),
                y: f64::from(self.axes[y][corner]),
            });
            robust::orient2d(a, b, c) == 0.0
        })
    }

    /// Whether each of these vertices is at the place of one of those of the other.
    pub(crate) fn corners_are_among(&self, these: [bool; 3], other: &Self, those: [bool; 3]) -> bool {
        let is_there = |at: [f32; 3]| (0..3).any(|corner| those[corner] && other.vertex(corner) == at);
        (0..3).all(|corner| !these[corner] || is_there(self.vertex(corner)))
    }

    /// Whether all vertices of both have one coordinate in common.
    pub(crate) fn lies_across_an_axis_with(&self, other: &Self) -> bool {
        (0..3).any(|axis| {
            let at = self.axes[axis][0];
            self.axes[axis] == [at; 3] && other.axes[axis] == [at; 3]
        })
    }

    /// Exactly (Shewchuk 1997: orient3d).
    pub(crate) fn lies_in_plane_of(&self, other: &Self) -> bool {
        let point = |triangle: &Self, corner: usize| {
            let [x, y, z] = triangle.vertex(corner).map(widen);
            Coord3D { x, y, z }
        };
        let [a, b, c] = std::array::from_fn(|corner| point(other, corner));
        (0..3).all(|corner| robust::orient3d(a, b, c, point(self, corner)) == 0.0)
    }

    /// Six times the volume between the triangle and the point, `a . (b x c)` of the vertices relative to the point:
    /// computed exactly, then rounded to within an ulp. 0 for a point of the triangle's plane alone.
    pub(crate) fn signed_volume(&self, point: [f32; 3]) -> f64 {
        let [x, y, z]: [[Expansion; 3]; 3] =
            std::array::from_fn(|axis| self.axes[axis].map(|v| Expansion::difference(v, point[axis])));
        let minor = |p: &[Expansion; 3], q: &[Expansion; 3]| &p[1] * &q[2] - &p[2] * &q[1];
        (&x[0] * &minor(&y, &z) + &y[0] * &minor(&z, &x) + &z[0] * &minor(&x, &y)).to_f64()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn triangle(vertices: [[f32; 3]; 3]) -> Triangle {
        Triangle::new(vertices, 0, 0)
    }

    #[test]
    fn zero_area_is_decided_exactly() {
        assert!(triangle([[1.0, 2.0, 3.0]; 3]).has_zero_area());
        assert!(triangle([[0.1, 0.2, 0.3], [0.2, 0.4, 0.6], [0.4, 0.8, 1.2]]).has_zero_area());
        // One ulp off the line in one coordinate.
        assert!(!triangle([[0.1, 0.2, 0.3], [0.2, 0.4, 0.6], [0.4, 0.8, 1.2f32.next_up()]]).has_zero_area());
        // Edges that f64 cannot subtract exactly.
        assert!(!triangle([[1e30, 0.0, 0.0], [0.0, 1e-30, 0.0], [-1e30, 3e-30, 0.0]]).has_zero_area());
    }

    #[test]
    fn signed_volume_is_exact_where_doubles_cancel() {
        let floor = triangle([[1.0, 0.1, 0.0], [-0.3, 0.7, 0.0], [0.2, -0.9, 0.0]]);
        let least = f32::from_bits(1);
        assert_eq!(floor.signed_volume([0.1, 0.2, 0.0]), 0.0);
        let above = floor.signed_volume([0.1, 0.2, least]);
        assert_eq!(above, -floor.signed_volume([0.1, 0.2, -least]));
        assert!(above < 0.0 && above > -4.0 * f64::from(least));
    }

    #[test]
    fn normal_follows_the_winding() {
        let normal = triangle([[0.0, 0.0, 0.0], [2.0, 0.0, 0.0], [0.0, 3.0, 0.0]]).normal();
        assert_eq!(normal, Vec3::new(0.0, 0.0, 6.0));
    }
}
