//! What the walk needs to know about planes across the axes.

use super::KdTree;
use crate::accel::leaf::{Kept, Query};
use crate::accel::space_tree::Slope;
use crate::accel::walk_ray::WalkRay;
use crate::accel::{Primitive, Walk};
use crate::geometry::{PrecisionMode, Ray};

impl<T: Primitive> Walk for KdTree<T> {
    type Primitive = T;

    #[inline(never)]
    fn walk<Q: Query, P: PrecisionMode, K: Kept<T>>(
        &self,
        ray: &Ray,
        seed: K::Seed,
        tally: &mut Q::Tally,
    ) -> Option<K> {
        let walk_ray = WalkRay::new(ray, &self.tree.bounds);
        let WalkRay { origin, direction, band, .. } = walk_ray;
        // A fourth one, so that the mask keeps the index in range.
        let slopes = [0, 1, 2, 0].map(|axis| Slope::new(origin[axis], direction[axis], band));
        self.tree.walk::<Q, P, K>(
            ray,
            seed,
            &walk_ray,
            |node| slopes[node.kind() as usize & 3].cross(f64::from(node.position())),
            tally,
        )
    }
}
