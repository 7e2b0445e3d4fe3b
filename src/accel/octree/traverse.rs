//! Front to back with a stack: of a cell's octants those that the ray passes within the band, the nearest first.

use arrayvec::ArrayVec;
use glam::DVec3;

use super::Octree;
use super::cell::Cell;
use super::node::{MOST_LEVELS, Node};
use crate::accel::leaf::{Kept, Query};
use crate::accel::listed::{Mailbox, test_listed};
use crate::accel::tally::Tally;
use crate::accel::walk_ray::{Span, WalkRay};
use crate::accel::{Primitive, Walk};
use crate::geometry::{PrecisionMode, Ray};

/// A node that waits, and the part of the ray that passes it.
#[derive(Clone, Copy)]
struct Pending {
    span: Span,
    cell: Cell,
    node: u32,
}

/// Each level leaves at most seven siblings.
const MOST_PENDING: usize = 7 * (MOST_LEVELS - 1) + 1;

impl<T: Primitive> Walk for Octree<T> {
    type Primitive = T;

    #[inline(never)]
    fn walk<Q: Query, P: PrecisionMode, K: Kept<T>>(
        &self,
        ray: &Ray,
        seed: K::Seed,
        tally: &mut Q::Tally,
    ) -> Option<K> {
        let walk_ray = WalkRay::new(ray, &self.bounds);
        let span = walk_ray.span_in(&self.bounds, ray.t_min, ray.t_max)?;
        let halves = Halves::new(&walk_ray, self.cube.lower);
        let primitive_ray = T::make_ready(ray);
        let (mut kept, mut mailbox) = (K::begin(seed, ray), Mailbox::EMPTY);

        let mut stack = ArrayVec::<Pending, MOST_PENDING>::new_const();
        stack.push(Pending { span, cell: self.cube.whole(), node: 0 });
        while let Some(Pending { span, cell, node }) = stack.pop() {
            // What the ray passes exactly where the best hit is may hold an equal hit with a lower id.
            if f64::from(kept.t_max()) < span.begin {
                continue;
            }
            let node = &self.nodes[node as usize];
            if node.is_leaf() {
                let list = &self.listed[node.first as usize..][..node.count()];
                let prepared = (&primitive_ray, ray.t_min);
                if test_listed::<Q, P, T, K>(list, &self.primitives, &mut mailbox, prepared, &mut kept, tally) {
                    break;
                }
            } else {
                tally.visit_node();
                halves.for_each_passed(node, &cell, span, |pending| stack.push(pending));
            }
        }
        kept.found()
    }
}

/// A ray made ready to tell in which half of a cell it is, along each axis. The halves overlap by twice the band, so that
/// a ray is in each that it may hit something in. Outer sides are not looked at: the ray is known to be inside.
struct Halves {
    /// From the ray's origin to the cube's lower corner.
    lower: DVec3,
    inverse: DVec3,
    /// With the sign of the direction.
    band: DVec3,
    /// The octant that the ray comes to first if it comes to all.
    first: u32,
}

impl Halves {
    #[inline(always)]
    fn new(ray: &WalkRay, lower: DVec3) -> Self {
        Self {
            lower: lower - ray.origin,
            inverse: ray.inverse,
            band: DVec3::splat(ray.band).copysign(ray.inverse),
            first: ray.inverse.is_negative_bitmask(),
        }
    }

    /// From the last one to the first. A NaN, of a ray that runs along the border of the band, decides nothing.
    #[inline(always)]
    fn for_each_passed(&self, node: &Node, cell: &Cell, span: Span, mut then: impl FnMut(Pending)) {
        let middle = self.lower + cell.middle.as_dvec3() * cell.half;
        // Until when the ray is in the nearer half, and from when on in the farther one.
        let near_end = ((middle + self.band) * self.inverse).to_array();
        let far_begin = ((middle - self.band) * self.inverse).to_array();
        // By the order in which the ray comes to octants: a bit is 1 where it is the farther half.
        let (mut begins, mut ends) = ([span.begin; 8], [span.end; 8]);
        for axis in 0..3 {
            for order in 0..8 {
                if order >> axis & 1 != 0 {
                    begins[order] = if far_begin[axis] > begins[order] { far_begin[axis] } else { begins[order] };
                } else {
                    ends[order] = if near_end[axis] < ends[order] { near_end[axis] } else { ends[order] };
                }
            }
        }
        let is_passed = |order: usize| u32::from(begins[order] <= ends[order]) << order;
        let mut passed = (0..8).fold(0, |passed, order| passed | is_passed(order)) & node.octants_from(self.first);
        while passed != 0 {
            let order = passed.ilog2();
            passed ^= 1 << order;
            let (octant, at) = (order ^ self.first, order as usize & 7);
            let span = Span { begin: begins[at], end: ends[at] };
            then(Pending { span, cell: cell.octant(octant), node: node.child(octant) });
        }
    }
}
