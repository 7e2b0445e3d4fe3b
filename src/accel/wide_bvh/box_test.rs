//! A node's eight boxes against a ray.

use std::hint::black_box;

use glam::Vec4;

use super::node::WideNode;
use crate::geometry::{BEHIND, ObliqueSlabs, SlabRay};
use crate::simd::{LANES, Simd};

/// A ray as box tests want it, to be kept in memory.
pub(super) trait Boxes {
    type Prepared<S: Simd>: BoxTest<S>;

    /// Box distances count in lengths of the scaled direction: multiply a `t` by this.
    fn scale_time(&self, t: f32) -> f32;
    /// Has the order of the distances that there can be.
    fn order(distance: f32) -> u32;
    /// In registers.
    fn prepare<S: Simd>(&self, simd: S) -> Self::Prepared<S>;
}

/// Eight boxes against a ray: the slots that it meets by `t_max`, a scaled length, and where it enters each.
pub(super) trait BoxTest<S: Simd> {
    fn test(&self, simd: S, node: &WideNode, t_max: f32) -> (u32, S::F32x8);
}

/// `plane * inverse + offset`: one operation a plane.
pub(super) struct Oblique(ObliqueSlabs);

pub(super) struct PreparedOblique<S: Simd> {
    /// For each axis where the near planes begin among both rows: 0 or 8.
    near: [usize; 3],
    inverse: [S::F32x8; 3],
    near_offset: [S::F32x8; 3],
    far_offset: [S::F32x8; 3],
    t_min: S::F32x8,
    doubtful_until: S::F32x8,
    origin: Vec4,
}

impl Oblique {
    #[inline(always)]
    pub(super) fn new(slabs: ObliqueSlabs) -> Self {
        Self(slabs)
    }
}

impl Boxes for Oblique {
    type Prepared<S: Simd> = PreparedOblique<S>;

    #[inline(always)]
    fn scale_time(&self, t: f32) -> f32 {
        t
    }

    /// No box is entered before `t_min`, which is not negative, and such floats have the order of their bits.
    #[inline(always)]
    fn order(distance: f32) -> u32 {
        distance.to_bits()
    }

    #[inline(always)]
    fn prepare<S: Simd>(&self, simd: S) -> PreparedOblique<S> {
        let slabs = &self.0;
        let negative = slabs.negative as usize;
        PreparedOblique {
            near: [negative << 3 & LANES, negative << 2 & LANES, negative << 1 & LANES],
            inverse: splat4(simd, &slabs.inverse),
            near_offset: splat4(simd, &slabs.near_offset),
            far_offset: splat4(simd, &slabs.far_offset),
            t_min: simd.splat(slabs.t_min),
            doubtful_until: simd.splat(slabs.doubtful_until),
            origin: slabs.origin,
        }
    }
}

impl<S: Simd> PreparedOblique<S> {
    /// The slots whose boxes do not end behind the origin: see [`BEHIND`].
    #[inline(always)]
    fn ahead(&self, simd: S, node: &WideNode) -> u32 {
        let end = |axis: usize| {
            let far = simd.sub(simd.load(self.planes(node, axis).1), simd.splat(self.origin[axis]));
            simd.mul(far, self.inverse[axis])
        };
        simd.less_or_equal(simd.splat(BEHIND), simd.min(end(0), simd.min(end(1), end(2))))
    }

    #[inline(always)]
    fn planes<'a>(&self, node: &'a WideNode, axis: usize) -> (&'a [f32; LANES], &'a [f32; LANES]) {
        let rows = node.planes[axis].as_flattened();
        // The masks tell the compiler that the index is in range.
        let near = self.near[axis] & LANES;
        (row(rows, near), row(rows, near ^ LANES))
    }
}

impl<S: Simd> BoxTest<S> for PreparedOblique<S> {
    #[inline(always)]
    fn test(&self, simd: S, node: &WideNode, t_max: f32) -> (u32, S::F32x8) {
        let (near_x, far_x) = self.planes(node, 0);
        let (near_y, far_y) = self.planes(node, 1);
        let (near_z, far_z) = self.planes(node, 2);
        let near_x = simd.mul_add(simd.load(near_x), self.inverse[0], self.near_offset[0]);
        let near_y = simd.mul_add(simd.load(near_y), self.inverse[1], self.near_offset[1]);
        let near_z = simd.mul_add(simd.load(near_z), self.inverse[2], self.near_offset[2]);
        let far_x = simd.mul_add(simd.load(far_x), self.inverse[0], self.far_offset[0]);
        let far_y = simd.mul_add(simd.load(far_y), self.inverse[1], self.far_offset[1]);
        let far_z = simd.mul_add(simd.load(far_z), self.inverse[2], self.far_offset[2]);
        // In pairs, which wait less for each other.
        let enter = simd.max(simd.max(near_x, near_y), simd.max(near_z, self.t_min));
        let leave = simd.min(simd.min(far_x, far_y), simd.min(far_z, simd.splat(t_max)));
        let mut hits = simd.less_or_equal(enter, leave);
        // Rarely, but for rays that leave a surface.
        if hits & simd.less_or_equal(leave, self.doubtful_until) != 0 {
            // The planes are read again: to keep them would take registers that are not there.
            black_box(());
            hits &= self.ahead(simd, node);
        }
        (hits, enter)
    }
}

/// `(plane - origin) * inverse -+ slack`: for rays along a plane, where the other form would make `inf - inf` of every
/// plane, for lengths that need scaling, and for a negative `t_min`.
pub(super) struct Plain {
    slabs: SlabRay,
    t_min: f32,
}

pub(super) struct PreparedPlain<S: Simd> {
    near_side: [usize; 3],
    origin: [S::F32x8; 3],
    inverse: [S::F32x8; 3],
    slack: [S::F32x8; 3],
    t_min: S::F32x8,
    /// All lanes, for an axis of which the direction has nothing.
    stays: [u32; 3],
}

impl Plain {
    pub(super) fn new(slabs: SlabRay, t_min: f32) -> Self {
        Self { slabs, t_min }
    }
}

impl Boxes for Plain {
    type Prepared<S: Simd> = PreparedPlain<S>;

    #[inline(always)]
    fn scale_time(&self, t: f32) -> f32 {
        t * self.slabs.time_scale
    }

    /// The bits of negative floats have the opposite order, and come after all others. Of two zeros the positive one is
    /// taken, for they are equal.
    #[inline(always)]
    fn order(distance: f32) -> u32 {
        let distance = distance + 0.0;
        let bits = distance.to_bits();
        if distance.is_sign_negative() { !bits } else { bits | 1 << 31 }
    }

    #[inline(always)]
    fn prepare<S: Simd>(&self, simd: S) -> PreparedPlain<S> {
        let slabs = &self.slabs;
        PreparedPlain {
            near_side: slabs.near_side,
            origin: splat(simd, slabs.origin),
            inverse: splat(simd, slabs.inverse),
            slack: splat(simd, slabs.slack),
            t_min: simd.splat(self.scale_time(self.t_min)),
            stays: slabs.inverse.map(|inverse| if inverse.is_infinite() { u32::MAX } else { 0 }),
        }
    }
}

impl<S: Simd> PreparedPlain<S> {
    #[inline(always)]
    fn distance(&self, simd: S, node: &WideNode, axis: usize, side: usize) -> S::F32x8 {
        simd.mul(simd.sub(simd.load(&node.planes[axis][side]), self.origin[axis]), self.inverse[axis])
    }
}

impl<S: Simd> BoxTest<S> for PreparedPlain<S> {
    #[inline(always)]
    fn test(&self, simd: S, node: &WideNode, t_max: f32) -> (u32, S::F32x8) {
        let (mut enter, mut leave) = (self.t_min, simd.splat(t_max));
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

/// The half-line from a point along +x, exactly: a box that it touches is met. Distances are not told.
pub(super) struct AlongX([f32; 3]);

pub(super) struct PreparedAlongX<S: Simd>([S::F32x8; 3]);

impl AlongX {
    pub(super) fn new(point: [f32; 3]) -> Self {
        Self(point)
    }
}

impl Boxes for AlongX {
    type Prepared<S: Simd> = PreparedAlongX<S>;

    #[inline(always)]
    fn scale_time(&self, t: f32) -> f32 {
        t
    }

    #[inline(always)]
    fn order(_distance: f32) -> u32 {
        0
    }

    #[inline(always)]
    fn prepare<S: Simd>(&self, simd: S) -> PreparedAlongX<S> {
        PreparedAlongX(splat(simd, self.0))
    }
}

impl<S: Simd> BoxTest<S> for PreparedAlongX<S> {
    #[inline(always)]
    fn test(&self, simd: S, node: &WideNode, _t_max: f32) -> (u32, S::F32x8) {
        let Self([x, y, z]) = *self;
        let is_below = |axis: usize, at: S::F32x8| simd.less_or_equal(simd.load(&node.planes[axis][0]), at);
        let is_above = |axis: usize, at: S::F32x8| simd.less_or_equal(at, simd.load(&node.planes[axis][1]));
        (is_above(0, x) & is_below(1, y) & is_above(1, y) & is_below(2, z) & is_above(2, z), simd.splat(0.0))
    }
}

#[inline(always)]
fn splat<S: Simd>(simd: S, [x, y, z]: [f32; 3]) -> [S::F32x8; 3] {
    [simd.splat(x), simd.splat(y), simd.splat(z)]
}

#[inline(always)]
fn splat4<S: Simd>(simd: S, v: &Vec4) -> [S::F32x8; 3] {
    [simd.splat(v.x), simd.splat(v.y), simd.splat(v.z)]
}

#[inline(always)]
fn row(rows: &[f32], at: usize) -> &[f32; LANES] {
    rows[at..][..LANES].try_into().expect("the length is that of the array")
}
