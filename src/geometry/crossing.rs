//! Where the half-line from a point along +x crosses a surface, decided exactly: what tells whether a point is inside.
//!
//! A closed surface is a set of triangles of which each edge is one of an even number of triangles, with the same end
//! points; spheres are closed by themselves. A half-line that meets no edge and touches nothing crosses it an odd
//! number of times just where it begins inside. The half-line from the point `p` itself may run through edges and
//! vertices, or within triangles; so it is moved: from `p' = p + (0, e, e^2)`, with `e > 0` smaller than anything that
//! the input could tell apart (Edelsbrunner and Muecke 1990, "Simulation of simplicity"). If `p` is on no triangle then
//! `p'` is inside what `p` is inside of.
//!
//! Seen along x, a point's turn around an edge from `u` to `v`, `(u - p') x (v - p')`, is
//!
//! ```text
//! (u - p) x (v - p) + e (u.z - v.z) + e^2 (v.y - u.y)
//! ```
//!
//! and has the sign of the first term that is not 0. It changes its sign with the edge's direction, so that the triangles
//! on both sides of an edge agree about it. All three terms are 0 only for an edge that runs along x: its triangle is seen
//! as a segment, which for small `e` does not contain `p'`, as the three turns of any triangle seen so tell: their sum,
//! twice the area, is 0. So the line through `p'` meets no edge, and crosses a triangle where the three turns have one
//! sign. It does so at a point as near as one likes to a point `x` of the closed triangle that has the `y` and `z` of `p`.
//! Whether ahead of `p'` or behind, the side tells on which `p` lies of the triangle's plane: exactly on the plane `p` is
//! `x`, on the triangle.
//!
//! No triangle needs to be looked at whose box the half-line from `p` itself does not meet: `x` is in that box, and in that
//! of one of the triangle's parts, and in one of the cells that list the triangle. If `p` is on a triangle, `x` is `p`. A
//! structure's walk along that half-line comes by all of these, since its boxes and cells err on the outer side.
//!
//! The turn and the side are determinants of `f32`, whose signs [`robust`] tells exactly (Shewchuk 1997, "Adaptive precision
//! floating-point arithmetic and fast robust geometric predicates"): nothing overflows in `f64`, nor do the products of
//! three multiples of 2^-149 underflow.

use robust::{Coord, Coord3D};

use super::{Sphere, Triangle};
use crate::math::{Expansion, widen};

/// How the half-line from a point along +x, moved as above, crosses a primitive.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Crossing {
    /// Not at all, or an even number of times.
    None,
    Once,
    /// The point itself is on it.
    AtPoint,
}

impl Triangle {
    /// Of a triangle that has an area.
    pub(crate) fn crossing(&self, point: [f32; 3]) -> Crossing {
        let [x, y, z] = &self.axes;
        let is_beside = |values: &[f32; 3], at: f32| values.iter().all(|v| *v < at) || values.iter().all(|v| *v > at);
        if is_beside(y, point[1]) || is_beside(z, point[2]) || x.iter().all(|v| *v < point[0]) {
            return Crossing::None;
        }
        let turns = self.turns(1, 2, point);
        if has_both_signs(&turns) {
            return Crossing::None;
        }
        let side = self.side(point);
        if side == 0.0 {
            // A point of the plane is in the triangle where it is in each of its projections.
            let is_outside = [(2, 0), (0, 1)].into_iter().any(|(u, v)| has_both_signs(&self.turns(u, v, point)));
            return if is_outside { Crossing::None } else { Crossing::AtPoint };
        }
        let is_ahead = (0..3).all(|edge| {
            let (u, v) = ((edge + 1) % 3, (edge + 2) % 3);
            let moved = [turns[edge], widen(z[u]) - widen(z[v]), widen(y[v]) - widen(y[u])];
            let turn = moved.into_iter().find(|&term| term != 0.0).unwrap_or(0.0);
            if side > 0.0 { turn > 0.0 } else { turn < 0.0 }
        });
        if is_ahead { Crossing::Once } else { Crossing::None }
    }

    /// Of the edges opposite to each vertex, as seen along the third axis.
    fn turns(&self, u: usize, v: usize, point: [f32; 3]) -> [f64; 3] {
        let corner = |at: usize| Coord { x: widen(self.axes[u][at % 3]), y: widen(self.axes[v][at % 3]) };
        let point = Coord { x: widen(point[u]), y: widen(point[v]) };
        [0, 1, 2].map(|opposite| robust::orient2d(corner(opposite + 1), corner(opposite + 2), point))
    }

    /// Where the vertices turn left as seen along x: positive for points with a lesser x than the plane has there.
    fn side(&self, point: [f32; 3]) -> f64 {
        let [x, y, z] = &self.axes;
        let corner = |at: usize| Coord3D { x: widen(x[at]), y: widen(y[at]), z: widen(z[at]) };
        let point = Coord3D { x: widen(point[0]), y: widen(point[1]), z: widen(point[2]) };
        robust::orient3d(corner(0), corner(1), corner(2), point)
    }
}

fn has_both_signs(turns: &[f64; 3]) -> bool {
    turns.iter().any(|turn| *turn < 0.0) && turns.iter().any(|turn| *turn > 0.0)
}

impl Sphere {
    /// A half-line that begins inside crosses it once, any other one twice or not at all.
    pub(crate) fn crossing(&self, point: [f32; 3]) -> Crossing {
        let offset = [0, 1, 2].map(|axis| Expansion::difference(point[axis], self.centre[axis]));
        let radius = Expansion::difference(self.radius, 0.0);
        let [x, y, z] = offset.each_ref().map(|offset| offset * offset);
        let excess = (x + y + z - &radius * &radius).to_f64();
        if excess > 0.0 {
            Crossing::None
        } else if excess < 0.0 {
            Crossing::Once
        } else {
            Crossing::AtPoint
        }
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    type Point = [i32; 3];

    /// Six times the volume of a tetrahedron.
    fn volume([a, b, c, d]: [Point; 4]) -> i32 {
        let [p, q, r] = [b, c, d].map(|v| [v[0] - a[0], v[1] - a[1], v[2] - a[2]]);
        p[0] * (q[1] * r[2] - q[2] * r[1]) + p[1] * (q[2] * r[0] - q[0] * r[2]) + p[2] * (q[0] * r[1] - q[1] * r[0])
    }

    /// So few that points are often in line with vertices, edges and faces, or on them.
    fn lattice_point() -> impl Strategy<Value = Point> {
        [0..5, 0..5, 0..5]
    }

    proptest! {
        // One in eight has its corners in a plane.
        #![proptest_config(ProptestConfig { max_global_rejects: 20_000, ..ProptestConfig::with_cases(20_000) })]

        #[test]
        fn tetrahedron_is_crossed_an_odd_number_of_times_just_from_inside(
            corners in [lattice_point(), lattice_point(), lattice_point(), lattice_point()],
            point in lattice_point(),
            scale in prop::sample::select(vec![1.0, 2f32.powi(-147), 2f32.powi(120)]),
        ) {
            let whole = volume(corners);
            prop_assume!(whole != 0);
            let shares = [0, 1, 2, 3].map(|at| {
                let mut part = corners;
                part[at] = point;
                volume(part) * whole.signum()
            });
            let scaled = |p: Point| p.map(|c| c as f32 * scale);
            let crossings = [[1, 2, 3], [0, 3, 2], [0, 1, 3], [0, 2, 1]]
                .map(|face| Triangle::new(face.map(|at: usize| scaled(corners[at])), 0, 0).crossing(scaled(point)));
            let is_on = crossings.contains(&Crossing::AtPoint);
            let count = crossings.iter().filter(|crossing| **crossing == Crossing::Once).count();
            prop_assert_eq!(is_on, shares.iter().all(|share| *share >= 0) && shares.contains(&0));
            prop_assert!(is_on || (count % 2 == 1) == shares.iter().all(|share| *share > 0));
        }
    }

    #[test]
    fn sphere_is_crossed_once_from_inside_and_touched_exactly() {
        let sphere = Sphere { centre: [1.0, 2.0, -1e10], radius: 5.0, geometry_id: 0, primitive_id: 0 };
        let crossing = |x: f32, y: f32| sphere.crossing([x, y, -1e10]);
        assert_eq!(crossing(4.0, 6.0), Crossing::AtPoint);
        assert_eq!(crossing(4.0, 6f32.next_down()), Crossing::Once);
        assert_eq!(crossing(4.0, 6f32.next_up()), Crossing::None);
        assert_eq!(crossing(-9.0, 2.0), Crossing::None);
    }
}
