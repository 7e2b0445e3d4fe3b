//! Rays that go the same way as one: a node's eight boxes against all of them at once.
//!
//! Source: Wald, Boulos, Shirley 2007, "Ray tracing deformable scenes using dynamic bounding volume hierarchies",
//! section 4, for the interval test.

use glam::Vec3;

use super::WideBvh;
use super::coherent::Coherent;
use super::node::WideNode;
use crate::math::gamma;
use crate::simd::Simd;

/// All rays as one, in the form `sign * plane`: for each axis the side of near planes, and intervals.
pub(super) struct Beam<S: Simd> {
    near_side: [usize; 3],
    sign: [S::F32x8; 3],
    /// The largest and the least `sign * origin`.
    origin: [[S::F32x8; 2]; 3],
    /// The least and the largest `|1 / direction|`.
    inverse: [[S::F32x8; 2]; 3],
    slack: [S::F32x8; 3],
    t_min: S::F32x8,
}

impl<S: Simd> Beam<S> {
    #[inline(always)]
    pub(super) fn new(simd: S, bvh: &WideBvh, coherent: &Coherent) -> Self {
        let [x, y, z] = coherent.origin_ends;
        let (lower, upper) = (Vec3::new(x[0], y[0], z[0]), Vec3::new(x[1], y[1], z[1]));
        let reach = bvh.bounds.reach_from(lower).max(bvh.bounds.reach_from(upper));
        let slack_distance = gamma(24) * reach + f32::MIN_POSITIVE;
        let t_min = coherent.least_t_min;
        let side = |axis: usize| (coherent.signs >> axis & 1) as usize;
        let sign = |axis: usize| if side(axis) == 1 { -1.0 } else { 1.0 };
        let origin = |axis: usize| {
            let [a, b] = coherent.origin_ends[axis].map(|end| sign(axis) * end);
            [simd.splat(a.max(b)), simd.splat(a.min(b))]
        };
        // The inverse of a rounded direction is monotonic, so its ends are those of the directions.
        let ends = |axis: usize| {
            let [a, b] = coherent.direction_ends[axis].map(|end| (1.0 / end).abs());
            (a.min(b), a.max(b))
        };
        let inverse = |axis: usize| [simd.splat(ends(axis).0), simd.splat(ends(axis).1)];
        let slack = |axis: usize| simd.splat(slack_distance * ends(axis).1 + f32::MIN_POSITIVE);
        Self {
            near_side: [side(0), side(1), side(2)],
            sign: [simd.splat(sign(0)), simd.splat(sign(1)), simd.splat(sign(2))],
            origin: [origin(0), origin(1), origin(2)],
            inverse: [inverse(0), inverse(1), inverse(2)],
            slack: [slack(0), slack(1), slack(2)],
            t_min: simd.splat(t_min),
        }
    }

    /// The slots that any ray may meet, and where the first may enter each. The distance of a plane from the origins,
    /// times the inverses, makes an interval; its ends round as a single ray's distances do, which the slack covers
    /// (`geometry/aabb.rs`), here that of the ray that needs most.
    #[inline(always)]
    pub(super) fn test(&self, simd: S, node: &WideNode, t_max: f32) -> (u32, S::F32x8) {
        let (near_x, far_x) = self.slab(simd, node, 0);
        let (near_y, far_y) = self.slab(simd, node, 1);
        let (near_z, far_z) = self.slab(simd, node, 2);
        let enter = simd.max(near_x, simd.max(near_y, simd.max(near_z, self.t_min)));
        let leave = simd.min(far_x, simd.min(far_y, simd.min(far_z, simd.splat(t_max))));
        (simd.less_or_equal(enter, leave), enter)
    }

    #[inline(always)]
    fn slab(&self, simd: S, node: &WideNode, axis: usize) -> (S::F32x8, S::F32x8) {
        let side = self.near_side[axis] & 1;
        let [least, most] = self.inverse[axis];
        let near = simd.mul_sub(simd.load(&node.planes[axis][side]), self.sign[axis], self.origin[axis][0]);
        let far = simd.mul_sub(simd.load(&node.planes[axis][side ^ 1]), self.sign[axis], self.origin[axis][1]);
        let enter = simd.min(simd.mul(near, least), simd.mul(near, most));
        let leave = simd.max(simd.mul(far, least), simd.mul(far, most));
        (simd.sub(enter, self.slack[axis]), simd.add(leave, self.slack[axis]))
    }
}
