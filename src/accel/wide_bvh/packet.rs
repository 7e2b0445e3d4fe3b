//! Rays that go the same way, together: a node's eight boxes against all of them at once, as one beam; at a leaf its
//! box, then each triangle, against eight rays at a time.
//!
//! Source: Wald, Boulos, Shirley 2007, "Ray tracing deformable scenes using dynamic bounding volume hierarchies",
//! section 4, for the interval test.

use std::marker::PhantomData;

use arrayvec::ArrayVec;
use glam::Vec3A;

use super::WideBvh;
use super::leaf_test::Corners;
use super::leaves::{Leaf, LeafTriangles};
use super::node::{Child, WideNode};
use super::wavefront::{Signs, is_fit, shear, spans, weights};
use crate::accel::bvh::node::MOST_LEVELS;
use crate::accel::leaf::{ClosestHit, Query};
use crate::geometry::{Aabb, HITS, HitLanes, Interval, PrecisionMode, Ray, TriangleRay, edge_slack, settled};

use crate::math::gamma;
use crate::simd::{LANES, Simd, SimdKernel, prefetch};

/// How many rays make a packet.
pub(super) const PACKET: usize = 64;
const GROUPS: usize = PACKET / LANES;
const _: () = assert!(HITS == LANES);

/// The widest difference of two directions along an axis, in lengths of the largest component.
const MOST_SPREAD: f32 = 0.25;
/// The widest difference of two origins along an axis, in lengths of the scene's largest side.
const MOST_DISTANCE: f32 = 1.0 / 64.0;

/// A packet whose leaves are each met by fewer rays than this on average is given up after so many leaves: rays one by
/// one test a leaf's triangles at once, too.
const LEAST_RAYS: u32 = 6;
const TRIAL_LEAVES: u32 = 8;

/// What the rays of a packet lie between.
#[derive(Clone, Copy)]
pub(super) struct Spread {
    origin: [Vec3A; 2],
    direction: [Vec3A; 2],
    signs: u32,
    axes: [usize; 3],
}

impl Spread {
    /// Of rays that go the same way: the signs and the largest component agree, and little else differs.
    pub(super) fn of_packet<R>(rays: &[R; PACKET], bounds: &Aabb) -> Option<Self>
    where
        for<'r> &'r R: Into<Ray>,
    {
        let first: Ray = (&rays[0]).into();
        if !is_fit(&first) {
            return None;
        }
        let signs = Vec3A::from(first.direction).is_negative_bitmask();
        let extent = (bounds.upper - bounds.lower).max_element();
        let mut spread = Self {
            origin: [Vec3A::INFINITY, Vec3A::NEG_INFINITY],
            direction: [Vec3A::INFINITY, Vec3A::NEG_INFINITY],
            signs,
            axes: TriangleRay::new(&first).axes,
        };
        // The last first: it settles most refusals.
        for index in [PACKET - 1].into_iter().chain(0..PACKET) {
            let ray: Ray = (&rays[index]).into();
            let (origin, direction) = (Vec3A::from(ray.origin), Vec3A::from(ray.direction));
            let lengths = direction.abs();
            let is_like = is_fit(&ray)
                && direction.is_negative_bitmask() == signs
                && lengths.max_element() == lengths[spread.axes[2]];
            if !is_like {
                return None;
            }
            spread.origin = [spread.origin[0].min(origin), spread.origin[1].max(origin)];
            spread.direction = [spread.direction[0].min(direction), spread.direction[1].max(direction)];
            if index % 8 == 0 || index == PACKET - 1 {
                let across = (spread.direction[1] - spread.direction[0]).max_element();
                let apart = (spread.origin[1] - spread.origin[0]).max_element();
                if across > MOST_SPREAD * lengths.max_element() || apart > MOST_DISTANCE * extent {
                    return None;
                }
            }
        }
        Some(spread)
    }
}

/// One value a ray.
type Row = [f32; PACKET];

/// A packet as a kernel.
pub(super) struct Packet<'b, 'p, Q, P, R, T, A> {
    bvh: &'b WideBvh,
    rays: &'p [R; PACKET],
    spread: &'p Spread,
    places: &'p mut [T],
    answer: &'p A,
    choices: PhantomData<(Q, P)>,
}

impl<'b, 'p, Q, P, R, T, A> Packet<'b, 'p, Q, P, R, T, A> {
    pub(super) fn new(
        bvh: &'b WideBvh,
        rays: &'p [R; PACKET],
        spread: &'p Spread,
        places: &'p mut [T],
        answer: &'p A,
    ) -> Self {
        Self { bvh, rays, spread, places, answer, choices: PhantomData }
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

/// The rays, value by value.
struct Rays {
    inverse: [Row; 3],
    near_offset: [Row; 3],
    far_offset: [Row; 3],
    /// In the order of the packet's axes, as are the next.
    origin: [Row; 3],
    shear: [Row; 2],
    inverse_depth: Row,
    t_min: Row,
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
        let Self { bvh, rays: sources, spread, places, answer, .. } = self;
        let mut best: [ClosestHit; PACKET] = [ClosestHit::none(&(&sources[0]).into()); PACKET];
        let mut rays = Rays::new::<P, R>(bvh, sources, spread, &mut best);
        let beam = Beam::new(simd, bvh, spread, &rays);
        let mut t_max = rays.farthest_of_all(simd);
        let mut stack = Stack::new_const();
        let (mut leaf_count, mut ray_count) = (0, 0);
        let mut next = Some(Pending { enter: 0.0, child: bvh.root, parent: 0, slot: LANES as u32 });
        while let Some(current) = next {
            if current.child.is_leaf() {
                let leaf = bvh.leaves.leaf(current.child.triangles());
                let planes = bvh.nodes.get(current.parent as usize).filter(|_| current.slot < LANES as u32);
                let mut is_changed = false;
                leaf_count += 1;
                if leaf_count >= TRIAL_LEAVES && ray_count < LEAST_RAYS * leaf_count {
                    return false;
                }
                for group in 0..GROUPS {
                    let active = match planes {
                        Some(node) => rays.meet(simd, group, node, current.slot as usize % LANES, spread.signs),
                        None => 0xFF,
                    };
                    if active != 0 {
                        ray_count += active.count_ones();
                        is_changed |= rays.test_leaf::<Q, P, R, S>(
                            simd,
                            group,
                            active,
                            &leaf,
                            current.child,
                            spread,
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
                rays.settle_group::<P, R>(group, bvh, sources, &mut best);
            }
        }
        for (index, place) in places.iter_mut().enumerate().take(PACKET) {
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

impl Rays {
    #[inline(always)]
    fn new<P: PrecisionMode, R>(
        bvh: &WideBvh,
        sources: &[R; PACKET],
        spread: &Spread,
        best: &mut [ClosestHit; PACKET],
    ) -> Self
    where
        for<'r> &'r R: Into<Ray>,
    {
        let row = [0.0; PACKET];
        let mut rays = Self {
            inverse: [row; 3],
            near_offset: [row; 3],
            far_offset: [row; 3],
            origin: [row; 3],
            shear: [row; 2],
            inverse_depth: row,
            t_min: row,
            nearest: row,
            farthest: row,
            pending: [None; PACKET],
            edge_slack: 0.0,
        };
        let (lower, upper) = (Vec3A::from(bvh.bounds.lower), Vec3A::from(bvh.bounds.upper));
        let [kx, ky, kz] = spread.axes;
        for (index, source) in sources.iter().enumerate() {
            let ray: Ray = source.into();
            let (origin, direction) = (Vec3A::from(ray.origin), Vec3A::from(ray.direction));
            let inverse = Vec3A::ONE / direction;
            // As `ObliqueSlabs`.
            let reach = (upper - origin).max(origin - lower).max_element();
            if P::IS_EXACT {
                rays.edge_slack = rays.edge_slack.max(edge_slack(reach));
            }
            let slack_distance = gamma(24) * reach + f32::MIN_POSITIVE;
            let offset = origin * inverse;
            let slack = inverse.abs() * slack_distance + offset.abs() * gamma(4);
            let (near, far) = (offset + slack, offset - slack);
            for axis in 0..3 {
                rays.inverse[axis][index] = inverse[axis];
                rays.near_offset[axis][index] = near[axis];
                rays.far_offset[axis][index] = far[axis];
            }
            rays.origin[0][index] = origin[kx];
            rays.origin[1][index] = origin[ky];
            rays.origin[2][index] = origin[kz];
            rays.shear[0][index] = direction[kx] / direction[kz];
            rays.shear[1][index] = direction[ky] / direction[kz];
            rays.inverse_depth[index] = inverse[kz];
            rays.t_min[index] = ray.t_min;
            rays.nearest[index] = ray.t_max;
            rays.farthest[index] = ray.t_max;
            best[index] = ClosestHit::none(&ray);
        }
        rays
    }

    #[inline(always)]
    fn load<S: Simd>(simd: S, row: &Row, group: usize) -> S::F32x8 {
        let at = group % GROUPS * LANES;
        simd.load(row[at..].first_chunk().expect("a whole group"))
    }

    /// No ray still looks beyond this.
    #[inline(always)]
    fn farthest_of_all<S: Simd>(&self, simd: S) -> f32 {
        let mut most = simd.splat(f32::NEG_INFINITY);
        for group in 0..GROUPS {
            most = simd.max(Self::load(simd, &self.farthest, group), most);
        }
        simd.store(most).into_iter().fold(f32::NEG_INFINITY, |a, b| if a > b { a } else { b })
    }

    /// Which rays of a group meet a slot's box.
    #[inline(always)]
    fn meet<S: Simd>(&self, simd: S, group: usize, node: &WideNode, slot: usize, signs: u32) -> u32 {
        let (near_x, far_x) = self.slab(simd, group, node, slot, signs, 0);
        let (near_y, far_y) = self.slab(simd, group, node, slot, signs, 1);
        let (near_z, far_z) = self.slab(simd, group, node, slot, signs, 2);
        let t_min = Self::load(simd, &self.t_min, group);
        let farthest = Self::load(simd, &self.farthest, group);
        let enter = simd.max(near_x, simd.max(near_y, simd.max(near_z, t_min)));
        let leave = simd.min(far_x, simd.min(far_y, simd.min(far_z, farthest)));
        simd.less_or_equal(enter, leave)
    }

    #[inline(always)]
    fn slab<S: Simd>(
        &self,
        simd: S,
        group: usize,
        node: &WideNode,
        slot: usize,
        signs: u32,
        axis: usize,
    ) -> (S::F32x8, S::F32x8) {
        let side = (signs >> axis & 1) as usize;
        let (near, far) = (simd.splat(node.planes[axis][side][slot]), simd.splat(node.planes[axis][side ^ 1][slot]));
        let inverse = Self::load(simd, &self.inverse[axis], group);
        (
            simd.mul_sub(near, inverse, Self::load(simd, &self.near_offset[axis], group)),
            simd.mul_sub(far, inverse, Self::load(simd, &self.far_offset[axis], group)),
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
        spread: &Spread,
        bvh: &WideBvh,
        sources: &[R; PACKET],
        best: &mut [ClosestHit; PACKET],
    ) -> bool
    where
        for<'r> &'r R: Into<Ray>,
    {
        let [kx, ky, kz] = spread.axes;
        let origin = [0, 1, 2].map(|axis| Self::load(simd, &self.origin[axis], group));
        let (shear_x, shear_y) = (Self::load(simd, &self.shear[0], group), Self::load(simd, &self.shear[1], group));
        let inverse_depth = Self::load(simd, &self.inverse_depth, group);
        let t_min = Self::load(simd, &self.t_min, group);
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
            let spans = spans(simd, &sheared, &weights, signs, inverse_depth);
            let mut left = candidates & spans.within(simd, t_min, Self::load(simd, &self.farthest, group));
            let (from, to) = (simd.store(spans.from), simd.store(spans.to));
            is_changed |= left != 0;
            while left != 0 {
                let of_group = left.trailing_zeros() as usize % LANES;
                left &= left - 1;
                let index = (group * LANES + of_group) % PACKET;
                let (from, to) = (from[of_group], to[of_group]);
                let is_certain = spans.certain >> of_group & 1 == 1;
                if is_certain && from >= self.t_min[index] && to < self.nearest[index] {
                    self.pending[index] = Some((lane as u32, child));
                    (self.nearest[index], self.farthest[index]) = (from, to);
                } else {
                    self.settle::<P, R>(index, bvh, &sources[index], &mut best[index]);
                    let triangle = leaf.triangle(lane);
                    let interval = Interval { t_min: self.t_min[index], t_max: best[index].t };
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
    fn settle_group<P: PrecisionMode, R>(
        &mut self,
        group: usize,
        bvh: &WideBvh,
        sources: &[R; PACKET],
        best: &mut [ClosestHit; PACKET],
    ) where
        for<'r> &'r R: Into<Ray>,
    {
        let mut lanes = HitLanes::EMPTY;
        for of_group in 0..LANES {
            let index = (group * LANES + of_group) % PACKET;
            if let Some((lane, child)) = self.pending[index] {
                let triangle = bvh.leaves.leaf(child.triangles()).triangle(lane as usize % LANES);
                lanes.set(of_group, &TriangleRay::new(&(&sources[index]).into()), &triangle);
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
        let interval = Interval { t_min: self.t_min[index], t_max: f32::INFINITY };
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
    fn new(simd: S, bvh: &WideBvh, spread: &Spread, rays: &Rays) -> Self {
        let [origin_lower, origin_upper] = spread.origin;
        let reach = bvh.bounds.reach_from(origin_lower.into()).max(bvh.bounds.reach_from(origin_upper.into()));
        let slack_distance = gamma(24) * reach + f32::MIN_POSITIVE;
        let t_min = rays.t_min.iter().fold(f32::INFINITY, |a, &b| a.min(b));
        let side = |axis: usize| (spread.signs >> axis & 1) as usize;
        let sign = |axis: usize| if side(axis) == 1 { -1.0 } else { 1.0 };
        let origin = |axis: usize| {
            let (a, b) = (sign(axis) * origin_lower[axis], sign(axis) * origin_upper[axis]);
            [simd.splat(a.max(b)), simd.splat(a.min(b))]
        };
        // The inverse of a rounded direction is monotonic, so its ends are those of the directions.
        let ends = |axis: usize| {
            let (a, b) = ((1.0 / spread.direction[0][axis]).abs(), (1.0 / spread.direction[1][axis]).abs());
            (a.min(b), a.max(b))
        };
        let inverse = |axis: usize| [simd.splat(ends(axis).0), simd.splat(ends(axis).1)];
        let slack = |axis: usize| simd.splat(slack_distance * ends(axis).1);
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
