//! Front to back with a stack: the nearer child first, the other one later if it still can matter.

use arrayvec::ArrayVec;

use super::Bvh;
use super::node::{MOST_LEVELS, Node};
use crate::accel::leaf::{Kept, Query, test_each};
use crate::accel::tally::Tally;
use crate::accel::{Primitive, Walk};
use crate::geometry::{PrecisionMode, Ray, SlabRay};

/// A node that waits, and where the ray enters it.
#[derive(Clone, Copy)]
struct Pending {
    enter: f32,
    first: u32,
    count: u32,
}

impl Pending {
    fn new(node: &Node, enter: f32) -> Self {
        Self { enter, first: node.first, count: node.count }
    }
}

impl<T: Primitive> Walk for Bvh<T> {
    type Primitive = T;

    #[inline(never)]
    fn walk<Q: Query, P: PrecisionMode, K: Kept<T>>(
        &self,
        ray: &Ray,
        seed: K::Seed,
        tally: &mut Q::Tally,
    ) -> Option<K> {
        let slabs = SlabRay::new(ray, &self.bounds);
        let primitive_ray = T::make_ready(ray);
        let t_min = ray.t_min * slabs.time_scale;
        let mut t_max = ray.t_max * slabs.time_scale;
        let mut kept = K::begin(seed, ray);

        let mut stack = ArrayVec::<Pending, MOST_LEVELS>::new_const();
        let mut node = Pending::new(&self.root, slabs.enter(&self.root.planes, t_min, t_max)?);
        loop {
            if node.count != 0 {
                let primitives = &self.primitives[node.first as usize..][..node.count as usize];
                tally.test_primitives(primitives.len());
                if test_leaf::<Q, P, T, K>(primitives, &primitive_ray, ray.t_min, &mut kept) {
                    break;
                }
                t_max = kept.t_max() * slabs.time_scale;
            } else {
                tally.visit_node();
                let [left, right] = &self.pairs[node.first as usize].children;
                let enter_left = slabs.enter(&left.planes, t_min, t_max);
                let enter_right = slabs.enter(&right.planes, t_min, t_max);
                match (enter_left, enter_right) {
                    (Some(at_left), Some(at_right)) => {
                        let (left, right) = (Pending::new(left, at_left), Pending::new(right, at_right));
                        let (near, far) = if at_right < at_left { (right, left) } else { (left, right) };
                        stack.push(far);
                        node = near;
                        continue;
                    }
                    (Some(at_left), None) => {
                        node = Pending::new(left, at_left);
                        continue;
                    }
                    (None, Some(at_right)) => {
                        node = Pending::new(right, at_right);
                        continue;
                    }
                    (None, None) => {}
                }
            }
            // A node that the ray enters exactly where the best hit is may hold an equal hit with a lower id.
            node = loop {
                let Some(pending) = stack.pop() else { return kept.found() };
                if pending.enter <= t_max {
                    break pending;
                }
            };
        }
        kept.found()
    }
}

/// Out of line: inlined it takes registers from the box test, and a ray takes 12 % more instructions.
#[inline(never)]
fn test_leaf<Q: Query, P: PrecisionMode, T: Primitive, K: Kept<T>>(
    primitives: &[T],
    ray: &T::Ray,
    t_min: f32,
    kept: &mut K,
) -> bool {
    test_each::<Q, P, T, K>(primitives, ray, t_min, kept)
}
