//! Rays that go the same way, together: a node's eight boxes against all of them at once, as one beam; at a leaf its
//! box, then each triangle, against eight rays at a time.
//!
//! Source: Wald, Boulos, Shirley 2007, "Ray tracing deformable scenes using dynamic bounding volume hierarchies",
//! section 4, for the interval test.

use std::marker::PhantomData;

use arrayvec::ArrayVec;
use glam::{Vec3, Vec3A};

use super::WideBvh;
use super::leaf_test::Corners;
use super::leaves::{Leaf, LeafTriangles};
use super::node::{Child, WideNode};
use super::wavefront::{LEAST_DIRECTION, MOST_REACH, Signs, is_fit, shear, spans, weights};
use crate::accel::bvh::node::MOST_LEVELS;
use crate::accel::leaf::{ClosestHit, Query};
use crate::geometry::{Aabb, HITS, HitLanes, Interval, PrecisionMode, Ray, TriangleRay, edge_slack, settled};
use crate::math::gamma;
use crate::simd::{LANES, Simd, SimdKernel, prefetch};

/// How many rays make a packet.
pub(super) const PACKET: usize = 16;
const GROUPS: usize = PACKET / LANES;
const _: () = assert!(HITS == LANES);

/// The widest difference of two directions along an axis, in lengths of the largest component.
const MOST_SPREAD: f32 = 0.25;
/// The widest difference of two origins along an axis, in lengths of the scene's largest side.
const MOST_DISTANCE: f32 = 1.0 / 64.0;

/// A packet whose leaves are each met by fewer rays than this on average is given up after so many leaves: rays one by
/// one test a leaf's triangles at once, too.
const LEAST_RAYS_A_LEAF: u32 = 3;
const TRIAL_LEAVES: u32 = 8;

/// One value a ray.
type Row = [f32; PACKET];

/// Rays that go the same way, value by value, and what they lie between.
pub(super) struct Coherent {
    origin: [Row; 3],
    direction: [Row; 3],
    t_min: Row,
    t_max: Row,
    /// The least and the greatest along each axis.
    origin_ends: [[f32; 2]; 3],
    direction_ends: [[f32; 2]; 3],
    signs: u32,
    axes: [usize; 3],
}

impl Coherent {
    /// If the signs and the largest component agree, and little else differs.
    #[inline(always)]
    pub(super) fn of<S: Simd, R>(simd: S, rays: &[R; PACKET], bounds: &Aabb) -> Option<Self>
    where
        for<'r> &'r R: Into<Ray>,
    {
        let (first, last): (Ray, Ray) = ((&rays[0]).into(), (&rays[PACKET - 1]).into());
        let direction = Vec3A::from(first.direction);
        let signs = direction.is_negative_bitmask();
        let most_across = MOST_SPREAD * direction.abs().max_element();
        // The two settle most refusals.
        let last = Vec3A::from(last.direction);
        if last.is_negative_bitmask() != signs
            || (last - direction).abs().max_element() > most_across
            || !is_fit(&first)
        {
            return None;
        }
        let row = [0.0; PACKET];
        let mut coherent = Self {
            origin: [row; 3],
            direction: [row; 3],
            t_min: row,
            t_max: row,
            origin_ends: [[0.0; 2]; 3],
            direction_ends: [[0.0; 2]; 3],
            signs,
            axes: TriangleRay::new(&first).axes,
        };
        for (index, ray) in rays.iter().enumerate() {
            let ray: Ray = ray.into();
            for axis in 0..3 {
                coherent.origin[axis][index] = ray.origin[axis];
                coherent.direction[axis][index] = ray.direction[axis];
            }
            coherent.t_min[index] = ray.t_min;
            coherent.t_max[index] = ray.t_max;
        }
        if !coherent.are_alike(simd) {
            return None;
        }
        for axis in 0..3 {
            coherent.origin_ends[axis] = ends(simd, &coherent.origin[axis]);
            coherent.direction_ends[axis] = ends(simd, &coherent.direction[axis]);
        }
        let most_apart = MOST_DISTANCE * (bounds.upper - bounds.lower).max_element();
        let widest = |[x, y, z]: &[[f32; 2]; 3]| (x[1] - x[0]).max(y[1] - y[0]).max(z[1] - z[0]);
        let is_narrow = widest(&coherent.direction_ends) <= most_across && widest(&coherent.origin_ends) <= most_apart;
        is_narrow.then_some(coherent)
    }

    /// Whether all are [fit](is_fit), go the same way along each axis, and have the axes that each would have alone.
    #[inline(always)]
    fn are_alike<S: Simd>(&self, simd: S) -> bool {
        const ALL: u32 = 0xFF;
        let (zero, most, least) = (simd.splat(0.0), simd.splat(MOST_REACH), simd.splat(LEAST_DIRECTION));
        let longest = self.axes[2];
        let mut alike = ALL;
        for group in 0..GROUPS {
            let (t_min, t_max) = (load(simd, &self.t_min, group), load(simd, &self.t_max, group));
            alike &= simd.less_or_equal(zero, t_min) & simd.less_or_equal(t_min, t_max);
            let length = simd.abs(load(simd, &self.direction[longest % 3], group));
            for axis in 0..3 {
                let origin = simd.abs(load(simd, &self.origin[axis], group));
                let direction = load(simd, &self.direction[axis], group);
                let is_negative = self.signs >> axis & 1 == 1;
                let along = simd.abs(direction);
                alike &= simd.less(origin, most) & simd.less(along, most) & simd.less(least, along);
                alike &= if is_negative { simd.less(direction, zero) } else { simd.less(zero, direction) };
                // Of equal components a ray takes the first.
                alike &= if axis < longest { simd.less(along, length) } else { simd.less_or_equal(along, length) };
            }
        }
        alike == ALL
    }
}

/// A group's values.
#[inline(always)]
fn load<S: Simd>(simd: S, row: &Row, group: usize) -> S::F32x8 {
    let at = group % GROUPS * LANES;
    simd.load(row[at..].first_chunk().expect("a whole group"))
}

#[inline(always)]
fn store<S: Simd>(simd: S, row: &mut Row, group: usize, values: S::F32x8) {
    let at = group % GROUPS * LANES;
    row[at..][..LANES].copy_from_slice(&simd.store(values));
}

/// The least and the greatest.
#[inline(always)]
fn ends<S: Simd>(simd: S, row: &Row) -> [f32; 2] {
    let (mut least, mut most) = (load(simd, row, 0), load(simd, row, 0));
    for group in 1..GROUPS {
        let values = load(simd, row, group);
        (least, most) = (simd.min(values, least), simd.max(values, most));
    }
    let (least, most) = (simd.store(least), simd.store(most));
    let mut ends = [least[0], most[0]];
    for lane in 1..LANES {
        ends[0] = if least[lane] < ends[0] { least[lane] } else { ends[0] };
        ends[1] = if most[lane] > ends[1] { most[lane] } else { ends[1] };
    }
    ends
}

/// A packet as a kernel.
pub(super) struct Packet<'b, 'p, Q, P, R, T, A> {
    bvh: &'b WideBvh,
    rays: &'p [R; PACKET],
    coherent: &'p Coherent,
    places: &'p mut [T; PACKET],
    answer: &'p A,
    choices: PhantomData<(Q, P)>,
}

impl<'b, 'p, Q, P, R, T, A> Packet<'b, 'p, Q, P, R, T, A> {
    pub(super) fn new(
        bvh: &'b WideBvh,
        rays: &'p [R; PACKET],
        coherent: &'p Coherent,
        places: &'p mut [T; PACKET],
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
    /// The best hit if it is not evaluated yet: lane and leaf.
    pending: [Option<(u32, Child)>; PACKET],
    /// See [`edge_slack`]: of the ray that needs most; for exact decisions alone.
    edge_slack: f32,
}

/// All rays as one, in the form `sign * plane`: for each axis the side of near planes, and intervals.
struct Beam<S: Simd> {
    near_side: [usize; 3],
    sign: [S::F32x8; 3],
    /// The largest and the least `sign * origin`.
    origin: [[S::F32x8; 2]; 3],
    /// The least and the largest `|1 / direction|`.
    inverse: [[S::F32x8; 2]; 3],
    slack: [S::F32x8; 3],
    t_min: S::F32x8,
}

impl<Q, P, R, T, A> SimdKernel for Packet<'_, '_, Q, P, R, T, A>
where
    for<'r> &'r R: Into<Ray>,
    A: Fn(&mut T, Option<ClosestHit>),
    Q: Query,
    P: PrecisionMode,
{
    /// Whether the rays stay together well enough; if not, nothing was answered.
    type Output = bool;

    #[inline(always)]
    fn run<S: Simd>(self, simd: S) -> bool {
        let Self { bvh, rays: sources, coherent, places, answer, .. } = self;
        let mut best: [ClosestHit; PACKET] = [ClosestHit::none(&(&sources[0]).into()); PACKET];
        for (best, t_max) in best.iter_mut().zip(&coherent.t_max) {
            best.t = *t_max;
        }
        let mut rays = Rays::new::<P, S>(simd, bvh, coherent);
        let beam = Beam::new(simd, bvh, coherent);
        let mut t_max = rays.farthest_of_all(simd);
        let mut stack = Stack::new_const();
        let (mut leaf_count, mut ray_count) = (0, 0);
        let mut next = Some(Pending { enter: 0.0, child: Child::ROOT, parent: 0, slot: 0 });
        while let Some(current) = next {
            if current.child.is_leaf() {
                let leaf = bvh.leaves.leaf(current.child.triangles());
                let parent = &bvh.nodes[current.parent as usize];
                let mut is_changed = false;
                leaf_count += 1;
                if leaf_count >= TRIAL_LEAVES && ray_count < LEAST_RAYS_A_LEAF * leaf_count {
                    return false;
                }
                for group in 0..GROUPS {
                    let active = rays.meet(simd, group, parent, current.slot as usize % LANES);
                    if active != 0 {
                        ray_count += active.count_ones();
                        is_changed |= rays.test_leaf::<Q, P, R, S>(
                            simd,
                            group,
                            active,
                            &leaf,
                            current.child,
                            bvh,
                            sources,
                            &mut best,
                        );
                    }
                }
                if is_changed {
                    t_max = rays.farthest_of_all(simd);
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
                    if !child.is_leaf() {
                        prefetch(&bvh.nodes[child.node_index()]);
                    }
                    let parent = current.child.node_index() as u32;
                    push(&mut stack, bottom, Pending { enter: enter[slot as usize % LANES], child, parent, slot });
                }
            }
            next = loop {
                match stack.pop() {
                    Some(pending) if pending.enter > t_max => {}
                    other => break other,
                }
            };
        }
        if !Q::FIRST_HIT_ENDS && P::HAS_LANES {
            for group in 0..GROUPS {
                rays.settle_group::<P>(group, bvh, &mut best);
            }
        }
        for (index, place) in places.iter_mut().enumerate() {
            if Q::FIRST_HIT_ENDS {
                let is_hit = rays.pending[index].is_some() || best[index].found().is_some();
                answer(place, is_hit.then_some(best[index]));
            } else {
                rays.settle::<P, R>(index, bvh, &sources[index], &mut best[index]);
                answer(place, best[index].found().map(|hit| bvh.leaves.resolve(hit)));
            }
        }
        true
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
    #[inline(always)]
    fn new<P: PrecisionMode, S: Simd>(simd: S, bvh: &WideBvh, coherent: &'p Coherent) -> Self {
        let row = [0.0; PACKET];
        let mut rays = Self {
            coherent,
            inverse: [row; 3],
            near_offset: [row; 3],
            far_offset: [row; 3],
            shear: [row; 2],
            nearest: coherent.t_max,
            farthest: coherent.t_max,
            pending: [None; PACKET],
            edge_slack: 0.0,
        };
        let [kx, ky, kz] = coherent.axes;
        for group in 0..GROUPS {
            // As `ObliqueSlabs`.
            let mut reach = simd.splat(0.0);
            for axis in 0..3 {
                let origin = load(simd, &coherent.origin[axis], group);
                let (lower, upper) = (simd.splat(bvh.bounds.lower[axis]), simd.splat(bvh.bounds.upper[axis]));
                reach = simd.max(reach, simd.max(simd.sub(upper, origin), simd.sub(origin, lower)));
            }
            if P::IS_EXACT {
                for reach in simd.store(reach) {
                    rays.edge_slack = rays.edge_slack.max(edge_slack(reach));
                }
            }
            let slack_distance = simd.add(simd.mul(simd.splat(gamma(24)), reach), simd.splat(f32::MIN_POSITIVE));
            for axis in 0..3 {
                let inverse = simd.div(simd.splat(1.0), load(simd, &coherent.direction[axis], group));
                let offset = simd.mul(load(simd, &coherent.origin[axis], group), inverse);
                let slack = simd
                    .add(simd.mul(simd.abs(inverse), slack_distance), simd.mul(simd.abs(offset), simd.splat(gamma(4))));
                let slack = simd.add(slack, simd.splat(f32::MIN_POSITIVE));
                store(simd, &mut rays.inverse[axis], group, inverse);
                store(simd, &mut rays.near_offset[axis], group, simd.add(offset, slack));
                store(simd, &mut rays.far_offset[axis], group, simd.sub(offset, slack));
            }
            let depth = load(simd, &coherent.direction[kz % 3], group);
            for (row, axis) in rays.shear.iter_mut().zip([kx, ky]) {
                store(simd, row, group, simd.div(load(simd, &coherent.direction[axis % 3], group), depth));
            }
        }
        rays
    }

    /// No ray still looks beyond this.
    #[inline(always)]
    fn farthest_of_all<S: Simd>(&self, simd: S) -> f32 {
        let mut most = simd.splat(f32::NEG_INFINITY);
        for group in 0..GROUPS {
            most = simd.max(load(simd, &self.farthest, group), most);
        }
        simd.store(most).into_iter().fold(f32::NEG_INFINITY, |a, b| if a > b { a } else { b })
    }

    /// Which rays of a group meet a slot's box.
    #[inline(always)]
    fn meet<S: Simd>(&self, simd: S, group: usize, node: &WideNode, slot: usize) -> u32 {
        let (near_x, far_x) = self.slab(simd, group, node, slot, 0);
        let (near_y, far_y) = self.slab(simd, group, node, slot, 1);
        let (near_z, far_z) = self.slab(simd, group, node, slot, 2);
        let t_min = load(simd, &self.coherent.t_min, group);
        let farthest = load(simd, &self.farthest, group);
        let enter = simd.max(near_x, simd.max(near_y, simd.max(near_z, t_min)));
        let leave = simd.min(far_x, simd.min(far_y, simd.min(far_z, farthest)));
        simd.less_or_equal(enter, leave)
    }

    #[inline(always)]
    fn slab<S: Simd>(&self, simd: S, group: usize, node: &WideNode, slot: usize, axis: usize) -> (S::F32x8, S::F32x8) {
        let side = (self.coherent.signs >> axis & 1) as usize;
        let (near, far) = (simd.splat(node.planes[axis][side][slot]), simd.splat(node.planes[axis][side ^ 1][slot]));
        let inverse = load(simd, &self.inverse[axis], group);
        (
            simd.mul_sub(near, inverse, load(simd, &self.near_offset[axis], group)),
            simd.mul_sub(far, inverse, load(simd, &self.far_offset[axis], group)),
        )
    }

    /// The leaf's triangles, one after the other, against a group's active rays. True if any ray's best hit changed.
    #[expect(clippy::too_many_arguments, reason = "all of it is the loop's state")]
    #[inline(always)]
    fn test_leaf<Q: Query, P: PrecisionMode, R, S: Simd>(
        &mut self,
        simd: S,
        group: usize,
        active: u32,
        leaf: &Leaf<'_>,
        child: Child,
        bvh: &WideBvh,
        sources: &[R; PACKET],
        best: &mut [ClosestHit; PACKET],
    ) -> bool
    where
        for<'r> &'r R: Into<Ray>,
    {
        let [kx, ky, kz] = self.coherent.axes;
        let origin = |axis: usize| load(simd, &self.coherent.origin[axis % 3], group);
        let origin = [origin(kx), origin(ky), origin(kz)];
        let (shear_x, shear_y) = (load(simd, &self.shear[0], group), load(simd, &self.shear[1], group));
        let inverse_depth = load(simd, &self.inverse[kz % 3], group);
        let t_min = load(simd, &self.coherent.t_min, group);
        let mut is_changed = false;
        for lane in 0..child.triangles().1 {
            let z = from_origin(simd, leaf, kz, lane, origin[2]);
            let x = shear(simd, from_origin(simd, leaf, kx, lane, origin[0]), shear_x, z);
            let y = shear(simd, from_origin(simd, leaf, ky, lane, origin[1]), shear_y, z);
            let sheared = [x, y, z];
            let weights = weights(simd, &sheared);
            let signs = Signs::of::<P, S>(simd, &sheared, &weights, self.edge_slack);
            let candidates = active & !signs.differ;
            if candidates == 0 {
                continue;
            }
            let spans = spans::<P, S>(simd, &sheared, &weights, signs, inverse_depth);
            let mut left = candidates & spans.within(simd, t_min, load(simd, &self.farthest, group));
            let (from, to) = (simd.store(spans.from), simd.store(spans.to));
            is_changed |= left != 0;
            while left != 0 {
                let of_group = left.trailing_zeros() as usize % LANES;
                left &= left - 1;
                let index = (group * LANES + of_group) % PACKET;
                let (from, to) = (from[of_group], to[of_group]);
                let is_certain = spans.certain >> of_group & 1 == 1;
                if is_certain && from >= self.coherent.t_min[index] && to < self.nearest[index] {
                    self.pending[index] = Some((lane as u32, child));
                    (self.nearest[index], self.farthest[index]) = (from, to);
                } else {
                    self.settle::<P, R>(index, bvh, &sources[index], &mut best[index]);
                    let triangle = leaf.triangle(lane);
                    let interval = Interval { t_min: self.coherent.t_min[index], t_max: best[index].t };
                    let ray = TriangleRay::new(&(&sources[index]).into());
                    if let Some(hit) = ray.hit::<P>(&triangle, interval) {
                        best[index].improve::<P>(&ray, &hit, &triangle);
                    }
                    (self.nearest[index], self.farthest[index]) = (best[index].t, best[index].t);
                }
                if Q::FIRST_HIT_ENDS && (self.pending[index].is_some() || best[index].found().is_some()) {
                    (self.nearest[index], self.farthest[index]) = (f32::NEG_INFINITY, f32::NEG_INFINITY);
                }
            }
        }
        is_changed
    }

    /// As [`Rays::settle`] for a group, as far as one evaluation is enough.
    #[inline(always)]
    fn settle_group<P: PrecisionMode>(&mut self, group: usize, bvh: &WideBvh, best: &mut [ClosestHit; PACKET]) {
        let axes = self.coherent.axes;
        let first = group % GROUPS * LANES;
        let values = |row: &Row| *row[first..].first_chunk().expect("a whole group");
        let Coherent { origin, direction, .. } = self.coherent;
        let [kx, ky, kz] = axes.map(|axis| axis % 3);
        let mut lanes = HitLanes::of_rays(
            [values(&origin[kx]), values(&origin[ky]), values(&origin[kz])],
            [values(&direction[kx]), values(&direction[ky]), values(&direction[kz])],
        );
        for of_group in 0..LANES {
            let index = (group * LANES + of_group) % PACKET;
            if let Some((lane, child)) = self.pending[index] {
                let triangle = bvh.leaves.leaf(child.triangles()).triangle(lane as usize % LANES);
                lanes.set_triangle(of_group, axes, &triangle);
                best[index].primitive = triangle;
            }
        }
        let hits = lanes.evaluate::<P>();
        for of_group in 0..LANES {
            let index = (group * LANES + of_group) % PACKET;
            if self.pending[index].is_some()
                && let Some(hit) = settled(&hits, of_group)
            {
                self.pending[index] = None;
                best[index] = ClosestHit { t: hit.t, u: hit.u, v: hit.v, ..best[index] };
            }
        }
    }

    /// Evaluates the best hit where that was put off.
    #[inline(always)]
    fn settle<P: PrecisionMode, R>(&mut self, index: usize, bvh: &WideBvh, source: &R, best: &mut ClosestHit)
    where
        for<'r> &'r R: Into<Ray>,
    {
        let Some((lane, child)) = self.pending[index].take() else { return };
        let triangle = bvh.leaves.leaf(child.triangles()).triangle(lane as usize % LANES);
        let interval = Interval { t_min: self.coherent.t_min[index], t_max: f32::INFINITY };
        if let Some(hit) = TriangleRay::new(&source.into()).hit::<P>(&triangle, interval) {
            *best = ClosestHit { t: hit.t, u: hit.u, v: hit.v, primitive: triangle };
        }
    }
}

#[inline(always)]
fn from_origin<S: Simd>(simd: S, leaf: &Leaf<'_>, axis: usize, lane: usize, origin: S::F32x8) -> Corners<S> {
    let [a, b, c] = leaf.corners(axis, lane);
    [simd.sub(simd.splat(a), origin), simd.sub(simd.splat(b), origin), simd.sub(simd.splat(c), origin)]
}

impl<S: Simd> Beam<S> {
    #[inline(always)]
    fn new(simd: S, bvh: &WideBvh, coherent: &Coherent) -> Self {
        let [x, y, z] = coherent.origin_ends;
        let (lower, upper) = (Vec3::new(x[0], y[0], z[0]), Vec3::new(x[1], y[1], z[1]));
        let reach = bvh.bounds.reach_from(lower).max(bvh.bounds.reach_from(upper));
        let slack_distance = gamma(24) * reach + f32::MIN_POSITIVE;
        let [t_min, _] = ends(simd, &coherent.t_min);
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
    fn test(&self, simd: S, node: &WideNode, t_max: f32) -> (u32, S::F32x8) {
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
