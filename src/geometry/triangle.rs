//! A triangle as every structure stores it.

use glam::{DVec3, Vec3};
use robust::Coord;

use super::Aabb;

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
    pub(crate) fn has_zero_area(&self) -> bool {
        [(0, 1), (1, 2), (2, 0)].into_iter().all(|(x, y)| {
            let [a, b, c] = std::array::from_fn(|corner| Coord {
                x: f64::from(self.axes[x][corner]),
                y: f64::from(self.axes[y][corner]),
            });
            robust::orient2d(a, b, c) == 0.0
        })
    }

    /// Whether the point lies in the triangle's plane, exactly (orient3d of the same paper).
    pub(crate) fn plane_contains(&self, point: [f32; 3]) -> bool {
        let coordinates = |p: [f32; 3]| robust::Coord3D { x: f64::from(p[0]), y: f64::from(p[1]), z: f64::from(p[2]) };
        let [a, b, c] = std::array::from_fn(|corner| coordinates(self.vertex(corner)));
        robust::orient3d(a, b, c, coordinates(point)) == 0.0
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
    fn normal_follows_the_winding() {
        let normal = triangle([[0.0, 0.0, 0.0], [2.0, 0.0, 0.0], [0.0, 3.0, 0.0]]).normal();
        assert_eq!(normal, Vec3::new(0.0, 0.0, 6.0));
    }
}
