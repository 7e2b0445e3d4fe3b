//! Eight hits at once, each of one ray on one triangle: for those that a single evaluation finds
//! [inside](super::evaluation::Evaluation::Inside), the same to the bit.

use super::evaluation::{LEAST_NORMAL, RELATIVE_ERROR};
use super::{PrecisionMode, Triangle, TriangleHit, TriangleRay};
use crate::math::rounds_alike;

/// How many hits are evaluated at once.
pub(crate) const HITS: usize = 8;

/// One value a hit.
type Row = [f32; HITS];

/// Rays and triangles, value by value; axes in the order of each ray.
#[derive(Clone, Copy, Debug)]
pub(crate) struct HitLanes {
    origin: [Row; 3],
    direction: [Row; 3],
    vertices: [[Row; 3]; 3],
}

impl HitLanes {
    pub(crate) const EMPTY: Self =
        Self { origin: [[0.0; HITS]; 3], direction: [[0.0; HITS]; 3], vertices: [[[0.0; HITS]; 3]; 3] };

    /// Of rays whose axes are in the same order.
    #[inline(always)]
    pub(crate) fn of_rays(origin: [Row; 3], direction: [Row; 3]) -> Self {
        Self { origin, direction, ..Self::EMPTY }
    }

    #[inline(always)]
    pub(crate) fn set(&mut self, lane: usize, ray: &TriangleRay, triangle: &Triangle) {
        for axis in 0..3 {
            self.origin[axis][lane % HITS] = ray.origin[axis];
            self.direction[axis][lane % HITS] = ray.direction[axis];
        }
        self.set_triangle(lane, ray.axes, triangle);
    }

    /// `axes` are those of the lane's ray.
    #[inline(always)]
    pub(crate) fn set_triangle(&mut self, lane: usize, axes: [usize; 3], triangle: &Triangle) {
        for (axis, of_ray) in axes.into_iter().enumerate() {
            for corner in 0..3 {
                self.vertices[axis][corner][lane % HITS] = triangle.axes[of_ray % 3][corner];
            }
        }
    }

    /// `[t, u, v]`; `t` is NaN where one evaluation in `f64` does not settle it.
    ///
    /// By the operations of `Evaluation::inside`, in their order.
    #[inline(always)]
    pub(crate) fn evaluate<P: PrecisionMode>(&self) -> [Row; 3] {
        const ROUNDOFF: f64 = f64::EPSILON * 0.5;

        let [ox, oy, oz] = &self.origin;
        let [dx, dy, dz] = &self.direction;
        let [[vx0, vx1, vx2], [vy0, vy1, vy2], [vz0, vz1, vz2]] = &self.vertices;
        let mut hits = [[0.0; HITS]; 3];
        let [out_t, out_u, out_v] = &mut hits;
        // A plain loop over arrays, which the compiler vectorises.
        for lane in 0..HITS {
            let wide = |row: &Row| f64::from(row[lane]);
            let (dx, dy, dz) = (wide(dx), wide(dy), wide(dz));
            let (ox, oy, oz) = (wide(ox), wide(oy), wide(oz));
            let (ax0, ax1, ax2) = (wide(vx0) - ox, wide(vx1) - ox, wide(vx2) - ox);
            let (ay0, ay1, ay2) = (wide(vy0) - oy, wide(vy1) - oy, wide(vy2) - oy);
            let (az0, az1, az2) = (wide(vz0) - oz, wide(vz1) - oz, wide(vz2) - oz);
            let (x0, x1, x2) = (ax0 * dz - dx * az0, ax1 * dz - dx * az1, ax2 * dz - dx * az2);
            let (y0, y1, y2) = (ay0 * dz - dy * az0, ay1 * dz - dy * az1, ay2 * dz - dy * az2);
            let (a, b, c) = (x2 * y1 - y2 * x1, x0 * y2 - y0 * x2, x1 * y0 - y1 * x0);

            let size = (x0.abs() + y0.abs()) + (x1.abs() + y1.abs()) + (x2.abs() + y2.abs());
            let depth = most(most(az0.abs(), az1.abs()), az2.abs());
            let reach = 16.0 * ROUNDOFF * (size + depth * dz.abs());
            let bound = reach * (size + reach);
            let (least, greatest) = (-most(-a, most(-b, -c)), most(a, most(b, c)));

            let sum = a + b + c;
            let weighted = a * az0 + b * az1 + c * az2;
            let t_bound = (6.0 * bound + 5.0 * ROUNDOFF * sum.abs()) * depth;
            let is_inside = (least > bound) | (greatest < -bound);
            let is_settled =
                is_inside & (3.0 * bound <= RELATIVE_ERROR * sum.abs()) & (t_bound <= RELATIVE_ERROR * weighted.abs());
            let inverse = 1.0 / (sum * dz);
            let per_sum = dz * inverse;
            let t = weighted * inverse;
            let is_settled = is_settled
                & (!P::IS_EXACT
                    || (depth >= LEAST_NORMAL)
                        & (dz.abs() >= LEAST_NORMAL)
                        & rounds_alike(t, 3.0 * t_bound * inverse.abs()));
            out_t[lane] = if is_settled { t as f32 } else { f32::NAN };
            out_u[lane] = (b * per_sum) as f32;
            out_v[lane] = (c * per_sum) as f32;
        }
        hits
    }
}

/// The greater; NaN decides nothing.
#[inline(always)]
fn most(a: f64, b: f64) -> f64 {
    if a > b { a } else { b }
}

/// A lane of [`HitLanes::evaluate`], where it is settled.
#[inline(always)]
pub(crate) fn settled([t, u, v]: &[Row; 3], lane: usize) -> Option<TriangleHit> {
    let lane = lane % HITS;
    (!t[lane].is_nan()).then_some(TriangleHit { t: t[lane], u: u[lane], v: v[lane] })
}
