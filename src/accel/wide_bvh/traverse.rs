//! Front to back with a stack: a node's eight boxes at once, then a leaf's triangles at once.

use std::hint::black_box;
use std::marker::PhantomData;

use arrayvec::ArrayVec;

use super::WideBvh;
use super::box_test::{BoxTest, Boxes, Oblique, Plain};
use super::leaf_test::{Best, LeafTest};
use super::leaves::LeafForm;
use super::node::{Child, WideNode};
use crate::accel::Primitive;
use crate::accel::bvh::node::MOST_LEVELS;
use crate::accel::leaf::{ClosestHit, Query};
use crate::accel::tally::Tally;
use crate::geometry::{ObliqueSlabs, PrecisionMode, Ray, SlabRay};
use crate::simd::{LANES, Simd, SimdKernel};

/// A child that waits, below where the ray enters it: these numbers have the order along the ray.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Pending(u64);

impl Pending {
    #[inline(always)]
    fn new(order: u32, child: Child) -> Self {
        Self(u64::from(order) << 32 | u64::from(child.bits()))
    }

    /// None that the ray enters there or before has a greater number.
    #[inline(always)]
    fn last(order: u32) -> Self {
        Self(u64::from(order) << 32 | u64::from(u32::MAX))
    }

    #[inline(always)]
    fn child(self) -> Child {
        Child::from_bits(self.0 as u32)
    }
}

/// A wide level is a binary level at least, and leaves all children but one waiting.
const MOST_PENDING: usize = MOST_LEVELS * (LANES - 1);

pub(super) type Stack = ArrayVec<Pending, MOST_PENDING>;

/// Aligned, because a compiler that has something to align in a frame aligns the vectors that it keeps there too: else half
/// of them cross a cache line.
#[repr(align(32))]
pub(super) struct Aligned<T>(pub(super) T);

/// The hit of a ray, and what finding it took.
pub(super) type Found<Q, F> =
    (Option<ClosestHit<<<F as LeafForm>::Primitive as Primitive>::Surface>>, <Q as Query>::Tally);

impl<F: LeafForm> WideBvh<F> {
    /// One kernel for all who need not have the ray made and its hit used inside.
    pub(super) fn find<Q: Query, P: PrecisionMode, S: Simd>(&self, simd: S, ray: Ray) -> Found<Q, F> {
        simd.vectorize(Traversal::<Q, P, _, _, _>::new(self, ray, |found, tally| (found, tally)))
    }
}

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
    T: FnOnce(Option<ClosestHit<<F::Primitive as Primitive>::Surface>>, Q::Tally) -> R,
{
    type Output = R;

    #[inline(always)]
    fn run<S: Simd>(self, simd: S) -> R {
        let Self { bvh, ray, then, .. } = self;
        let ray = ray.into();
        match ObliqueSlabs::new(&ray, &bvh.corners) {
            Some(slabs) => {
                let boxes = Oblique::new(slabs);
                let best = Best::none(&ray);
                // What is to be made ready for leaves, a ray that misses all need not pay for.
                let mut tally = Q::Tally::default();
                tally.visit_node();
                let Some(start) = Start::at_root(simd, bvh, &boxes, best.t_max()) else { return then(None, tally) };
                let mut stack = Aligned(Stack::new_const());
                let leaves = F::Test::new::<P>(bvh, &ray);
                // See `Walk::run`.
                black_box(&leaves);
                let mut walk = Walk::<Q, F, Best>::new(bvh, &leaves, &mut stack.0, best);
                walk.tally = tally;
                let found = walk.find::<P, S, _>(simd, &boxes, start);
                then(found.map(|hit| hit.on_surface(&ray)), walk.tally)
            }
            // In a frame of its own, so that ordinary rays do not pay for its registers.
            None => {
                let (found, tally) = simd.vectorize(AlongPlanes::<Q, P, F> { bvh, ray, choices: PhantomData });
                then(found, tally)
            }
        }
    }
}

/// A ray that runs along a plane, or of unusual length, or from behind its origin, or not valid.
struct AlongPlanes<'a, Q, P, F> {
    bvh: &'a WideBvh<F>,
    ray: Ray,
    choices: PhantomData<(Q, P)>,
}

impl<Q: Query, P: PrecisionMode, F: LeafForm> SimdKernel for AlongPlanes<'_, Q, P, F> {
    type Output = Found<Q, F>;

    #[inline(always)]
    fn run<S: Simd>(self, simd: S) -> Found<Q, F> {
        let Self { bvh, ray, .. } = self;
        if !ray.is_valid() {
            return (None, Q::Tally::default());
        }
        let mut leaves = F::Test::new::<P>(bvh, &ray);
        leaves.check_range();
        let mut stack = Aligned(Stack::new_const());
        let boxes = Plain::new(SlabRay::new(&ray, &bvh.bounds), ray.t_min);
        let mut walk = Walk::<Q, F, Best>::new(bvh, &leaves, &mut stack.0, Best::none(&ray));
        let found = walk.start(simd, &boxes).and_then(|start| walk.find::<P, S, _>(simd, &boxes, start));
        (found.map(|hit| hit.on_surface(&ray)), walk.tally)
    }
}

/// What a walk keeps of what leaves hold.
pub(super) trait Keep<F: LeafForm> {
    /// Beyond this the walk need not look.
    fn t_max(&self) -> f32;

    /// See [`LeafTest::test`].
    fn test_leaf<Q: Query, P: PrecisionMode, S: Simd>(
        &mut self,
        leaves: &F::Test<'_>,
        simd: S,
        child: Child,
        t_max: f32,
    ) -> bool;
}

impl<F: LeafForm> Keep<F> for Best {
    #[inline(always)]
    fn t_max(&self) -> f32 {
        Best::t_max(self)
    }

    #[inline(always)]
    fn test_leaf<Q: Query, P: PrecisionMode, S: Simd>(
        &mut self,
        leaves: &F::Test<'_>,
        simd: S,
        child: Child,
        t_max: f32,
    ) -> bool {
        leaves.test::<Q, P, S>(simd, child, t_max, self)
    }
}

/// A ray on its way through the tree.
///
/// Points to what calls out of the kernel need, so that the walk itself can be kept in registers.
pub(super) struct Walk<'w, 'a, Q: Query, F: LeafForm, K> {
    bvh: &'a WideBvh<F>,
    leaves: &'w F::Test<'a>,
    stack: &'w mut Stack,
    kept: K,
    tally: Q::Tally,
}

/// Where a walk begins: the children of the root that the ray meets.
pub(super) struct Start<S: Simd> {
    hits: u32,
    enter: S::F32x8,
}

impl<S: Simd> Start<S> {
    /// `None` where the ray meets none of them.
    #[inline(always)]
    pub(super) fn at_root(simd: S, bvh: &WideBvh<impl LeafForm>, boxes: &impl Boxes, t_max: f32) -> Option<Self> {
        let root = &bvh.nodes.as_slice()[Child::ROOT.node_index()];
        let (hits, enter) = boxes.prepare(simd).test(simd, root, boxes.scale_time(t_max));
        (hits != 0).then_some(Self { hits, enter })
    }
}

impl<Q: Query, F: LeafForm> Walk<'_, '_, Q, F, Best> {
    #[inline(always)]
    fn find<P: PrecisionMode, S: Simd, B: Boxes>(
        &mut self,
        simd: S,
        boxes: &B,
        start: Start<S>,
    ) -> Option<ClosestHit<F::Primitive>> {
        if self.run::<P, S, B>(simd, boxes, start) {
            Some(ClosestHit::UNSPECIFIED)
        } else if Q::FIRST_HIT_ENDS {
            None
        } else {
            self.kept.found(self.bvh)
        }
    }
}

impl<'w, 'a, Q: Query, F: LeafForm, K: Keep<F>> Walk<'w, 'a, Q, F, K> {
    #[inline(always)]
    pub(super) fn new(bvh: &'a WideBvh<F>, leaves: &'w F::Test<'a>, stack: &'w mut Stack, kept: K) -> Self {
        Self { bvh, leaves, stack, kept, tally: Q::Tally::default() }
    }

    /// `None` where the ray meets nothing.
    #[inline(always)]
    fn start<S: Simd>(&mut self, simd: S, boxes: &impl Boxes) -> Option<Start<S>> {
        self.tally.visit_node();
        Start::at_root(simd, self.bvh, boxes, self.kept.t_max())
    }

    /// See [`Walk::run`].
    #[inline(always)]
    pub(super) fn run_from_root<P: PrecisionMode, S: Simd, B: Boxes>(&mut self, simd: S, boxes: &B) -> bool {
        self.start(simd, boxes).is_some_and(|start| self.run::<P, S, B>(simd, boxes, start))
    }

    /// Whether what is kept ended it.
    #[inline(always)]
    fn run<P: PrecisionMode, S: Simd, B: Boxes>(&mut self, simd: S, boxes: &B, start: Start<S>) -> bool {
        let bvh = self.bvh;
        let nodes = bvh.nodes.as_slice();
        let box_test = boxes.prepare(simd);
        let mut t_max = self.kept.t_max();
        let mut scaled_t_max = boxes.scale_time(t_max);
        let root = &nodes[Child::ROOT.node_index()];
        let mut child = self.descend::<S, B>(simd, root, start.hits, start.enter);
        loop {
            loop {
                if child.is_leaf() {
                    self.tally.test_primitives(child.triangles().1);
                    // The compiler would compute of it what all leaves need before it knows of any, and, without registers for that, store
                    // it and load it again.
                    black_box(());
                    if self.kept.test_leaf::<Q, P, S>(self.leaves, simd, child, t_max) {
                        return true;
                    }
                    break;
                }
                self.tally.visit_node();
                let node = &nodes[child.node_index()];
                let (hits, enter) = box_test.test(simd, node, scaled_t_max);
                if hits == 0 {
                    break;
                }
                child = self.descend::<S, B>(simd, node, hits, enter);
            }
            t_max = self.kept.t_max();
            scaled_t_max = boxes.scale_time(t_max);
            let last = Pending::last(B::order(scaled_t_max));
            // A child that the ray enters exactly where the best hit is may hold an equal hit with a lower id.
            child = loop {
                let Some(pending) = self.stack.pop() else { return false };
                if Q::FIRST_HIT_ENDS || pending <= last {
                    break pending.child();
                }
            };
        }
    }

    /// The child that the walk goes on with; the others that are hit wait.
    #[inline(always)]
    fn descend<S: Simd, B: Boxes>(&mut self, simd: S, node: &WideNode, mut hits: u32, enter: S::F32x8) -> Child {
        let first = next_slot(&mut hits);
        if hits == 0 {
            node.children[first]
        } else if Q::FIRST_HIT_ENDS {
            wait_in_any_order(self.bvh, node, first, hits, self.stack)
        } else {
            wait_in_order::<F, B>(self.bvh, node, first, hits, &Aligned(simd.store(enter)).0, self.stack)
        }
    }
}

/// Takes the lowest bit.
#[inline(always)]
fn next_slot(hits: &mut u32) -> usize {
    let slot = hits.trailing_zeros() as usize % LANES;
    *hits &= *hits - 1;
    slot
}

/// The largest box first, which is the last one; the others wait.
#[inline(always)]
fn wait_in_any_order(
    bvh: &WideBvh<impl LeafForm>,
    node: &WideNode,
    first: usize,
    mut hits: u32,
    stack: &mut Stack,
) -> Child {
    let mut child = node.children[first];
    while hits != 0 {
        bvh.prefetch(child);
        stack.push(Pending::new(0, child));
        child = node.children[next_slot(&mut hits)];
    }
    child
}

/// The child that the ray enters first; the others wait, in their order.
#[inline(always)]
fn wait_in_order<F: LeafForm, B: Boxes>(
    bvh: &WideBvh<F>,
    node: &WideNode,
    first: usize,
    mut hits: u32,
    enter: &[f32; LANES],
    stack: &mut Stack,
) -> Child {
    let pending = |slot: usize| Pending::new(B::order(enter[slot]), node.children[slot]);
    let (mut near, mut far) = (first, next_slot(&mut hits));
    if enter[far] < enter[near] {
        // Keeps this a branch: the next node's address then need not wait for the distances.
        black_box(());
        (near, far) = (far, near);
    }
    let (near, far) = (pending(near), pending(far));
    let bottom = stack.len();
    bvh.prefetch(far.child());
    stack.push(far);
    if hits == 0 {
        return near.child();
    }
    bvh.prefetch(near.child());
    stack.push(near);
    while hits != 0 {
        let pending = pending(next_slot(&mut hits));
        bvh.prefetch(pending.child());
        stack.push(pending);
        sort_last(stack, bottom);
    }
    stack.pop().expect("three were pushed").child()
}

/// Puts the last child among those from `bottom` on, the one that the ray enters first on top.
#[inline(always)]
fn sort_last(stack: &mut Stack, bottom: usize) {
    let mut at = stack.len() - 1;
    let pending = stack[at];
    while at > bottom && stack[at - 1] < pending {
        stack[at] = stack[at - 1];
        at -= 1;
    }
    stack[at] = pending;
}
