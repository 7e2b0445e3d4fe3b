//! A leaf's eight triangles against a ray, and the best hit so far.
//!
//! Only the hit that wins is evaluated: before, `f32` arithmetic bounds each `t` from both sides, and the bounds mostly
//! tell which hit is nearer. Where they do not, the scalar test of `geometry/triangle_hit.rs` decides.

use std::hint::black_box;
use std::marker::PhantomData;

use super::WideBvh;
use super::leaves::{LeafForm, LeafTriangles};
use super::node::Child;
use crate::accel::leaf::{ClosestHit, Query};
use crate::geometry::{Interval, PrecisionMode, Ray, Triangle, TriangleHit, TriangleRay};
use crate::math::UNIT_ROUNDOFF;
use crate::simd::{LANES, Simd, SimdKernel};

/// Eight triangles against a ray: the scalar test decides about those that are not refused here, and refuses all that
/// are.
pub(super) struct LeafTest<'a, F, S: Simd> {
    exact: ExactTest<'a, F>,
    isa: PhantomData<S>,
}

/// What the scalar test needs.
#[derive(Clone, Copy)]
struct ExactTest<'a, F> {
    bvh: &'a WideBvh<F>,
    ray: &'a TriangleRay,
    interval: Interval,
}

/// A coordinate of the three vertices of eight triangles.
type Corners<S> = [<S as Simd>::F32x8; 3];

/// The best hit so far.
#[derive(Clone, Copy)]
pub(super) struct Best {
    /// Bounds of its `t`, equal once it has been evaluated; both the ray's `t_max` while there is none.
    low: f32,
    pub(super) high: f32,
    place: Place,
    state: State,
}

#[derive(Clone, Copy)]
struct Place {
    leaf: Child,
    lane: usize,
}

#[derive(Clone, Copy, PartialEq)]
enum State {
    None,
    Bounded,
    Evaluated(TriangleHit),
}

/// Triangles that the ray may hit.
struct Candidates {
    /// Which they are, as bits.
    lanes: u32,
    /// Those of them that the scalar test surely takes, where `low` and `high` are inside the ray's interval.
    sure: u32,
    /// Bounds of each `t`.
    low: [f32; LANES],
    high: [f32; LANES],
}

impl Best {
    #[inline(always)]
    pub(super) fn none(ray: &Ray) -> Self {
        Self { low: ray.t_max, high: ray.t_max, place: Place { leaf: Child::NONE, lane: 0 }, state: State::None }
    }
}

impl<'a, F: LeafForm, S: Simd> LeafTest<'a, F, S> {
    #[inline(always)]
    pub(super) fn new(_simd: S, bvh: &'a WideBvh<F>, ray: &'a TriangleRay, interval: Interval) -> Self {
        Self { exact: ExactTest { bvh, ray, interval }, isa: PhantomData }
    }

    /// Keeps the best hit. True ends the query.
    #[inline(always)]
    pub(super) fn test<Q: Query, P: PrecisionMode>(&self, simd: S, child: Child, best: &mut Best) -> bool {
        let leaf = self.exact.bvh.leaves.leaf(child.triangles()).unpacked(simd);
        let Some(candidates) = self.candidates(simd, &leaf) else { return false };
        let mut left = candidates.lanes;
        while left != 0 {
            let lane = left.trailing_zeros() as usize % LANES;
            left &= left - 1;
            let (low, high) = (candidates.low[lane], candidates.high[lane]);
            if high < self.exact.interval.t_min || low > best.high {
                continue;
            }
            let is_certain = candidates.sure & (1 << lane) != 0;
            if is_certain && low >= self.exact.interval.t_min && high < best.low {
                if Q::FIRST_HIT_ENDS {
                    return true;
                }
                *best = Best { low, high, place: Place { leaf: child, lane }, state: State::Bounded };
            } else {
                let place = Place { leaf: child, lane };
                if self.exact.decide::<Q, P, S>(simd, place, is_certain, best) {
                    return true;
                }
            }
        }
        false
    }

    /// Evaluates what is left.
    #[inline(always)]
    pub(super) fn finish<P: PrecisionMode>(&self, best: &Best) -> Option<ClosestHit> {
        self.exact.finish::<P>(best)
    }

    /// Those that the line of the ray may hit, if any.
    ///
    /// A triangle is refused where the signs of its edge functions differ: a difference of rounded products is zero or
    /// has the right sign. Where they agree and none is zero it is taken for sure. With `u = 2^-24`, `X`, `Y` and `Z`
    /// the largest magnitudes of its sheared coordinates, `B = X + Y`, `R = B + Z`, and `a`, `b`, `c` the edge functions:
    /// - The sheared coordinates are off by `d <= 2u |ax| + 4u |az| <= 6u R` (`triangle_hit.rs`, and `|ax| <= |x| +
    ///   |az|`), and so the edge functions, against those of the true ray, by at most `2d B + 2d^2` each, and by `2u X Y
    ///   <= u B^2 / 2` from their own roundings. Together less than `D = 40u R (B + 6u R)`; another term covers
    ///   underflow.
    /// - `t` is an average of the vertices' `z / dz` with the edge functions as weights. Wrong weights move it by at most
    ///   `D / (W - D)` of the range of `z`, `W = |a + b + c|`, or `2D / W` where that is less than 1; and never out of the
    ///   range.
    /// - The average itself makes less than 16 roundings, relative to `Z`; twice that is allowed for.
    ///
    /// A NaN fails all comparisons: the triangle then is neither refused nor sure.
    #[inline(always)]
    fn candidates(&self, simd: S, leaf: &F::Leaf<'_>) -> Option<Candidates> {
        // Else the compiler would prepare a register for each of these before the first leaf, only to spill it.
        let ray = black_box(self.exact.ray);
        let [kx, ky, kz] = ray.axes;
        let z = from_origin(simd, leaf, kz, simd.splat(ray.origin[kz & 3]));
        let x = from_origin(simd, leaf, kx, simd.splat(ray.origin[kx & 3]));
        let y = from_origin(simd, leaf, ky, simd.splat(ray.origin[ky & 3]));
        let x = shear(simd, x, simd.splat(ray.per_z[kx & 3]), z);
        let y = shear(simd, y, simd.splat(ray.per_z[ky & 3]), z);
        let a = edge(simd, x[2], y[1], y[2], x[1]);
        let b = edge(simd, x[0], y[2], y[0], x[2]);
        let c = edge(simd, x[1], y[0], y[1], x[0]);
        let zero = simd.splat(0.0);
        // A NaN may lose a sign here, which refuses less.
        let (least, most) = (simd.min(a, simd.min(b, c)), simd.max(a, simd.max(b, c)));
        let lanes = leaf.mask() & !(simd.less(least, zero) & simd.less(zero, most));
        if lanes == 0 {
            return None;
        }

        let reach_x = largest(simd, x);
        let reach_y = largest(simd, y);
        let (near, far) = (simd.min(z[0], simd.min(z[1], z[2])), simd.max(z[0], simd.max(z[1], z[2])));
        let reach_z = simd.max(far, simd.sub(zero, near));
        let broad = simd.add(reach_x, reach_y);
        let reach = simd.add(broad, reach_z);
        let u = |count: f32| simd.splat(count * UNIT_ROUNDOFF);
        let weights_error =
            simd.mul_add(simd.mul(reach, u(40.0)), simd.mul_add(reach, u(6.0), broad), simd.splat(f32::MIN_POSITIVE));
        let sum = simd.add(a, simd.add(b, c));
        let per_sum = simd.div(simd.splat(1.0), sum);
        let share = simd.mul(simd.add(weights_error, weights_error), simd.abs(per_sum));
        let weighted = simd.mul_add(a, z[0], simd.mul_add(b, z[1], simd.mul(c, z[2])));
        // An infinite sum makes a NaN.
        let rounding = simd.mul_add(sum, zero, simd.mul(reach_z, u(32.0)));
        let z_error = simd.mul_add(simd.sub(far, near), simd.min(share, simd.splat(1.0)), rounding);
        let per_z = simd.splat(ray.per_z[3]);
        let t = simd.mul(simd.mul(weighted, per_sum), per_z);
        let t_error = simd.mul(z_error, simd.abs(per_z));
        let (low, high) = (simd.sub(t, t_error), simd.add(t, t_error));
        let sure = simd.less(zero, least) | simd.less(most, zero);
        Some(Candidates { lanes, sure, low: simd.store(low), high: simd.store(high) })
    }
}

/// The hit of a triangle that is certainly hit somewhere.
struct Locate<'a, P, F> {
    exact: ExactTest<'a, F>,
    place: Place,
    interval: Interval,
    precision: PhantomData<P>,
}

impl<P: PrecisionMode, F: LeafForm> SimdKernel for Locate<'_, P, F> {
    type Output = Option<TriangleHit>;

    #[inline(always)]
    fn run<S: Simd>(self, _simd: S) -> Option<TriangleHit> {
        self.exact.certain_hit::<P>(self.place, self.interval)
    }
}

impl<F: LeafForm> ExactTest<'_, F> {
    /// For a triangle that is certainly hit somewhere.
    #[inline(always)]
    fn certain_hit<P: PrecisionMode>(&self, place: Place, interval: Interval) -> Option<TriangleHit> {
        let [kx, ky, kz] = self.ray.axes;
        let leaf = self.bvh.leaves.leaf(place.leaf.triangles());
        let corners = [leaf.corners(kx, place.lane), leaf.corners(ky, place.lane), leaf.corners(kz, place.lane)];
        self.ray.certain_hit::<P>(&corners, interval, || self.triangle(place))
    }

    #[inline(always)]
    fn evaluated<P: PrecisionMode>(&self, best: &Best) -> Option<TriangleHit> {
        match best.state {
            State::None => None,
            State::Evaluated(hit) => Some(hit),
            State::Bounded => {
                let line = Interval { t_min: f32::NEG_INFINITY, t_max: f32::INFINITY };
                Some(self.certain_hit::<P>(best.place, line).expect("edge functions of one sign make a hit"))
            }
        }
    }

    /// `f32` cannot tell whether this hit counts or is the better one. True ends the query.
    #[inline(always)]
    fn decide<Q: Query, P: PrecisionMode, S: Simd>(
        self,
        simd: S,
        candidate: Place,
        is_certain: bool,
        best: &mut Best,
    ) -> bool {
        let interval = Interval { t_min: self.interval.t_min, t_max: best.high };
        let hit = if is_certain && !Q::FIRST_HIT_ENDS {
            self.certain_hit::<P>(candidate, interval)
        } else if is_certain {
            // In a frame of its own: measured, any-hit rays lose a seventh where they leave from a surface and this is
            // inlined, and closest-hit rays lose as much where it is not.
            simd.vectorize(Locate::<P, F> { exact: self, place: candidate, interval, precision: PhantomData })
        } else {
            self.hit::<P>(candidate, interval)
        };
        let Some(hit) = hit else { return false };
        if Q::FIRST_HIT_ENDS {
            return true;
        }
        // A copy, so that the hot path has the best hit in registers.
        let mut decided = *best;
        self.keep_better::<P>(candidate, hit, &mut decided);
        *best = decided;
        false
    }

    #[inline(always)]
    fn triangle(&self, place: Place) -> Triangle {
        self.bvh.leaves.leaf(place.leaf.triangles()).triangle(place.lane)
    }

    #[cold]
    #[inline(never)]
    fn hit<P: PrecisionMode>(self, place: Place, interval: Interval) -> Option<TriangleHit> {
        self.ray.hit::<P>(&self.triangle(place), interval)
    }

    #[cold]
    #[inline(never)]
    fn keep_better<P: PrecisionMode>(self, candidate: Place, hit: TriangleHit, best: &mut Best) {
        if let Some(rival) = self.evaluated::<P>(best)
            && (rival.t, self.triangle(best.place).primitive_id) <= (hit.t, self.triangle(candidate).primitive_id)
        {
            (best.low, best.high, best.state) = (rival.t, rival.t, State::Evaluated(rival));
            return;
        }
        *best = Best { low: hit.t, high: hit.t, place: candidate, state: State::Evaluated(hit) };
    }

    /// Evaluates what is left.
    #[inline(always)]
    fn finish<P: PrecisionMode>(self, best: &Best) -> Option<ClosestHit> {
        let hit = self.evaluated::<P>(best)?;
        Some(ClosestHit { t: hit.t, u: hit.u, v: hit.v, triangle: self.triangle(best.place) })
    }
}

#[inline(always)]
fn from_origin<S: Simd>(simd: S, leaf: &impl LeafTriangles, axis: usize, origin: S::F32x8) -> Corners<S> {
    let [a, b, c] = leaf.rows(axis);
    [simd.sub(simd.load(a), origin), simd.sub(simd.load(b), origin), simd.sub(simd.load(c), origin)]
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

/// The largest magnitude.
#[inline(always)]
fn largest<S: Simd>(simd: S, values: Corners<S>) -> S::F32x8 {
    simd.max(simd.abs(values[0]), simd.max(simd.abs(values[1]), simd.abs(values[2])))
}
