//! A node's eight boxes against a ray.

use glam::Vec4;

use super::node::WideNode;
use crate::geometry::{ObliqueSlabs, SlabRay};
use crate::simd::{LANES, Simd};

/// Eight boxes against a ray: the slots that it meets, and where it enters each.
pub(super) trait BoxTest<S: Simd> {
    /// Box distances count in lengths of the scaled direction: multiply a `t` by this.
    fn scale_time(&self, t: f32) -> f32;
    fn test(&self, simd: S, node: &WideNode, t_min: S::F32x8, t_max: f32) -> (u32, S::F32x8);
}

/// `plane * inverse - offset`: one operation a plane.
pub(super) struct Oblique<S: Simd> {
    /// For each axis where the near planes begin among both rows: 0 or 8.
    near: [usize; 3],
    inverse: [S::F32x8; 3],
    near_offset: [S::F32x8; 3],
    far_offset: [S::F32x8; 3],
}

impl<S: Simd> Oblique<S> {
    #[inline(always)]
    pub(super) fn new(simd: S, slabs: &ObliqueSlabs) -> Self {
        let negative = slabs.negative as usize;
        Self {
            near: [negative << 3 & LANES, negative << 2 & LANES, negative << 1 & LANES],
            inverse: splat4(simd, slabs.inverse),
            near_offset: splat4(simd, slabs.near_offset),
            far_offset: splat4(simd, slabs.far_offset),
        }
    }

    #[inline(always)]
    fn planes<'a>(&self, node: &'a WideNode, axis: usize) -> (&'a [f32; LANES], &'a [f32; LANES]) {
        let rows = node.planes[axis].as_flattened();
        // The masks tell the compiler that the index is in range.
        let near = self.near[axis] & LANES;
        (row(rows, near), row(rows, near ^ LANES))
    }
}

impl<S: Simd> BoxTest<S> for Oblique<S> {
    #[inline(always)]
    fn scale_time(&self, t: f32) -> f32 {
        t
    }

    #[inline(always)]
    fn test(&self, simd: S, node: &WideNode, t_min: S::F32x8, t_max: f32) -> (u32, S::F32x8) {
        let (near_x, far_x) = self.planes(node, 0);
        let (near_y, far_y) = self.planes(node, 1);
        let (near_z, far_z) = self.planes(node, 2);
        let near_x = simd.mul_sub(simd.load(near_x), self.inverse[0], self.near_offset[0]);
        let near_y = simd.mul_sub(simd.load(near_y), self.inverse[1], self.near_offset[1]);
        let near_z = simd.mul_sub(simd.load(near_z), self.inverse[2], self.near_offset[2]);
        let far_x = simd.mul_sub(simd.load(far_x), self.inverse[0], self.far_offset[0]);
        let far_y = simd.mul_sub(simd.load(far_y), self.inverse[1], self.far_offset[1]);
        let far_z = simd.mul_sub(simd.load(far_z), self.inverse[2], self.far_offset[2]);
        // A NaN, from a product that overflowed, decides nothing: the other operand is kept.
        let enter = simd.max(near_x, simd.max(near_y, simd.max(near_z, t_min)));
        let leave = simd.min(far_x, simd.min(far_y, simd.min(far_z, simd.splat(t_max))));
        (simd.less_or_equal(enter, leave), enter)
    }
}

/// `(plane - origin) * inverse -+ slack`: for rays along a plane, where the other form would make `inf - inf` of every
/// plane, and for lengths that need scaling.
pub(super) struct Plain<S: Simd> {
    time_scale: f32,
    near_side: [usize; 3],
    origin: [S::F32x8; 3],
    inverse: [S::F32x8; 3],
    slack: [S::F32x8; 3],
    /// All lanes, for an axis of which the direction has nothing.
    stays: [u32; 3],
}

impl<S: Simd> Plain<S> {
    #[inline(always)]
    pub(super) fn new(simd: S, slabs: &SlabRay) -> Self {
        Self {
            time_scale: slabs.time_scale,
            near_side: slabs.near_side,
            origin: splat(simd, slabs.origin),
            inverse: splat(simd, slabs.inverse),
            slack: splat(simd, slabs.slack),
            stays: slabs.inverse.map(|inverse| if inverse.is_infinite() { u32::MAX } else { 0 }),
        }
    }

    #[inline(always)]
    fn distance(&self, simd: S, node: &WideNode, axis: usize, side: usize) -> S::F32x8 {
        simd.mul(simd.sub(simd.load(&node.planes[axis][side]), self.origin[axis]), self.inverse[axis])
    }
}

impl<S: Simd> BoxTest<S> for Plain<S> {
    #[inline(always)]
    fn scale_time(&self, t: f32) -> f32 {
        t * self.time_scale
    }

    #[inline(always)]
    fn test(&self, simd: S, node: &WideNode, t_min: S::F32x8, t_max: f32) -> (u32, S::F32x8) {
        let (mut enter, mut leave) = (t_min, simd.splat(t_max));
        let mut edge_on = 0;
        for axis in 0..3 {
            let side = self.near_side[axis] & 1;
            let near = simd.sub(self.distance(simd, node, axis, side), self.slack[axis]);
            let far = simd.add(self.distance(simd, node, axis, side ^ 1), self.slack[axis]);
            enter = simd.max(near, enter);
            leave = simd.min(far, leave);
            // Two times 0 * inf: a box without thickness, and the ray inside its plane. It sees what is there edge-on,
            // and hits none of it.
            edge_on |= self.stays[axis] & !(simd.less_or_equal(near, near) | simd.less_or_equal(far, far));
        }
        (simd.less_or_equal(enter, leave) & !edge_on, enter)
    }
}

#[inline(always)]
fn splat<S: Simd>(simd: S, [x, y, z]: [f32; 3]) -> [S::F32x8; 3] {
    [simd.splat(x), simd.splat(y), simd.splat(z)]
}

#[inline(always)]
fn splat4<S: Simd>(simd: S, v: Vec4) -> [S::F32x8; 3] {
    [simd.splat(v.x), simd.splat(v.y), simd.splat(v.z)]
}

#[inline(always)]
fn row(rows: &[f32], at: usize) -> &[f32; LANES] {
    rows[at..][..LANES].try_into().expect("the length is that of the array")
}
