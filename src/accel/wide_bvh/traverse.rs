//! Front to back with a stack: a node's eight boxes at once, then a leaf's triangles at once.

use std::marker::PhantomData;

use arrayvec::ArrayVec;

use super::WideBvh;
use super::leaves::Leaf;
use super::node::{Child, WideNode};
use crate::accel::bvh::node::MOST_LEVELS;
use crate::accel::leaf::{ClosestHit, Query};
use crate::geometry::{Interval, PrecisionMode, Ray, SlabRay, TriangleRay};
use crate::simd::{LANES, Simd, SimdKernel, prefetch};

/// A child that waits, and where the ray enters it.
#[derive(Clone, Copy)]
struct Pending {
    enter: f32,
    child: Child,
}

/// A wide level is a binary level at least, and leaves all children but one waiting.
const MOST_PENDING: usize = MOST_LEVELS * (LANES - 1);

type Stack = ArrayVec<Pending, MOST_PENDING>;

pub(super) struct Traversal<'a, Q, P, I, T> {
    bvh: &'a WideBvh,
    ray: I,
    then: T,
    choices: PhantomData<(Q, P)>,
}

impl<'a, Q, P, I, T> Traversal<'a, Q, P, I, T> {
    #[inline(always)]
    pub(super) fn new(bvh: &'a WideBvh, ray: I, then: T) -> Self {
        Self { bvh, ray, then, choices: PhantomData }
    }
}

impl<Q, P, I, R, T> SimdKernel for Traversal<'_, Q, P, I, T>
where
    Q: Query,
    P: PrecisionMode,
    I: Into<Ray>,
    T: FnOnce(Option<ClosestHit>) -> R,
{
    type Output = R;

    #[inline(always)]
    fn run<S: Simd>(self, simd: S) -> R {
        let Some(ray) = Ray::valid(self.ray) else { return (self.then)(None) };
        let slabs = SlabRay::new(&ray, &self.bvh.bounds);
        let found = if S::IS_FUSED && slabs.is_oblique() {
            traverse::<Q, P, S, Fused<S>>(simd, self.bvh, &ray, &slabs)
        } else {
            traverse::<Q, P, S, Plain<S>>(simd, self.bvh, &ray, &slabs)
        };
        (self.then)(found.map(|hit| self.bvh.leaves.resolve(hit)))
    }
}

#[inline(always)]
fn traverse<Q: Query, P: PrecisionMode, S: Simd, B: BoxTest<S>>(
    simd: S,
    bvh: &WideBvh,
    ray: &Ray,
    slabs: &SlabRay,
) -> Option<ClosestHit> {
    let boxes = B::new(simd, slabs);
    let triangle_ray = TriangleRay::new(ray);
    let triangles = LeafTest::new(simd, &triangle_ray);
    let t_min = simd.splat(ray.t_min * slabs.time_scale);
    let mut t_max = ray.t_max * slabs.time_scale;
    let mut best = ClosestHit::none(ray);
    let mut stack = Stack::new_const();
    let mut child = bvh.root;
    loop {
        if child.is_leaf() {
            let leaf = bvh.leaves.leaf(child.triangles());
            if triangles.test::<Q, P>(simd, &leaf, ray.t_min, &mut best) {
                break;
            }
            t_max = best.t * slabs.time_scale;
        } else {
            let node = &bvh.nodes[child.node_index()];
            let (mut hits, enter) = boxes.test(simd, node, t_min, t_max);
            if hits != 0 {
                if hits & (hits - 1) == 0 {
                    child = node.children[hits.trailing_zeros() as usize % LANES];
                    continue;
                }
                let enter = simd.store(enter);
                let bottom = stack.len();
                while hits != 0 {
                    let slot = hits.trailing_zeros() as usize % LANES;
                    hits &= hits - 1;
                    let waiting = node.children[slot];
                    if !waiting.is_leaf() {
                        prefetch(&bvh.nodes[waiting.node_index()]);
                    }
                    push::<Q>(&mut stack, bottom, Pending { enter: enter[slot], child: waiting });
                }
                child = stack.pop().expect("two were pushed").child;
                continue;
            }
        }
        // A child that the ray enters exactly where the best hit is may hold an equal hit with a lower id.
        child = loop {
            let Some(pending) = stack.pop() else { return best.found() };
            if pending.enter <= t_max {
                break pending.child;
            }
        };
    }
    best.found()
}

/// Puts a child above those from `bottom` on that the ray enters later; without order where any hit will do.
#[inline(always)]
fn push<Q: Query>(stack: &mut Stack, bottom: usize, pending: Pending) {
    let mut at = stack.len();
    stack.push(pending);
    if Q::FIRST_HIT_ENDS {
        return;
    }
    while at > bottom && stack[at - 1].enter < pending.enter {
        stack[at] = stack[at - 1];
        at -= 1;
    }
    stack[at] = pending;
}

/// Eight boxes against a ray: the slots that it meets, and where it enters each.
trait BoxTest<S: Simd> {
    fn new(simd: S, slabs: &SlabRay) -> Self;
    fn test(&self, simd: S, node: &WideNode, t_min: S::F32x8, t_max: f32) -> (u32, S::F32x8);
}

/// `plane * inverse - offset`: one operation a plane.
struct Fused<S: Simd> {
    near_side: [usize; 3],
    inverse: [S::F32x8; 3],
    near_offset: [S::F32x8; 3],
    far_offset: [S::F32x8; 3],
}

impl<S: Simd> BoxTest<S> for Fused<S> {
    #[inline(always)]
    fn new(simd: S, slabs: &SlabRay) -> Self {
        let [(near_x, far_x), (near_y, far_y), (near_z, far_z)] = slabs.fused_offsets();
        Self {
            near_side: slabs.near_side,
            inverse: splat(simd, slabs.inverse),
            near_offset: splat(simd, [near_x, near_y, near_z]),
            far_offset: splat(simd, [far_x, far_y, far_z]),
        }
    }

    #[inline(always)]
    fn test(&self, simd: S, node: &WideNode, t_min: S::F32x8, t_max: f32) -> (u32, S::F32x8) {
        let (mut enter, mut leave) = (t_min, simd.splat(t_max));
        for axis in 0..3 {
            let side = self.near_side[axis] & 1;
            let (near, far) = (simd.load(&node.planes[axis][side]), simd.load(&node.planes[axis][side ^ 1]));
            enter = simd.max(simd.mul_sub(near, self.inverse[axis], self.near_offset[axis]), enter);
            leave = simd.min(simd.mul_sub(far, self.inverse[axis], self.far_offset[axis]), leave);
        }
        (simd.less_or_equal(enter, leave), enter)
    }
}

/// `(plane - origin) * inverse -+ slack`: for instruction sets that do not fuse, and for rays along a plane, where the
/// other form would make `inf - inf` of every plane.
struct Plain<S: Simd> {
    near_side: [usize; 3],
    origin: [S::F32x8; 3],
    inverse: [S::F32x8; 3],
    slack: [S::F32x8; 3],
}

impl<S: Simd> Plain<S> {
    #[inline(always)]
    fn distance(&self, simd: S, node: &WideNode, axis: usize, side: usize) -> S::F32x8 {
        simd.mul(simd.sub(simd.load(&node.planes[axis][side]), self.origin[axis]), self.inverse[axis])
    }
}

impl<S: Simd> BoxTest<S> for Plain<S> {
    #[inline(always)]
    fn new(simd: S, slabs: &SlabRay) -> Self {
        Self {
            near_side: slabs.near_side,
            origin: splat(simd, slabs.origin),
            inverse: splat(simd, slabs.inverse),
            slack: splat(simd, slabs.slack),
        }
    }

    #[inline(always)]
    fn test(&self, simd: S, node: &WideNode, t_min: S::F32x8, t_max: f32) -> (u32, S::F32x8) {
        let (mut enter, mut leave) = (t_min, simd.splat(t_max));
        for axis in 0..3 {
            let side = self.near_side[axis] & 1;
            let near = simd.sub(self.distance(simd, node, axis, side), self.slack[axis]);
            let far = simd.add(self.distance(simd, node, axis, side ^ 1), self.slack[axis]);
            enter = simd.max(near, enter);
            leave = simd.min(far, leave);
        }
        (simd.less_or_equal(enter, leave), enter)
    }
}

/// Eight triangles against a ray: the scalar test decides about those that are not refused here, and refuses all that
/// are.
struct LeafTest<'a, S: Simd> {
    ray: &'a TriangleRay,
    origin: [S::F32x8; 3],
    shear_x: S::F32x8,
    shear_y: S::F32x8,
}

/// A coordinate of the three vertices of eight triangles.
type Corners<S> = [<S as Simd>::F32x8; 3];

impl<'a, S: Simd> LeafTest<'a, S> {
    #[inline(always)]
    fn new(simd: S, ray: &'a TriangleRay) -> Self {
        let [kx, ky, kz] = ray.axes;
        let origin = splat(simd, [ray.origin[kx], ray.origin[ky], ray.origin[kz]]);
        Self { ray, origin, shear_x: simd.splat(ray.shear[0]), shear_y: simd.splat(ray.shear[1]) }
    }

    /// Keeps the best hit. True ends the query.
    #[inline(always)]
    fn test<Q: Query, P: PrecisionMode>(&self, simd: S, leaf: &Leaf<'_>, t_min: f32, best: &mut ClosestHit) -> bool {
        let mut left = self.possible_hits(simd, leaf);
        let mut ends = false;
        while left != 0 {
            let triangle = leaf.triangle(left.trailing_zeros() as usize % LANES);
            left &= left - 1;
            if let Some(hit) = self.ray.hit::<P>(&triangle, Interval { t_min, t_max: best.t }) {
                ends |= best.improve(&hit, &triangle) && Q::FIRST_HIT_ENDS;
            }
        }
        ends
    }

    #[inline(always)]
    fn possible_hits(&self, simd: S, leaf: &Leaf<'_>) -> u32 {
        let [kx, ky, kz] = self.ray.axes;
        let z = from_origin(simd, leaf, kz, self.origin[2]);
        let x = shear(simd, from_origin(simd, leaf, kx, self.origin[0]), self.shear_x, z);
        let y = shear(simd, from_origin(simd, leaf, ky, self.origin[1]), self.shear_y, z);
        let a = edge(simd, x[2], y[1], y[2], x[1]);
        let b = edge(simd, x[0], y[2], y[0], x[2]);
        let c = edge(simd, x[1], y[0], y[1], x[0]);
        let zero = simd.splat(0.0);
        // A NaN may lose a sign here, which refuses less.
        let any_negative = simd.less(simd.min(a, simd.min(b, c)), zero);
        let any_positive = simd.less(zero, simd.max(a, simd.max(b, c)));
        leaf.mask() & !(any_negative & any_positive)
    }
}

#[inline(always)]
fn splat<S: Simd>(simd: S, [x, y, z]: [f32; 3]) -> [S::F32x8; 3] {
    [simd.splat(x), simd.splat(y), simd.splat(z)]
}

#[inline(always)]
fn from_origin<S: Simd>(simd: S, leaf: &Leaf<'_>, axis: usize, origin: S::F32x8) -> Corners<S> {
    [
        simd.sub(simd.load(leaf.row(axis, 0)), origin),
        simd.sub(simd.load(leaf.row(axis, 1)), origin),
        simd.sub(simd.load(leaf.row(axis, 2)), origin),
    ]
}

#[inline(always)]
fn shear<S: Simd>(simd: S, row: Corners<S>, slope: S::F32x8, z: Corners<S>) -> Corners<S> {
    [
        simd.sub(row[0], simd.mul(slope, z[0])),
        simd.sub(row[1], simd.mul(slope, z[1])),
        simd.sub(row[2], simd.mul(slope, z[2])),
    ]
}

/// `a * b - c * d`.
#[inline(always)]
fn edge<S: Simd>(simd: S, a: S::F32x8, b: S::F32x8, c: S::F32x8, d: S::F32x8) -> S::F32x8 {
    simd.sub(simd.mul(a, b), simd.mul(c, d))
}
