//! Front to back with a stack: the nearer side of each plane first, the other one later if it still can matter.

use arrayvec::ArrayVec;

use super::SpaceTree;
use super::node::{MOST_LEVELS, Node};
use crate::accel::Primitive;
use crate::accel::leaf::{Kept, Query};
use crate::accel::listed::{Mailbox, test_listed};
use crate::accel::tally::Tally;
use crate::accel::walk_ray::{Span, WalkRay};
use crate::geometry::{PrecisionMode, Ray};

/// A node that waits, and the part of the ray that comes near its cell.
#[derive(Clone, Copy)]
struct Pending {
    node: Node,
    span: Span,
}

/// A ray and the planes of one direction.
#[derive(Clone, Copy)]
pub(in crate::accel) struct Slope {
    /// How high the origin is.
    pub(in crate::accel) origin: f64,
    /// `t` for each unit of height, infinite where the ray runs along the planes.
    pub(in crate::accel) inverse: f64,
    /// How much higher than the ray a hit can be, with the sign of `inverse`.
    pub(in crate::accel) band: f64,
}

impl Slope {
    pub(in crate::accel) fn new(origin: f64, direction: f64, band: f64) -> Self {
        Self { origin, inverse: direction.recip(), band: band.copysign(direction) }
    }

    /// Where the ray comes near a plane and where it leaves it; NaN, which compares as neither, where it runs along the
    /// plane at the very edge of the band. And which side comes first.
    #[inline(always)]
    pub(in crate::accel) fn cross(&self, position: f64) -> Crossing {
        let height = position - self.origin;
        Crossing {
            first: (height - self.band) * self.inverse,
            last: (height + self.band) * self.inverse,
            near_side: usize::from(self.inverse.is_sign_negative()),
        }
    }
}

pub(in crate::accel) struct Crossing {
    first: f64,
    last: f64,
    near_side: usize,
}

impl<T: Primitive> SpaceTree<T> {
    /// `cross` is told inner nodes.
    #[inline(always)]
    pub(in crate::accel) fn walk<Q: Query, P: PrecisionMode, K: Kept<T>>(
        &self,
        ray: &Ray,
        seed: K::Seed,
        walk_ray: &WalkRay,
        cross: impl Fn(Node) -> Crossing,
        tally: &mut Q::Tally,
    ) -> Option<K> {
        let mut span = walk_ray.span_in(&self.bounds, ray.t_min, ray.t_max)?;
        let primitive_ray = T::make_ready(ray);
        let mut kept = K::begin(seed, ray);
        let mut stack = ArrayVec::<Pending, MOST_LEVELS>::new_const();
        let mut node = self.root;
        let mut mailbox = Mailbox::EMPTY;
        loop {
            while !node.is_leaf() {
                tally.visit_node();
                let Crossing { first, last, near_side } = cross(node);
                let children = &self.pairs[node.pair()].children;
                let (near, far) = (children[near_side & 1], children[near_side & 1 ^ 1]);
                if first > span.end {
                    node = near;
                } else if last < span.begin {
                    node = far;
                } else {
                    let begin = if first > span.begin { first } else { span.begin };
                    stack.push(Pending { node: far, span: Span { begin, end: span.end } });
                    span.end = if last < span.end { last } else { span.end };
                    node = near;
                }
            }
            tally.step_cell();
            let list = &self.lists[node.list()];
            if !list.is_empty() {
                let ray = (&primitive_ray, ray.t_min);
                if test_listed::<Q, P, T, K>(list, &self.primitives, &mut mailbox, ray, &mut kept, tally) {
                    break;
                }
            }
            // A cell that the ray comes near exactly where the best hit is may hold an equal hit with a lower id.
            let t_max = f64::from(kept.t_max());
            (node, span) = loop {
                let Some(Pending { node, span }) = stack.pop() else { return kept.found() };
                if span.begin <= t_max {
                    break (node, Span { begin: span.begin, end: span.end.min(t_max) });
                }
            };
        }
        kept.found()
    }
}
