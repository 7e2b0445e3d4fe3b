//! Many rays in flight, a step at a time each: while one ray's node comes from memory the others are tested.
//!
//! A ray in flight is on one list: its next child is a node, or a leaf; its leaf left candidates; or its next child
//! waits on its stack. A pass works through one list, and what a ray does in it does not depend on what it finds:
//! without branches to mispredict, the CPU overlaps neighbours on the list.
//!
//! Source for the lists: Wald, Benthin, Boulos 2008 (see [`super`]) for streams; Fuetterer, Lojewski, Pfreundt, Ebert
//! 2015, "Efficient ray tracing kernels for modern CPU architectures", for the order of hits as keys.

use glam::Vec3A;

use super::WideBvh;
use super::batch::Source;
use super::leaves::{Leaf, LeafRows, LeafTriangles};
use super::node::{Child, WideNode};
use super::spans::{Corners, Signs, Spans, shear, spans, weights};
use crate::accel::leaf::{ClosestHit, Query};
use crate::geometry::{HITS, HitLanes, Interval, PrecisionMode, Ray, TriangleRay, edge_slack, settled};
use crate::math::gamma;
use crate::simd::{Eight, LANES, Simd};

/// How many rays are in flight. With 16 or 64 a batch of random rays among 871 thousand triangles takes as long or up
/// to 5 % longer.
pub(super) const IN_FLIGHT: usize = 32;

/// Coordinates below this: products of three differences do not overflow `f32`.
pub(super) const MOST_REACH: f32 = (1u64 << 39) as f32;
/// Components above this: their inverses are below [`MOST_REACH`].
pub(super) const LEAST_DIRECTION: f32 = 1.0 / MOST_REACH;

/// The lists.
const NODE: usize = 0;
const LEAF: usize = 1;
const POP: usize = 2;
/// Those whose hit is known, but not evaluated.
const EVALUATE: usize = 3;
const LISTS: usize = 4;

/// What a box test needs of a ray, and where the ray is. 64 bytes, one cache line.
#[derive(Clone, Copy)]
#[repr(C, align(64))]
struct BoxRay {
    inverse: [f32; 3],
    near_offset: [f32; 3],
    far_offset: [f32; 3],
    /// Where a near plane begins among an axis's planes: 0 or [`LANES`].
    near_side: [u32; 3],
    t_min: f32,
    /// No less than the best hit's `t`, the low bits set: see [`cull_distance`].
    t_max: f32,
    child: Child,
    /// The end of its stack.
    top: u32,
}

/// What a leaf test needs of a ray. 64 bytes, one cache line.
#[derive(Clone, Copy)]
#[repr(C, align(64))]
struct LeafRay {
    /// In the order of `axes`.
    origin: [f32; 3],
    shear: [f32; 2],
    axes: [u32; 3],
    inverse_depth: f32,
    t_min: f32,
    /// The best hit's `t` lies between the two.
    nearest: f32,
    farthest: f32,
    /// The best hit if it is not evaluated yet: lane and leaf.
    pending: Option<(u32, Child)>,
    /// See [`edge_slack`]; for exact decisions alone.
    edge_slack: f32,
}

const _: () = assert!(size_of::<BoxRay>() == 64);
const _: () = assert!(size_of::<LeafRay>() == 64);

impl BoxRay {
    const IDLE: Self = Self {
        inverse: [0.0; 3],
        near_offset: [0.0; 3],
        far_offset: [0.0; 3],
        near_side: [0; 3],
        t_min: 0.0,
        t_max: 0.0,
        child: Child::NONE,
        top: LANES as u32,
    };
}

impl LeafRay {
    const IDLE: Self = Self {
        origin: [0.0; 3],
        shear: [0.0; 2],
        axes: [0; 3],
        inverse_depth: 0.0,
        t_min: 0.0,
        nearest: 0.0,
        farthest: 0.0,
        pending: None,
        edge_slack: 0.0,
    };
}

/// What is used at the start and at the end of a ray.
struct Slot<'a, T> {
    ray: TriangleRay,
    best: ClosestHit,
    answer: Option<&'a mut T>,
}

#[derive(Clone, Copy)]
struct List {
    ids: [u8; IN_FLIGHT],
    count: usize,
}

impl List {
    #[inline(always)]
    fn push(&mut self, id: usize) {
        self.ids[self.count % IN_FLIGHT] = id as u8;
        self.count += 1;
    }

    #[inline(always)]
    fn id(&self, at: usize) -> usize {
        usize::from(self.ids[at % IN_FLIGHT]) % IN_FLIGHT
    }
}

/// How many children can wait, in a power of two so that an index needs no check.
const STACK: usize = 256;
/// A level leaves all children but one waiting.
const MOST_LEVELS: usize = (STACK - LANES) / (LANES - 1);

/// The children that wait for a ray, and where it enters each; the first is at [`LANES`], so that below the last there
/// always is a whole register. Just below the first is [`Child::NONE`], which is never culled.
#[derive(Clone, Copy)]
pub(super) struct Stack {
    keys: [f32; STACK + LANES],
    children: [u32; STACK + LANES],
}

impl Stack {
    const EMPTY: Self =
        Self { keys: [f32::NEG_INFINITY; STACK + LANES], children: [Child::NONE.bits(); STACK + LANES] };

    #[inline(always)]
    fn child(&self, at: u32) -> Child {
        Child::from_bits(self.children[at as usize % STACK])
    }

    /// Eight places from one on.
    #[inline(always)]
    fn set_children(&mut self, at: u32, children: &[u32; LANES]) {
        self.children[at as usize % STACK..][..LANES].copy_from_slice(children);
    }

    #[inline(always)]
    fn set_keys(&mut self, at: u32, keys: &[f32; LANES]) {
        self.keys[at as usize % STACK..][..LANES].copy_from_slice(keys);
    }

    #[inline(always)]
    fn keys(&self, at: u32) -> &[f32; LANES] {
        self.keys[at as usize % STACK..].first_chunk().expect("a register more than can be named")
    }
}

/// The rays of a stretch, all but those that packets answer.
pub(super) struct Flight<'b, 'a, 's, R, T, N, W, A> {
    bvh: &'b WideBvh,
    source: &'s mut Source<'a, R, T, N, W>,
    answer: &'s A,
    stacks: &'s mut [Stack; IN_FLIGHT],
    boxes: [BoxRay; IN_FLIGHT],
    leaves: [LeafRay; IN_FLIGHT],
    slots: [Slot<'a, T>; IN_FLIGHT],
    lists: [List; LISTS],
    lower: Vec3A,
    upper: Vec3A,
}

/// Whether the wavefront takes a ray, which then is valid: its numbers far from overflow and underflow, its interval
/// without negative numbers, so that distances are in the order of their bits. A NaN makes it false.
#[inline(always)]
pub(super) fn is_fit(ray: &Ray) -> bool {
    let (origin, direction) = (Vec3A::from(ray.origin).abs(), Vec3A::from(ray.direction).abs());
    let in_range = origin.cmplt(Vec3A::splat(MOST_REACH))
        & direction.cmplt(Vec3A::splat(MOST_REACH))
        & direction.cmpgt(Vec3A::splat(LEAST_DIRECTION));
    in_range.all() && ray.t_min >= 0.0 && ray.t_min <= ray.t_max
}

/// Whether the scene is within reach for the wavefront and for packets.
pub(super) fn is_in_range(bvh: &WideBvh) -> bool {
    let (lower, upper) = (Vec3A::from(bvh.bounds.lower), Vec3A::from(bvh.bounds.upper));
    lower.abs().max(upper.abs()).max_element() < MOST_REACH
}

/// Whether a ray's stack holds all that may wait.
pub(super) fn is_shallow(bvh: &WideBvh) -> bool {
    bvh.depth as usize <= MOST_LEVELS
}

/// In memory that was asked for.
pub(super) fn stacks(memory: &mut Vec<Stack>) -> &mut [Stack; IN_FLIGHT] {
    memory.resize(IN_FLIGHT, Stack::EMPTY);
    memory.first_chunk_mut().expect("it was made so long")
}

impl<'b, 'a, 's, R, T, N, W: Simd, A> Flight<'b, 'a, 's, R, T, N, W, A>
where
    for<'r> &'r R: Into<Ray>,
    N: FnMut() -> Option<(&'a [R], &'a mut [T])>,
    A: Fn(&mut T, Option<ClosestHit>),
{
    #[inline(always)]
    pub(super) fn new(
        bvh: &'b WideBvh,
        source: &'s mut Source<'a, R, T, N, W>,
        answer: &'s A,
        stacks: &'s mut [Stack; IN_FLIGHT],
    ) -> Self {
        let ray = Ray { origin: glam::Vec3::ZERO, t_min: 0.0, direction: glam::Vec3::X, t_max: 0.0 };
        let idle_ray = TriangleRay::new(&ray);
        let idle_hit = ClosestHit::none(&ray);
        Self {
            bvh,
            source,
            answer,
            stacks,
            boxes: [BoxRay::IDLE; IN_FLIGHT],
            leaves: [LeafRay::IDLE; IN_FLIGHT],
            slots: std::array::from_fn(|_| Slot { ray: idle_ray, best: idle_hit, answer: None }),
            lists: [List { ids: [0; IN_FLIGHT], count: 0 }; LISTS],
            lower: Vec3A::from(bvh.bounds.lower),
            upper: Vec3A::from(bvh.bounds.upper),
        }
    }

    #[inline(always)]
    pub(super) fn run<Q: Query, P: PrecisionMode, S: Simd>(mut self, simd: S) {
        for id in 0..IN_FLIGHT {
            if !self.feed::<Q, P>(id) {
                break;
            }
        }
        while self.lists[NODE].count + self.lists[LEAF].count != 0 {
            self.test_nodes::<Q, S>(simd);
            self.test_leaves::<Q, P, S>(simd);
            self.pop::<Q, P, S>(simd);
            let is_idle = self.lists[NODE].count + self.lists[LEAF].count == 0;
            while self.lists[EVALUATE].count >= HITS || is_idle && self.lists[EVALUATE].count > 0 {
                self.evaluate::<Q, P>();
            }
        }
    }

    /// The next ray that is fit for the wavefront takes a slot; others are answered at once. False without rays.
    #[inline(always)]
    fn feed<Q: Query, P: PrecisionMode>(&mut self, id: usize) -> bool {
        loop {
            self.source.answer_packets::<Q, P>(self.bvh, self.answer);
            let Some((source, place)) = self.source.next() else { return false };
            let ray: Ray = source.into();
            if !self.source.are_coherent() && is_fit(&ray) {
                self.start::<P>(id, &ray, place);
                return true;
            }
            self.source.answer_alone::<Q, P>(self.bvh, ray, place, self.answer);
        }
    }

    #[inline(always)]
    fn start<P: PrecisionMode>(&mut self, id: usize, ray: &Ray, place: &'a mut T) {
        let triangle_ray = TriangleRay::new(ray);
        let [kx, ky, kz] = triangle_ray.axes;
        let origin = Vec3A::from(ray.origin);
        let inverse = Vec3A::ONE / Vec3A::from(ray.direction);
        // As `ObliqueSlabs`.
        let reach = (self.upper - origin).max(origin - self.lower).max_element();
        let slack_distance = gamma(24) * reach + f32::MIN_POSITIVE;
        let offset = origin * inverse;
        let slack = inverse.abs() * slack_distance + offset.abs() * gamma(4) + f32::MIN_POSITIVE;
        let sides = inverse.is_negative_bitmask();
        let inverse_array = inverse.to_array();
        // Adding 0 makes 0 of -0, whose bits are those of a negative number.
        let (t_min, t_max) = (ray.t_min + 0.0, ray.t_max + 0.0);
        self.boxes[id] = BoxRay {
            inverse: inverse_array,
            near_offset: (offset + slack).to_array(),
            far_offset: (offset - slack).to_array(),
            near_side: [(sides << 3) & 8, (sides << 2) & 8, (sides << 1) & 8],
            t_min,
            t_max: cull_distance(t_max),
            child: Child::ROOT,
            top: LANES as u32,
        };
        self.leaves[id] = LeafRay {
            origin: [triangle_ray.origin[0], triangle_ray.origin[1], triangle_ray.origin[2]],
            shear: [triangle_ray.per_z[0], triangle_ray.per_z[1]],
            axes: [kx as u32, ky as u32, kz as u32],
            inverse_depth: inverse_array[kz],
            t_min,
            nearest: t_max,
            farthest: t_max,
            pending: None,
            edge_slack: if P::IS_EXACT { edge_slack(reach) } else { 0.0 },
        };
        let slot = &mut self.slots[id];
        slot.ray = triangle_ray;
        slot.best = ClosestHit::none(ray);
        slot.answer = Some(place);
        self.lists[NODE].push(id);
    }

    /// One node for each ray on the list.
    #[inline(always)]
    fn test_nodes<Q: Query, S: Simd>(&mut self, simd: S) {
        let key_bits = simd.splat(f32::from_bits(!(LANES as u32 - 1)));
        let lane_numbers: [f32; LANES] = [0, 1, 2, 3, 4, 5, 6, 7].map(f32::from_bits);
        let lane_numbers = simd.load(&lane_numbers);
        let sign_bit = simd.splat(-0.0);
        let nodes = self.lists[NODE];
        self.lists[NODE].count = 0;
        let mut next_lists = [0u8; IN_FLIGHT];
        for (at, list) in next_lists.iter_mut().enumerate().take(nodes.count) {
            let id = nodes.id(at);
            let ray = &mut self.boxes[id];
            let node = &self.bvh.nodes[ray.child.node_index()];
            let (enter, leave) = slabs(simd, ray, node);
            let hits = simd.less_or_equal(enter, leave);
            let hit_count = hits.count_ones();
            let stack = &mut self.stacks[id];
            let next = if Q::FIRST_HIT_ENDS {
                // The largest, the last, goes on; what waits goes on after a miss.
                let waiting = stack.child(ray.top - 1);
                stack.set_children(ray.top, &simd.compress(&node.child_bits(), hits));
                let largest = node.children[(31 - (hits | 1).leading_zeros()) as usize % LANES];
                if hits == 0 { waiting } else { largest }
            } else {
                let keys = simd.or(simd.and(enter, key_bits), lane_numbers);
                let keys = if hit_count <= 2 {
                    // Most nodes: without a branch on how many.
                    simd.order_two(simd.compress_lanes(keys, hits))
                } else {
                    // Negative for a miss: `leave` is finite, `enter` not negative, neither is NaN.
                    simd.sort_descending(simd.or(keys, simd.and(simd.sub(leave, enter), sign_bit)))
                };
                stack.set_children(ray.top, &simd.gather(&node.child_bits(), keys));
                stack.set_keys(ray.top, &simd.store(keys));
                // With no hit this is what waited.
                stack.child(ray.top + hit_count - 1)
            };
            let is_culled = if Q::FIRST_HIT_ENDS { next == Child::NONE } else { hit_count == 0 };
            ray.top = ray.top + hit_count - u32::from(!is_culled);
            ray.child = next;
            self.bvh.prefetch(next);
            *list = if is_culled { POP as u8 } else { u8::from(next.is_leaf()) };
        }
        for (at, list) in next_lists.iter().enumerate().take(nodes.count) {
            self.lists[usize::from(*list) % LISTS].push(nodes.id(at));
        }
    }

    /// One leaf for each ray on the list.
    #[inline(always)]
    fn test_leaves<Q: Query, P: PrecisionMode, S: Simd>(&mut self, simd: S) {
        for at in 0..std::mem::take(&mut self.lists[LEAF].count) {
            let id = self.lists[LEAF].id(at);
            let child = self.boxes[id].child;
            let leaf = self.bvh.leaves.leaf(child.triangles());
            let ray = &self.leaves[id];
            let sheared = sheared(simd, ray, &leaf);
            let eight = Eight(simd);
            let weights = weights(eight, &sheared);
            let signs = Signs::of::<P, _>(eight, &sheared, &weights, ray.edge_slack);
            let candidates = leaf.mask() & !signs.differ;
            if candidates != 0 {
                let spans = spans::<P, _>(eight, &sheared, &weights, signs, simd.splat(ray.inverse_depth));
                if self.keep_candidates::<Q, P, S>(simd, id, &leaf, candidates, &spans) {
                    // Nothing is left to do for it.
                    self.boxes[id].top = LANES as u32;
                }
            }
            self.lists[POP].push(id);
        }
    }

    /// Keeps the best of a leaf's candidates. True ends the query.
    #[inline(always)]
    fn keep_candidates<Q: Query, P: PrecisionMode, S: Simd>(
        &mut self,
        simd: S,
        id: usize,
        leaf: &Leaf<'_>,
        candidates: u32,
        spans: &Spans<Eight<S>>,
    ) -> bool {
        let child = self.boxes[id].child;
        let (ray, slot) = (&mut self.leaves[id], &mut self.slots[id]);
        let mut left = candidates & spans.within(Eight(simd), simd.splat(ray.t_min), simd.splat(ray.farthest));
        if left == 0 {
            return false;
        }
        let (from, to) = (simd.store(spans.from), simd.store(spans.to));
        while left != 0 {
            let lane = left.trailing_zeros();
            left &= left - 1;
            let (from, to) = (from[lane as usize % LANES], to[lane as usize % LANES]);
            if from > ray.farthest {
                continue;
            }
            let is_certain = spans.certain >> lane & 1 == 1;
            if is_certain && from >= ray.t_min && to < ray.nearest {
                ray.pending = Some((lane, child));
                (ray.nearest, ray.farthest) = (from, to);
                if Q::FIRST_HIT_ENDS {
                    return true;
                }
                continue;
            }
            settle::<P>(self.bvh, ray, slot);
            let triangle = leaf.triangle(lane as usize % LANES);
            let interval = Interval { t_min: ray.t_min, t_max: slot.best.t };
            if let Some(hit) = slot.ray.hit::<P>(&triangle, interval)
                && slot.best.improve::<P>(&slot.ray, &hit, &triangle)
                && Q::FIRST_HIT_ENDS
            {
                return true;
            }
            (ray.nearest, ray.farthest) = (slot.best.t, slot.best.t);
        }
        self.boxes[id].t_max = cull_distance(ray.farthest);
        false
    }

    /// The next child that waits for each ray on the list; a ray without one is answered, and another takes its slot.
    #[inline(always)]
    fn pop<Q: Query, P: PrecisionMode, S: Simd>(&mut self, simd: S) {
        let mut at = 0;
        while at < self.lists[POP].count {
            let id = self.lists[POP].id(at);
            let ray = &mut self.boxes[id];
            let stack = &self.stacks[id];
            let mut top = ray.top;
            if !Q::FIRST_HIT_ENDS {
                let t_max = simd.splat(ray.t_max);
                loop {
                    // Below the first is one that is never culled.
                    let left = simd.less_or_equal(simd.load(stack.keys(top - LANES as u32)), t_max);
                    top -= left.leading_zeros() - (32 - LANES as u32);
                    if left != 0 {
                        break;
                    }
                }
            }
            let next = stack.child(top - 1);
            if next == Child::NONE {
                if !Q::FIRST_HIT_ENDS && P::HAS_LANES && self.leaves[id].pending.is_some() {
                    self.lists[EVALUATE].push(id);
                } else {
                    self.finish::<Q, P>(id);
                    self.feed::<Q, P>(id);
                }
            } else {
                ray.child = next;
                ray.top = top - 1;
                self.bvh.prefetch(next);
                self.lists[usize::from(next.is_leaf())].push(id);
            }
            at += 1;
        }
        self.lists[POP].count = 0;
    }

    /// The last rays on the list, as many as are evaluated at once.
    #[inline(always)]
    fn evaluate<Q: Query, P: PrecisionMode>(&mut self) {
        let first = self.lists[EVALUATE].count.saturating_sub(HITS);
        let count = self.lists[EVALUATE].count - first;
        let list = self.lists[EVALUATE];
        self.lists[EVALUATE].count = first;
        let mut lanes = HitLanes::EMPTY;
        for lane in 0..count {
            let id = list.id(first + lane);
            if let Some((of_leaf, child)) = self.leaves[id].pending {
                let triangle = self.bvh.leaves.leaf(child.triangles()).triangle(of_leaf as usize % LANES);
                lanes.set(lane, &self.slots[id].ray, &triangle);
            }
        }
        let hits = lanes.evaluate::<P>();
        for lane in 0..count {
            let id = list.id(first + lane);
            if let Some(hit) = settled(&hits, lane)
                && let Some((of_leaf, child)) = self.leaves[id].pending.take()
            {
                let primitive = self.bvh.leaves.leaf(child.triangles()).triangle(of_leaf as usize % LANES);
                self.slots[id].best = ClosestHit { t: hit.t, u: hit.u, v: hit.v, primitive };
            }
            self.finish::<Q, P>(id);
            self.feed::<Q, P>(id);
        }
    }

    #[inline(always)]
    fn finish<Q: Query, P: PrecisionMode>(&mut self, id: usize) {
        let (ray, slot) = (&mut self.leaves[id], &mut self.slots[id]);
        let Some(place) = slot.answer.take() else { return };
        self.source.count_answered();
        if Q::FIRST_HIT_ENDS {
            let is_hit = ray.pending.is_some() || slot.best.found().is_some();
            (self.answer)(place, is_hit.then_some(slot.best));
        } else {
            settle::<P>(self.bvh, ray, slot);
            (self.answer)(place, slot.best.found().map(|hit| self.bvh.leaves.resolve(hit)));
        }
    }
}

/// Evaluates the best hit where that was put off.
#[inline(always)]
fn settle<P: PrecisionMode>(bvh: &WideBvh, ray: &mut LeafRay, slot: &mut Slot<'_, impl Sized>) {
    let Some((lane, child)) = ray.pending.take() else { return };
    let triangle = bvh.leaves.leaf(child.triangles()).triangle(lane as usize % LANES);
    let interval = Interval { t_min: ray.t_min, t_max: f32::INFINITY };
    if let Some(hit) = slot.ray.hit::<P>(&triangle, interval) {
        slot.best = ClosestHit { t: hit.t, u: hit.u, v: hit.v, primitive: triangle };
    }
}

/// `t` with its low bits set, so that it is no less than any key that was made of an equal distance.
#[inline(always)]
fn cull_distance(t: f32) -> f32 {
    // Adding 0 makes 0 of -0, whose bits are those of a negative number.
    f32::from_bits((t.min(f32::MAX) + 0.0).to_bits() | (LANES as u32 - 1))
}

/// Where a ray enters and leaves a node's boxes.
#[inline(always)]
fn slabs<S: Simd>(simd: S, ray: &BoxRay, node: &WideNode) -> (S::F32x8, S::F32x8) {
    let (near_x, far_x) = slab(simd, ray, node, 0);
    let (near_y, far_y) = slab(simd, ray, node, 1);
    let (near_z, far_z) = slab(simd, ray, node, 2);
    let enter = simd.max(near_x, simd.max(near_y, simd.max(near_z, simd.splat(ray.t_min))));
    let leave = simd.min(far_x, simd.min(far_y, simd.min(far_z, simd.splat(ray.t_max))));
    (enter, leave)
}

#[inline(always)]
fn slab<S: Simd>(simd: S, ray: &BoxRay, node: &WideNode, axis: usize) -> (S::F32x8, S::F32x8) {
    let near = ray.near_side[axis] as usize & LANES;
    let planes = node.planes[axis].as_flattened();
    let (near, far) = (
        planes[near..].first_chunk().expect("two registers"),
        planes[near ^ LANES..].first_chunk().expect("two registers"),
    );
    let inverse = simd.splat(ray.inverse[axis]);
    let near = simd.mul_sub(simd.load(near), inverse, simd.splat(ray.near_offset[axis]));
    let far = simd.mul_sub(simd.load(far), inverse, simd.splat(ray.far_offset[axis]));
    (near, far)
}

/// The vertices of eight triangles, sheared so that the ray is the z axis.
#[inline(always)]
fn sheared<S: Simd>(simd: S, ray: &LeafRay, leaf: &Leaf<'_>) -> [Corners<Eight<S>>; 3] {
    let [kx, ky, kz] = [ray.axes[0] as usize, ray.axes[1] as usize, ray.axes[2] as usize];
    let z = from_origin(simd, leaf, kz, ray.origin[2]);
    let eight = Eight(simd);
    let x = shear(eight, from_origin(simd, leaf, kx, ray.origin[0]), simd.splat(ray.shear[0]), z);
    let y = shear(eight, from_origin(simd, leaf, ky, ray.origin[1]), simd.splat(ray.shear[1]), z);
    [x, y, z]
}

#[inline(always)]
fn from_origin<S: Simd>(simd: S, leaf: &Leaf<'_>, axis: usize, origin: f32) -> Corners<Eight<S>> {
    let origin = simd.splat(origin);
    let [a, b, c] = leaf.rows(axis);
    [simd.sub(simd.load(a), origin), simd.sub(simd.load(b), origin), simd.sub(simd.load(c), origin)]
}
