//! What a leaf holds against a ray, and the best hit so far; and the test of triangles, eight at once.
//!
//! `f32` refuses most triangles, by their edge functions and by bounds of `t` that need no division: the least and the
//! greatest `z / dz` of the vertices. What is left is evaluated at once.

use glam::{Vec4, Vec4Swizzles};

use super::WideBvh;
use super::leaves::{LeafForm, LeafRows, LeafTriangles, TriangleForm};
use super::node::Child;
use super::spans::{Corners, shear, size_across, weights};
use crate::accel::Primitive;
use crate::accel::leaf::{ClosestHit, Query};
use crate::geometry::{
    BEHIND, Evaluation, Interval, PrecisionMode, Ray, TriangleHit, TriangleRay, edge_slack, edges, in_floats,
    least_doubt,
};
use crate::math::UNIT_ROUNDOFF;
use crate::simd::{Eight, LANES, Simd};

/// A ray made ready for what leaves of a form hold.
pub(crate) trait LeafTest<'a, F: LeafForm>: Sized {
    fn new<P: PrecisionMode>(bvh: &'a WideBvh<F>, ray: &Ray) -> Self;

    /// For directions of unusual length, and rays from behind their origins.
    fn check_range(&mut self);

    fn t_min(&self) -> f32;

    /// The ray as the scalar test wants it.
    fn ray(&self) -> &<F::Primitive as Primitive>::Ray;

    /// What is not refused up to `t_max`, as bits. Must be `#[inline(always)]`.
    fn lanes<P: PrecisionMode, S: Simd>(&self, simd: S, child: Child, t_max: f32) -> u32;

    /// Keeps the best hit; `t_max` is that of the one before. True ends the query. Must be `#[inline(always)]`.
    fn test<Q: Query, P: PrecisionMode, S: Simd>(&self, simd: S, child: Child, t_max: f32, best: &mut Best) -> bool;
}

/// Eight triangles against a ray: the scalar test decides about those that are not refused here, and refuses all that
/// are.
pub(crate) struct TriangleTest<'a, F> {
    bvh: &'a WideBvh<F>,
    ray: TriangleRay,
    t_min: f32,
    /// See [`edge_slack`] and [`least_doubt`]; for exact decisions alone.
    edge_slack: [f32; 2],
}

/// The best hit so far.
#[derive(Clone, Copy)]
pub(crate) struct Best {
    /// While there is none, `t` is the ray's `t_max`.
    hit: TriangleHit,
    place: Place,
}

#[derive(Clone, Copy)]
pub(super) struct Place {
    leaf: Child,
    lane: u32,
}

impl Place {
    pub(super) fn new(leaf: Child, lane: u32) -> Self {
        Self { leaf, lane }
    }

    /// See [`LeafForm::primitive`].
    #[inline(always)]
    pub(super) fn primitive<F: LeafForm>(self, bvh: &WideBvh<F>) -> F::Primitive {
        bvh.leaves.primitive(self.leaf.triangles(), self.lane as usize)
    }
}

/// Triangles that the ray may hit between `t_min` and the best hit, as bits.
#[derive(Clone, Copy)]
struct Candidates {
    lanes: u32,
    /// Those of them that the scalar test surely takes, somewhere.
    sure: u32,
    /// Those that the ray surely meets after `t_min` and before the best hit, if they are taken.
    inside: u32,
}

impl Candidates {
    /// Whether one is hit for certain, whichever it is.
    #[inline(always)]
    fn are_hit(&self) -> bool {
        self.lanes & self.sure & self.inside != 0
    }
}

impl Best {
    /// Whatever lies in the interval is better, a hit at `t_max` itself too; a `t` beyond all floats is no hit.
    #[inline(always)]
    pub(super) fn none(ray: &Ray) -> Self {
        let t_max = if ray.t_max < f32::MAX { ray.t_max } else { f32::MAX };
        Self { hit: TriangleHit { t: t_max, u: 0.0, v: 0.0 }, place: Place { leaf: Child::NONE, lane: 0 } }
    }

    /// Beyond this nothing is better.
    #[inline(always)]
    pub(super) fn t_max(&self) -> f32 {
        self.hit.t
    }

    /// Keeps a hit of the ray at `t_max` or before it, if it is better.
    #[inline(always)]
    pub(super) fn improve<F: LeafForm, P: PrecisionMode>(
        &mut self,
        bvh: &WideBvh<F>,
        ray: &<F::Primitive as Primitive>::Ray,
        hit: TriangleHit,
        place: Place,
    ) {
        if hit.t < self.hit.t || precedes::<F, P>(bvh, ray, place, self.place) {
            *self = Self { hit, place };
        }
    }

    /// With its primitive.
    #[inline(always)]
    pub(super) fn found<F: LeafForm>(&self, bvh: &WideBvh<F>) -> Option<ClosestHit<F::Primitive>> {
        if self.place.leaf == Child::NONE {
            return None;
        }
        let TriangleHit { t, u, v } = self.hit;
        Some(bvh.leaves.resolve(ClosestHit { t, u, v, primitive: self.place.primitive(bvh) }))
    }
}

/// Hits of a leaf's triangles, evaluated together.
struct Together {
    /// Those that have one.
    settled: u32,
    /// Those of them that [end behind the origin](TriangleRay::ends_behind).
    behind: u32,
    t: [f32; LANES],
    u: [f32; LANES],
    v: [f32; LANES],
}

impl Together {
    const NONE: Self = Self { settled: 0, behind: 0, t: [0.0; LANES], u: [0.0; LANES], v: [0.0; LANES] };

    #[inline(always)]
    fn evaluation(&self, lane: u32) -> Evaluation {
        if self.behind >> lane & 1 != 0 {
            return Evaluation::Behind;
        }
        let lane = lane as usize % LANES;
        Evaluation::Inside(TriangleHit { t: self.t[lane], u: self.u[lane], v: self.v[lane] })
    }
}

impl<'a, F: TriangleForm> LeafTest<'a, F> for TriangleTest<'a, F> {
    #[inline(always)]
    fn new<P: PrecisionMode>(bvh: &'a WideBvh<F>, ray: &Ray) -> Self {
        let slack = if P::IS_EXACT { edge_slack(reach_from(&bvh.corners, ray)) } else { 0.0 };
        Self { bvh, ray: TriangleRay::new(ray), t_min: ray.t_min, edge_slack: [slack, least_doubt(slack)] }
    }

    /// For directions so short that `1 / dz` overflows: its bounds of `t` then decide nothing, being NaN. Nor must they where `t`
    /// may be negative: whether a triangle behind the origin is hit depends on its `t` (see `TriangleRay::ends_behind`). A `t`
    /// before all floats is no hit.
    #[inline(always)]
    fn check_range(&mut self) {
        self.t_min = self.t_min.max(f32::MIN);
        if self.ray.per_z[3].is_infinite() || self.t_min < 0.0 {
            self.ray.per_z[3] = f32::NAN;
        }
    }

    #[inline(always)]
    fn t_min(&self) -> f32 {
        self.t_min
    }

    #[inline(always)]
    fn ray(&self) -> &TriangleRay {
        &self.ray
    }

    #[inline(always)]
    fn lanes<P: PrecisionMode, S: Simd>(&self, simd: S, child: Child, t_max: f32) -> u32 {
        self.candidates::<P, S>(simd, child, t_max).lanes
    }

    #[inline(always)]
    fn test<Q: Query, P: PrecisionMode, S: Simd>(&self, simd: S, child: Child, t_max: f32, best: &mut Best) -> bool {
        let candidates = self.candidates::<P, S>(simd, child, t_max);
        (Q::FIRST_HIT_ENDS && candidates.are_hit()) || self.choose::<Q, P, S>(simd, child, candidates, best)
    }
}

impl<F: TriangleForm> TriangleTest<'_, F> {
    /// Keeps the best hit. True ends the query.
    #[inline(always)]
    fn choose<Q: Query, P: PrecisionMode, S: Simd>(
        &self,
        simd: S,
        child: Child,
        candidates: Candidates,
        best: &mut Best,
    ) -> bool {
        let mut left = candidates.lanes;
        let in_floats = if P::IS_IN_FLOATS && !Q::FIRST_HIT_ENDS && left & candidates.sure != 0 {
            self.evaluate_together(simd, child, left & candidates.sure)
        } else {
            Together::NONE
        };
        while left != 0 {
            let lane = left.trailing_zeros();
            left &= left - 1;
            let interval = Interval { t_min: self.t_min, t_max: best.hit.t };
            let place = Place::new(child, lane);
            let is_sure = candidates.sure >> lane & 1 != 0;
            // Each hit is kept where it is found: one place for all would have them come through memory, piece by piece, and be
            // loaded as a whole.
            let ends = match if !is_sure {
                None
            } else if P::IS_IN_FLOATS && in_floats.settled >> lane & 1 != 0 {
                Some(in_floats.evaluation(lane))
            } else {
                self.evaluate::<P, S>(simd, place)
            } {
                Some(Evaluation::Inside(hit)) => interval.contains(hit.t) && self.keep::<Q, P>(hit, place, best),
                Some(Evaluation::Behind) => false,
                Some(Evaluation::Near { hit, t, t_error, .. }) => {
                    match self.hit_near::<P>(place, (hit, t, t_error), interval) {
                        Some(hit) => self.keep::<Q, P>(hit, place, best),
                        None => false,
                    }
                }
                _ => match self.hit::<P>(place, interval) {
                    Some(hit) => self.keep::<Q, P>(hit, place, best),
                    None => false,
                },
            };
            if ends {
                return true;
            }
        }
        false
    }

    /// Those that the line of the ray may hit, if any, somewhere between `t_min` and `t_max`.
    ///
    /// A triangle is refused where the signs of its edge functions differ: a difference of rounded products is zero or
    /// has the right sign. Where they agree and none is zero it is taken for sure. For exact decisions both take signs beyond doubt.
    ///
    /// A hit's `t` is an average of the vertices' `z / dz`. Those make three roundings; `t` itself rounds once, and may
    /// leave their range by less than 2^-30 of the largest (`evaluation.rs`). Twice that is allowed for, and underflow.
    ///
    /// A NaN fails all comparisons: the triangle then is neither refused nor sure, nor surely inside. One among the edge functions
    /// is passed over by `min` and `max`; the others refuse all the same, and nothing is sure where one was.
    #[inline(always)]
    fn candidates<P: PrecisionMode, S: Simd>(&self, simd: S, child: Child, t_max: f32) -> Candidates {
        let leaf = self.bvh.leaves.leaf(child.triangles());
        let rows = leaf.unpacked(simd);
        let ray = &self.ray;
        let [kx, ky, kz] = ray.axes;
        let z = from_origin(simd, &rows, kz, simd.splat(ray.origin[2]));
        let x = from_origin(simd, &rows, kx, simd.splat(ray.origin[0]));
        let y = from_origin(simd, &rows, ky, simd.splat(ray.origin[1]));
        let eight = Eight(simd);
        let x = shear(eight, x, simd.splat(ray.per_z[0]), z);
        let y = shear(eight, y, simd.splat(ray.per_z[1]), z);
        let [a, b, c] = weights(eight, &[x, y, z]);
        let zero = simd.splat(0.0);
        // A NaN may lose a sign here, which refuses less.
        let (least, most) = (simd.min(a, simd.min(b, c)), simd.max(a, simd.max(b, c)));
        let doubt = if P::IS_EXACT {
            let [slack, least_doubt] = self.edge_slack.map(|slack| simd.splat(slack));
            simd.mul_add(size_across(eight, &x, &y), slack, least_doubt)
        } else {
            zero
        };
        let refused = simd.less(least, simd.sub(zero, doubt)) & simd.less(doubt, most);
        let mut lanes = leaf.mask() & !refused;
        if lanes == 0 {
            return Candidates { lanes, sure: 0, inside: 0 };
        }
        let sure = simd.less(doubt, least) | simd.less(most, simd.sub(zero, doubt));
        let per_z = simd.splat(ray.per_z[3]);
        let t = [simd.mul(z[0], per_z), simd.mul(z[1], per_z), simd.mul(z[2], per_z)];
        let (first, last) = (simd.min(t[0], simd.min(t[1], t[2])), simd.max(t[0], simd.max(t[1], t[2])));
        let reach = simd.max(last, simd.sub(zero, first));
        let slack = simd.mul_add(reach, simd.splat(10.0 * UNIT_ROUNDOFF), simd.splat(f32::MIN_POSITIVE));
        let (first, last) = (simd.sub(first, slack), simd.add(last, slack));
        let (t_min, t_max) = (simd.splat(self.t_min), simd.splat(t_max));
        lanes &= !(simd.less(last, t_min) | simd.less(t_max, first));
        // Where edge functions overflow they may have made a NaN, which nothing above keeps.
        let overflow = simd.mul(simd.add(a, simd.add(b, c)), zero);
        let sure = sure & simd.less_or_equal(overflow, zero);
        let inside = simd.less_or_equal(t_min, first) & simd.less_or_equal(last, t_max);
        Candidates { lanes, sure, inside }
    }

    /// True ends the query.
    #[inline(always)]
    fn keep<Q: Query, P: PrecisionMode>(&self, hit: TriangleHit, place: Place, best: &mut Best) -> bool {
        if !Q::FIRST_HIT_ENDS {
            best.improve::<F, P>(self.bvh, &self.ray, hit, place);
        }
        Q::FIRST_HIT_ENDS
    }

    /// For a triangle that is certainly hit somewhere.
    #[inline(always)]
    fn evaluate<P: PrecisionMode, S: Simd>(&self, simd: S, place: Place) -> Option<Evaluation> {
        let [kx, ky, kz] = self.ray.axes;
        let (leaf, lane) = (self.leaf(place), place.lane as usize);
        let corners = [leaf.corners(kx, lane), leaf.corners(ky, lane), leaf.corners(kz, lane)];
        P::evaluate_certain(simd, &self.ray, &corners, self.t_min)
    }

    /// All triangles of a leaf; whether those that are not wanted end behind the origin is left open.
    #[inline(always)]
    fn evaluate_together<S: Simd>(&self, simd: S, child: Child, wanted: u32) -> Together {
        let leaf = self.bvh.leaves.leaf(child.triangles());
        let rows = leaf.unpacked(simd);
        let ray = &self.ray;
        let eight = Eight(simd);
        let [kx, ky, kz] = ray.axes;
        // What is beside the wanted ones may be denormal, which CPUs take a hundred times as long to multiply.
        let [x0, x1] = wanted_edges(simd, &rows, kx, wanted);
        let [y0, y1] = wanted_edges(simd, &rows, ky, wanted);
        let [z0, z1] = wanted_edges(simd, &rows, kz, wanted);
        let z = from_origin(simd, &rows, kz, simd.splat(ray.origin[2]));
        let from_x = from_origin(simd, &rows, kx, simd.splat(ray.origin[0]));
        let from_y = from_origin(simd, &rows, ky, simd.splat(ray.origin[1]));
        let x = shear(eight, from_x, simd.splat(ray.per_z[0]), z);
        let y = shear(eight, from_y, simd.splat(ray.per_z[1]), z);
        let weights = weights(eight, &[x, y, z]);
        let [t, u, v] =
            in_floats(eight, ray, [[x0, x1], [y0, y1], [z0, z1]], [from_x[0], from_y[0], z[0]], &weights, &z);
        let mut behind = 0;
        for (axis, [a, b, c]) in [from_x, from_y, z].into_iter().enumerate() {
            let (zero, direction) = (simd.splat(0.0), ray.direction[axis]);
            let of_axis = if direction < 0.0 {
                simd.less(zero, simd.min(a, simd.min(b, c)))
            } else {
                simd.less(simd.max(a, simd.max(b, c)), zero)
            };
            if of_axis & wanted != 0 {
                behind |= of_axis & within_band(simd, [a, b, c], 1.0 / direction);
            }
        }
        let most = simd.splat(f32::MAX);
        let settled = simd.less_or_equal(simd.abs(t), most)
            & simd.less_or_equal(simd.abs(u), most)
            & simd.less_or_equal(simd.abs(v), most);
        let behind = behind & simd.less_or_equal(simd.splat(0.0), t);
        Together { settled, behind, t: simd.store(t), u: simd.store(u), v: simd.store(v) }
    }

    #[inline(always)]
    fn leaf(&self, place: Place) -> F::Leaf<'_> {
        self.bvh.leaves.leaf(place.leaf.triangles())
    }

    #[cold]
    #[inline(never)]
    fn hit_near<P: PrecisionMode>(
        &self,
        place: Place,
        near: (TriangleHit, f64, f64),
        interval: Interval,
    ) -> Option<TriangleHit> {
        self.ray.hit_near::<P>(&self.leaf(place).triangle(place.lane as usize), near, interval)
    }

    #[cold]
    #[inline(never)]
    fn hit<P: PrecisionMode>(&self, place: Place, interval: Interval) -> Option<TriangleHit> {
        self.ray.hit::<P>(&self.leaf(place).triangle(place.lane as usize), interval)
    }
}

/// Those of which a coordinate of all vertices, from the origin, is [close behind it](crate::geometry::BEHIND); none of a ray that
/// does not leave along the axis.
#[inline(always)]
fn within_band<S: Simd>(simd: S, [a, b, c]: Corners<Eight<S>>, inverse: f32) -> u32 {
    if !inverse.is_finite() {
        return 0;
    }
    let inverse = simd.splat(inverse);
    let (a, b, c) = (simd.mul(a, inverse), simd.mul(b, inverse), simd.mul(c, inverse));
    simd.less(simd.max(a, simd.max(b, c)), simd.splat(BEHIND))
}

#[cold]
#[inline(never)]
fn precedes<F: LeafForm, P: PrecisionMode>(
    bvh: &WideBvh<F>,
    ray: &<F::Primitive as Primitive>::Ray,
    a: Place,
    b: Place,
) -> bool {
    b.leaf == Child::NONE || a.primitive(bvh).precedes::<P>(&b.primitive(bvh), ray)
}

/// The largest distance along an axis from the ray's origin to a corner of the scene.
#[inline(always)]
fn reach_from([lower, upper]: &[Vec4; 2], ray: &Ray) -> f32 {
    let origin = ray.origin.extend(0.0);
    let reach = (*upper - origin).max(origin - *lower);
    reach.max(reach.yzzz()).max(reach.zzzz()).x
}

/// The edges of the wanted triangles along an axis; 0 of the others.
#[inline(always)]
fn wanted_edges<S: Simd>(simd: S, leaf: &impl LeafRows, axis: usize, wanted: u32) -> [S::F32x8; 2] {
    let [first, second] = edges(Eight(simd), &load(simd, leaf, axis));
    let zero = simd.splat(0.0);
    [simd.blend(zero, first, wanted), simd.blend(zero, second, wanted)]
}

#[inline(always)]
fn load<S: Simd>(simd: S, leaf: &impl LeafRows, axis: usize) -> Corners<Eight<S>> {
    let [a, b, c] = leaf.rows(axis);
    [simd.load(a), simd.load(b), simd.load(c)]
}

#[inline(always)]
fn from_origin<S: Simd>(simd: S, leaf: &impl LeafRows, axis: usize, origin: S::F32x8) -> Corners<Eight<S>> {
    let [a, b, c] = load(simd, leaf, axis);
    [simd.sub(a, origin), simd.sub(b, origin), simd.sub(c, origin)]
}
