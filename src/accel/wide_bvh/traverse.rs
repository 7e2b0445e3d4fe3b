//! Front to back with a stack: a node's eight boxes at once, then a leaf's triangles at once.

use std::marker::PhantomData;

use arrayvec::ArrayVec;

use super::WideBvh;
use super::box_test::{BoxTest, Oblique, Plain};
use super::leaf_test::{Best, LeafTest};
use super::leaves::LeafForm;
use super::node::Child;
use crate::accel::bvh::node::MOST_LEVELS;
use crate::accel::leaf::{ClosestHit, Query};
use crate::accel::tally::Tally;
use crate::geometry::{Interval, ObliqueSlabs, PrecisionMode, Ray, SlabRay, TriangleRay};
use crate::simd::{LANES, Simd, SimdKernel, prefetch};

/// A child that waits, and where the ray enters it.
#[derive(Clone, Copy)]
struct Pending {
    enter: f32,
    child: Child,
}

/// A wide level is a binary level at least, and leaves all children but one waiting.
const MOST_PENDING: usize = MOST_LEVELS * (LANES - 1);

/// Aligned, because a compiler that has something to align in a frame aligns the registers that it spills there too: else
/// half of them cross a cache line.
#[repr(align(32))]
struct Stack(ArrayVec<Pending, MOST_PENDING>);

pub(super) struct Traversal<'a, Q, P, F, I, T> {
    bvh: &'a WideBvh<F>,
    ray: I,
    then: T,
    choices: PhantomData<(Q, P)>,
}

impl<'a, Q, P, F, I, T> Traversal<'a, Q, P, F, I, T> {
    #[inline(always)]
    pub(super) fn new(bvh: &'a WideBvh<F>, ray: I, then: T) -> Self {
        Self { bvh, ray, then, choices: PhantomData }
    }
}

impl<Q, P, F, I, R, T> SimdKernel for Traversal<'_, Q, P, F, I, T>
where
    Q: Query,
    P: PrecisionMode,
    F: LeafForm,
    I: Into<Ray>,
    T: FnOnce(Option<ClosestHit>, Q::Tally) -> R,
{
    type Output = R;

    #[inline(always)]
    fn run<S: Simd>(self, simd: S) -> R {
        let Self { bvh, ray, then, choices } = self;
        let ray = ray.into();
        match ObliqueSlabs::new(&ray, &bvh.corners) {
            Some(slabs) => {
                let mut tally = Q::Tally::default();
                let found = traverse::<Q, P, F, S, _>(simd, bvh, &ray, Oblique::new(simd, &slabs), &mut tally);
                finish::<Q, F, R>(bvh, found, |found| then(found, tally))
            }
            // In a frame of its own, so that ordinary rays do not pay for its registers.
            None => simd.vectorize(AlongPlanes(Traversal { bvh, ray, then, choices })),
        }
    }
}

/// A ray that runs along a plane, or of unusual length, or not valid.
struct AlongPlanes<'a, Q, P, F, T>(Traversal<'a, Q, P, F, Ray, T>);

impl<Q: Query, P: PrecisionMode, F: LeafForm, R, T: FnOnce(Option<ClosestHit>, Q::Tally) -> R> SimdKernel
    for AlongPlanes<'_, Q, P, F, T>
{
    type Output = R;

    #[inline(always)]
    fn run<S: Simd>(self, simd: S) -> R {
        let Traversal { bvh, ray, then, .. } = self.0;
        if !ray.is_valid() {
            return then(None, Q::Tally::default());
        }
        let boxes = Plain::new(simd, &SlabRay::new(&ray, &bvh.bounds));
        let mut tally = Q::Tally::default();
        let found = traverse::<Q, P, F, S, _>(simd, bvh, &ray, boxes, &mut tally);
        finish::<Q, F, R>(bvh, found, |found| then(found, tally))
    }
}

#[inline(always)]
fn finish<Q: Query, F: LeafForm, R>(
    bvh: &WideBvh<F>,
    found: Option<ClosestHit>,
    then: impl FnOnce(Option<ClosestHit>) -> R,
) -> R {
    then(match found {
        Some(hit) if !Q::FIRST_HIT_ENDS => Some(bvh.leaves.resolve(hit)),
        other => other,
    })
}

#[inline(always)]
fn traverse<Q: Query, P: PrecisionMode, F: LeafForm, S: Simd, B: BoxTest<S>>(
    simd: S,
    bvh: &WideBvh<F>,
    ray: &Ray,
    boxes: B,
    tally: &mut Q::Tally,
) -> Option<ClosestHit> {
    let triangle_ray = TriangleRay::new(ray);
    let triangles = LeafTest::new(simd, bvh, &triangle_ray, Interval { t_min: ray.t_min, t_max: ray.t_max });
    let t_min = simd.splat(boxes.scale_time(ray.t_min));
    let mut t_max = boxes.scale_time(ray.t_max);
    let mut best = Best::none(ray);
    let mut aligned = Stack(ArrayVec::new_const());
    let stack = &mut aligned.0;
    let mut child = bvh.root;
    loop {
        if child.is_leaf() {
            tally.test_primitives(child.triangles().1);
            if triangles.test::<Q, P>(simd, child, &mut best) {
                return Some(ClosestHit::UNSPECIFIED);
            }
            t_max = boxes.scale_time(best.high);
        } else {
            tally.visit_node();
            let node = &bvh.nodes[child.node_index()];
            let (mut hits, enter) = boxes.test(simd, node, t_min, t_max);
            if hits != 0 {
                let first = next_slot(&mut hits);
                if hits == 0 {
                    child = node.children[first];
                    continue;
                }
                let enter = simd.store(enter);
                let pending = |slot: usize| Pending { enter: enter[slot], child: node.children[slot] };
                let (mut near, mut far) = (pending(first), pending(next_slot(&mut hits)));
                // Where any hit will do the largest box comes first, which is the last one.
                if Q::FIRST_HIT_ENDS || far.enter < near.enter {
                    (near, far) = (far, near);
                }
                let bottom = stack.len();
                wait(bvh, stack, far);
                if hits == 0 {
                    child = near.child;
                    continue;
                }
                wait(bvh, stack, near);
                while hits != 0 {
                    wait(bvh, stack, pending(next_slot(&mut hits)));
                    sort_last::<Q>(stack, bottom);
                }
                child = stack.pop().expect("three were pushed").child;
                continue;
            }
        }
        // A child that the ray enters exactly where the best hit is may hold an equal hit with a lower id.
        child = loop {
            let Some(pending) = stack.pop() else { return triangles.finish::<P>(&best) };
            if pending.enter <= t_max {
                break pending.child;
            }
        };
    }
}

/// Takes the lowest bit.
#[inline(always)]
fn next_slot(hits: &mut u32) -> usize {
    let slot = hits.trailing_zeros() as usize % LANES;
    *hits &= *hits - 1;
    slot
}

#[inline(always)]
fn wait(bvh: &WideBvh<impl LeafForm>, stack: &mut ArrayVec<Pending, MOST_PENDING>, pending: Pending) {
    if pending.child.is_leaf() {
        bvh.leaves.prefetch(pending.child.triangles());
    } else {
        prefetch(&bvh.nodes[pending.child.node_index()]);
    }
    stack.push(pending);
}

/// Puts the last child among those from `bottom` on, the one that the ray enters first on top; without order where any
/// hit will do.
#[inline(always)]
fn sort_last<Q: Query>(stack: &mut ArrayVec<Pending, MOST_PENDING>, bottom: usize) {
    if Q::FIRST_HIT_ENDS {
        return;
    }
    let mut at = stack.len() - 1;
    let pending = stack[at];
    while at > bottom && stack[at - 1].enter < pending.enter {
        stack[at] = stack[at - 1];
        at -= 1;
    }
    stack[at] = pending;
}
