//! Rays that go the same way, together: at a node the boxes that all of them as one [beam](super::beam) may meet, then each
//! of these against all rays; at a leaf each triangle against all rays.

use std::marker::PhantomData;

use arrayvec::ArrayVec;

use super::WideBvh;
use super::beam::Beam;
use super::coherent::{Coherent, PACKET, Row};
use super::leaves::{Leaf, LeafRows, LeafTriangles};
use super::node::{Child, WideNode};
use super::spans::{Corners, Signs, shear, spans, weights};
use crate::accel::bvh::node::MOST_LEVELS;
use crate::accel::leaf::{ClosestHit, Query};
use crate::geometry::{HITS, HitLanes, Interval, PrecisionMode, Ray, Triangle, TriangleRay, edge_slack, settled};
use crate::math::gamma;
use crate::simd::{Floats, LANES, Simd, SimdKernel, Sixteen};

const _: () = assert!(HITS == LANES && PACKET == 2 * HITS);

/// A packet as a kernel.
pub(super) struct Packet<'b, 'p, Q, P, R, T, A> {
    bvh: &'b WideBvh,
    rays: &'p [R],
    coherent: &'p Coherent,
    places: &'p mut [T],
    answer: &'p A,
    choices: PhantomData<(Q, P)>,
}

impl<'b, 'p, Q, P, R, T, A> Packet<'b, 'p, Q, P, R, T, A> {
    pub(super) fn new(
        bvh: &'b WideBvh,
        rays: &'p [R],
        coherent: &'p Coherent,
        places: &'p mut [T],
        answer: &'p A,
    ) -> Self {
        Self { bvh, rays, coherent, places, answer, choices: PhantomData }
    }
}

/// A child that waits: where the first ray may enter it, and the slot that holds its box.
#[derive(Clone, Copy)]
struct Pending {
    enter: f32,
    child: Child,
    parent: u32,
    slot: u32,
}

type Stack = ArrayVec<Pending, { MOST_LEVELS * (LANES - 1) }>;

/// The rays on their way.
struct Rays<'p> {
    coherent: &'p Coherent,
    inverse: [Row; 3],
    near_offset: [Row; 3],
    far_offset: [Row; 3],
    /// In the order of the packet's axes.
    shear: [Row; 2],
    /// The best hit's `t` lies between the two. Without a hit both are `t_max`; `-inf` where nothing is left to find.
    nearest: Row,
    farthest: Row,
    /// Whose best hit is not evaluated yet, with leaf and lane of each as bits, which no arithmetic touches.
    pending: u32,
    leaf: Row,
    lane: Row,
    best: [ClosestHit; PACKET],
    /// See [`edge_slack`]: of the ray that needs most; for exact decisions alone.
    edge_slack: f32,
}

impl<Q, P, R, T, A> SimdKernel for Packet<'_, '_, Q, P, R, T, A>
where
    for<'r> &'r R: Into<Ray>,
    A: Fn(&mut T, Option<ClosestHit>),
    Q: Query,
    P: PrecisionMode,
{
    type Output = ();

    #[inline(always)]
    fn run<S: Simd>(self, simd: S) {
        let Self { bvh, rays: sources, coherent, places, answer, .. } = self;
        let floats = simd.sixteen();
        let mut rays = Rays::new::<P, _>(floats, bvh, coherent, ClosestHit::none(&(&sources[0]).into()));
        let beam = Beam::new(simd, bvh, coherent);
        let mut t_max = rays.farthest_of_all(floats);
        let mut stack = Stack::new_const();
        let mut next = Some(Pending { enter: 0.0, child: Child::ROOT, parent: 0, slot: 0 });
        while let Some(current) = next {
            if current.child.is_leaf() {
                let parent = &bvh.nodes[current.parent as usize];
                // Hits since then may have left fewer rays for it.
                let active = rays.meet(floats, parent, current.slot as usize % LANES);
                if active != 0 && rays.test_leaf::<Q, P, R, _>(floats, active, current.child, bvh, sources) {
                    t_max = rays.farthest_of_all(floats);
                    if t_max < 0.0 {
                        break;
                    }
                }
            } else {
                let node = &bvh.nodes[current.child.node_index()];
                let (mut hits, enter) = beam.test(simd, node, t_max);
                let enter = simd.store(enter);
                let bottom = stack.len();
                while hits != 0 {
                    let slot = hits.trailing_zeros();
                    hits &= hits - 1;
                    let child = node.children[slot as usize % LANES];
                    bvh.prefetch(child);
                    if rays.meet(floats, node, slot as usize % LANES) != 0 {
                        let parent = current.child.node_index() as u32;
                        push(&mut stack, bottom, Pending { enter: enter[slot as usize % LANES], child, parent, slot });
                    }
                }
            }
            next = loop {
                match stack.pop() {
                    Some(pending) if pending.enter > t_max => {}
                    other => break other,
                }
            };
        }
        if !Q::FIRST_HIT_ENDS && P::HAS_LANES && rays.pending != 0 {
            rays.settle_together::<P>(bvh);
        }
        for (index, (place, source)) in places.iter_mut().zip(sources).enumerate().take(PACKET) {
            if Q::FIRST_HIT_ENDS {
                let is_hit = rays.pending >> index & 1 == 1 || rays.best[index].found().is_some();
                answer(place, is_hit.then_some(rays.best[index]));
            } else {
                rays.settle::<P, R>(index, bvh, source);
                answer(place, rays.best[index].found().map(|hit| bvh.leaves.resolve(hit)));
            }
        }
    }
}

/// Puts a child above those from `bottom` on that are entered later.
#[inline(always)]
fn push(stack: &mut Stack, bottom: usize, pending: Pending) {
    let mut at = stack.len();
    stack.push(pending);
    while at > bottom && stack[at - 1].enter < pending.enter {
        stack[at] = stack[at - 1];
        at -= 1;
    }
    stack[at] = pending;
}

impl<'p> Rays<'p> {
    /// `none` is the first ray's.
    #[inline(always)]
    fn new<P: PrecisionMode, F: Sixteen>(floats: F, bvh: &WideBvh, coherent: &'p Coherent, none: ClosestHit) -> Self {
        let mut rays = Self {
            coherent,
            inverse: [Row::ZERO; 3],
            near_offset: [Row::ZERO; 3],
            far_offset: [Row::ZERO; 3],
            shear: [Row::ZERO; 2],
            nearest: coherent.t_max,
            farthest: coherent.t_max,
            pending: 0,
            leaf: Row::ZERO,
            lane: Row::ZERO,
            best: [none; PACKET],
            edge_slack: 0.0,
        };
        for (best, t_max) in rays.best.iter_mut().zip(&coherent.t_max.0) {
            best.t = *t_max;
        }
        // What stands in for rays that lack looks for nothing.
        for row in [&mut rays.nearest, &mut rays.farthest] {
            row.0[coherent.count..].fill(f32::NEG_INFINITY);
        }
        let [kx, ky, kz] = coherent.axes;
        // As `ObliqueSlabs`.
        let mut reach = floats.splat(0.0);
        for axis in 0..3 {
            let origin = coherent.origin[axis].load(floats);
            let (lower, upper) = (floats.splat(bvh.bounds.lower[axis]), floats.splat(bvh.bounds.upper[axis]));
            reach = floats.max(reach, floats.max(floats.sub(upper, origin), floats.sub(origin, lower)));
        }
        if P::IS_EXACT {
            rays.edge_slack = edge_slack(floats.greatest(reach));
        }
        let least = floats.splat(f32::MIN_POSITIVE);
        let slack_distance = floats.add(floats.mul(floats.splat(gamma(24)), reach), least);
        for axis in 0..3 {
            let inverse = floats.div(floats.splat(1.0), coherent.direction[axis].load(floats));
            let offset = floats.mul(coherent.origin[axis].load(floats), inverse);
            let slack = floats.add(
                floats.mul(floats.abs(inverse), slack_distance),
                floats.mul(floats.abs(offset), floats.splat(gamma(4))),
            );
            let slack = floats.add(slack, least);
            rays.inverse[axis].store(floats, inverse);
            rays.near_offset[axis].store(floats, floats.add(offset, slack));
            rays.far_offset[axis].store(floats, floats.sub(offset, slack));
        }
        let depth = coherent.direction[kz % 3].load(floats);
        for (row, axis) in rays.shear.iter_mut().zip([kx, ky]) {
            row.store(floats, floats.div(coherent.direction[axis % 3].load(floats), depth));
        }
        rays
    }

    /// No ray still looks beyond this.
    #[inline(always)]
    fn farthest_of_all<F: Sixteen>(&self, floats: F) -> f32 {
        floats.greatest(self.farthest.load(floats))
    }

    /// Which rays meet a slot's box.
    #[inline(always)]
    fn meet<F: Sixteen>(&self, floats: F, node: &WideNode, slot: usize) -> u32 {
        let (near_x, far_x) = self.slab(floats, node, slot, 0);
        let (near_y, far_y) = self.slab(floats, node, slot, 1);
        let (near_z, far_z) = self.slab(floats, node, slot, 2);
        let (t_min, farthest) = (self.coherent.t_min.load(floats), self.farthest.load(floats));
        let enter = floats.max(floats.max(near_x, near_y), floats.max(near_z, t_min));
        let leave = floats.min(floats.min(far_x, far_y), floats.min(far_z, farthest));
        floats.less_or_equal(enter, leave)
    }

    #[inline(always)]
    fn slab<F: Sixteen>(&self, floats: F, node: &WideNode, slot: usize, axis: usize) -> (F::Vector, F::Vector) {
        let side = (self.coherent.signs >> axis & 1) as usize;
        let planes = &node.planes[axis];
        let (near, far) = (floats.splat(planes[side][slot]), floats.splat(planes[side ^ 1][slot]));
        let inverse = self.inverse[axis].load(floats);
        (
            floats.mul_sub(near, inverse, self.near_offset[axis].load(floats)),
            floats.mul_sub(far, inverse, self.far_offset[axis].load(floats)),
        )
    }

    /// The leaf's triangles, one after the other, against the active rays. True if any ray's best hit may have changed.
    #[inline(always)]
    fn test_leaf<Q: Query, P: PrecisionMode, R, F: Sixteen>(
        &mut self,
        floats: F,
        active: u32,
        child: Child,
        bvh: &WideBvh,
        sources: &[R],
    ) -> bool
    where
        for<'r> &'r R: Into<Ray>,
    {
        let leaf = bvh.leaves.leaf(child.triangles());
        let [kx, ky, kz] = self.coherent.axes;
        let origin = |axis: usize| self.coherent.origin[axis % 3].load(floats);
        let origin = [origin(kx), origin(ky), origin(kz)];
        let (shear_x, shear_y) = (self.shear[0].load(floats), self.shear[1].load(floats));
        let (rows_x, rows_y, rows_z) = (leaf.rows(kx), leaf.rows(ky), leaf.rows(kz));
        let mut is_changed = false;
        for lane in 0..child.triangles().1 {
            let z = from_origin(floats, rows_z, lane, origin[2]);
            let x = shear(floats, from_origin(floats, rows_x, lane, origin[0]), shear_x, z);
            let y = shear(floats, from_origin(floats, rows_y, lane, origin[1]), shear_y, z);
            let sheared = [x, y, z];
            let weights = weights(floats, &sheared);
            let signs = Signs::of::<P, F>(floats, &sheared, &weights, self.edge_slack);
            let candidates = active & !signs.differ;
            if candidates == 0 {
                continue;
            }
            let inverse_depth = self.inverse[kz % 3].load(floats);
            let spans = spans::<P, F>(floats, &sheared, &weights, signs, inverse_depth);
            let (t_min, farthest) = (self.coherent.t_min.load(floats), self.farthest.load(floats));
            let within = candidates & spans.within(floats, t_min, farthest);
            if within == 0 {
                continue;
            }
            is_changed = true;
            let nearest = self.nearest.load(floats);
            let sure =
                within & spans.certain & floats.less_or_equal(t_min, spans.from) & floats.less(spans.to, nearest);
            self.pending |= sure;
            let (from, to) = if Q::FIRST_HIT_ENDS {
                let ended = floats.splat(f32::NEG_INFINITY);
                (ended, ended)
            } else {
                let bits = |bits: u32| floats.splat(f32::from_bits(bits));
                let (of_leaf, of_lane) = (self.leaf.load(floats), self.lane.load(floats));
                self.leaf.store(floats, floats.blend(of_leaf, bits(child.bits()), sure));
                self.lane.store(floats, floats.blend(of_lane, bits(lane as u32), sure));
                (spans.from, spans.to)
            };
            self.nearest.store(floats, floats.blend(nearest, from, sure));
            self.farthest.store(floats, floats.blend(farthest, to, sure));
            let mut left = within & !sure;
            while left != 0 {
                let index = left.trailing_zeros() as usize % PACKET;
                left &= left - 1;
                let Some(source) = sources.get(index) else { continue };
                self.evaluate::<Q, P, R>(index, bvh, source, &leaf, lane);
            }
        }
        is_changed
    }

    /// A hit that bounds tell too little of.
    #[inline(always)]
    fn evaluate<Q: Query, P: PrecisionMode, R>(
        &mut self,
        index: usize,
        bvh: &WideBvh,
        source: &R,
        leaf: &Leaf<'_>,
        lane: usize,
    ) where
        for<'r> &'r R: Into<Ray>,
    {
        self.settle::<P, R>(index, bvh, source);
        let triangle = leaf.triangle(lane);
        let best = &mut self.best[index];
        let interval = Interval { t_min: self.coherent.t_min.0[index], t_max: best.t };
        let ray = TriangleRay::new(&source.into());
        if let Some(hit) = ray.hit::<P>(&triangle, interval) {
            best.improve::<P>(&ray, &hit, &triangle);
        }
        let t = if Q::FIRST_HIT_ENDS && best.found().is_some() { f32::NEG_INFINITY } else { best.t };
        (self.nearest.0[index], self.farthest.0[index]) = (t, t);
    }

    /// The triangle of a hit that is not evaluated yet.
    #[inline(always)]
    fn pending_triangle(&self, index: usize, bvh: &WideBvh) -> Triangle {
        let leaf = bvh.leaves.leaf(Child::from_bits(self.leaf.0[index].to_bits()).triangles());
        leaf.triangle(self.lane.0[index].to_bits() as usize % LANES)
    }

    /// As [`Rays::settle`] for all rays, as far as one evaluation is enough.
    #[inline(always)]
    fn settle_together<P: PrecisionMode>(&mut self, bvh: &WideBvh) {
        let axes = self.coherent.axes;
        let Coherent { origin, direction, .. } = self.coherent;
        let [kx, ky, kz] = axes.map(|axis| axis % 3);
        let mut lanes = [HitLanes::EMPTY; PACKET / HITS];
        // All of them before the first is evaluated: registers that are loaded of single floats wait until those are stored.
        for (group, lanes) in lanes.iter_mut().enumerate() {
            let values = |row: &Row| row.0.as_chunks::<HITS>().0[group];
            *lanes = HitLanes::of_rays(
                [values(&origin[kx]), values(&origin[ky]), values(&origin[kz])],
                [values(&direction[kx]), values(&direction[ky]), values(&direction[kz])],
            );
            for of_group in 0..HITS {
                let index = group * HITS + of_group;
                if self.pending >> index & 1 == 1 {
                    let triangle = self.pending_triangle(index, bvh);
                    lanes.set_triangle(of_group, axes, &triangle);
                }
            }
        }
        for (group, lanes) in lanes.iter().enumerate() {
            let hits = lanes.evaluate::<P>();
            for of_group in 0..HITS {
                let index = group * HITS + of_group;
                if self.pending >> index & 1 == 1
                    && let Some(hit) = settled(&hits, of_group)
                {
                    self.pending &= !(1 << index);
                    let primitive = self.pending_triangle(index, bvh);
                    self.best[index] = ClosestHit { t: hit.t, u: hit.u, v: hit.v, primitive };
                }
            }
        }
    }

    /// Evaluates the best hit where that was put off.
    #[inline(always)]
    fn settle<P: PrecisionMode, R>(&mut self, index: usize, bvh: &WideBvh, source: &R)
    where
        for<'r> &'r R: Into<Ray>,
    {
        if self.pending >> index & 1 == 0 {
            return;
        }
        self.pending &= !(1 << index);
        let triangle = self.pending_triangle(index, bvh);
        let interval = Interval { t_min: self.coherent.t_min.0[index], t_max: f32::INFINITY };
        if let Some(hit) = TriangleRay::new(&source.into()).hit::<P>(&triangle, interval) {
            self.best[index] = ClosestHit { t: hit.t, u: hit.u, v: hit.v, primitive: triangle };
        }
    }
}

#[inline(always)]
fn from_origin<F: Floats>(floats: F, rows: [&[f32; LANES]; 3], lane: usize, origin: F::Vector) -> Corners<F> {
    let from_origin = |row: &[f32; LANES]| floats.sub(floats.splat(row[lane % LANES]), origin);
    [from_origin(rows[0]), from_origin(rows[1]), from_origin(rows[2])]
}
