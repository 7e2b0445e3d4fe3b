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

    pub(crate) fn vertices(&self) -> [[f32; 3]; 3] {
        [self.vertex(0), self.vertex(1), self.vertex(2)]
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

    /// As [`Triangle::normal`] in `f64`, with a bound on the error of each component, at most 2^-33 of the largest one.
    ///
    /// A component is the difference of two products: three roundings in each and one of its own, a relative error of four;
    /// twice that, so that it covers a few more of what is done with it.
    pub(super) fn certain_normal(&self) -> (DVec3, f64) {
        const RELATIVE_ERROR: f64 = 1.0 / (1u64 << 33) as f64;
        let edges = |axis: usize| {
            let [a, b, c] = self.axes[axis].map(f64::from);
            (b - a, c - a)
        };
        let (x, y, z) = (edges(0), edges(1), edges(2));
        let products = |p: (f64, f64), q: (f64, f64)| (p.0 * q.1, q.0 * p.1);
        let terms = [products(y, z), products(z, x), products(x, y)];
        let normal = DVec3::from_array(terms.map(|(first, second)| first - second));
        let size = terms.iter().fold(0.0, |most: f64, (first, second)| most.max(first.abs() + second.abs()));
        let bound = 4.0 * f64::EPSILON * size;
        if bound <= RELATIVE_ERROR * normal.abs().max_element() {
            return (normal, bound);
        }
        let normal = DVec3::from_array(self.exact_normal().map(|component| component.to_f64()));
        (normal, 4.0 * f64::EPSILON * normal.abs().max_element())
    }

    #[cold]
    fn exact_normal(&self) -> [Expansion; 3] {
        let [x, y, z] = self.axes.map(|[a, b, c]| (Expansion::difference(b, a), Expansion::difference(c, a)));
        let minor = |p: &(Expansion, Expansion), q: &(Expansion, Expansion)| &p.0 * &q.1 - &q.0 * &p.1;
        [minor(&y, &z), minor(&z, &x), minor(&x, &y)]
    }

    /// To which side of the plane a direction leads, exactly; as [`Triangle::side_of_point`]. Takes what
    /// [`Triangle::certain_normal`] gives.
    pub(super) fn side_of_direction(&self, (normal, bound): (DVec3, f64), direction: Vec3) -> f64 {
        let d = direction.as_dvec3();
        let along = normal.dot(d);
        if along.abs() > 2.0 * bound * d.abs().element_sum() {
            return along;
        }
        let [x, y, z] = self.exact_normal();
        let [dx, dy, dz] = direction.to_array().map(|d| Expansion::difference(d, 0.0));
        (&x * &dx + &y * &dy + &z * &dz).to_f64()
    }

    /// Whether each of these vertices is at the place of one of those of the other.
    pub(crate) fn corners_are_among(&self, these: [bool; 3], other: &Self, those: [bool; 3]) -> bool {
        let is_there = |at: [f32; 3]| (0..3).any(|corner| those[corner] && other.vertex(corner) == at);
        (0..3).all(|corner| !these[corner] || is_there(self.vertex(corner)))
    }

    /// Whether all vertices have this coordinate in common.
    pub(crate) fn lies_across(&self, axis: usize) -> bool {
        self.axes[axis] == [self.axes[axis][0]; 3]
    }

    /// Whether all vertices of both have one coordinate in common.
    pub(crate) fn lies_across_an_axis_with(&self, other: &Self) -> bool {
        (0..3).any(|axis| self.lies_across(axis) && other.axes[axis] == self.axes[axis])
    }

    /// Exactly.
    pub(crate) fn lies_in_plane_of(&self, other: &Self) -> bool {
        (0..3).all(|corner| other.side_of_point(self.vertex(corner)) == 0.0)
    }

    /// On which side of the plane a point is: above 0 where the normal points, below, or 0 in the plane. Exactly (Shewchuk
    /// 1997: orient3d).
    pub(super) fn side_of_point(&self, point: [f32; 3]) -> f64 {
        let [a, b, c, point] = [self.vertex(0), self.vertex(1), self.vertex(2), point].map(|point| {
            let [x, y, z] = point.map(widen);
            Coord3D { x, y, z }
        });
        -robust::orient3d(a, b, c, point)
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
