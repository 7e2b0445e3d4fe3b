//! What the walk needs to know about planes of any direction.

use glam::DVec3;

use super::BspTree;
use super::directions::DIRECTIONS;
use crate::accel::leaf::{Kept, Query};
use crate::accel::space_tree::{ANY, Slope};
use crate::accel::walk_ray::WalkRay;
use crate::accel::{Primitive, Walk};
use crate::geometry::{PrecisionMode, Ray};

/// So that a mask keeps the index in range.
const SLOPE_COUNT: usize = 16;

impl<T: Primitive> Walk for BspTree<T> {
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
        // Products of `f32`s are exact in `f64`. Their sums round by less than 2^-52 of the vectors' lengths, and so a
        // crossing is off by as much of the way to it, of which the band is far more.
        let band = band + self.tolerance;
        let slope =
            |normal: DVec3| Slope::new(normal.dot(origin), normal.dot(direction), band * normal.abs().element_sum());
        let mut slopes = [slope(DVec3::X); SLOPE_COUNT];
        for (place, &normal) in slopes.iter_mut().zip(&DIRECTIONS) {
            *place = slope(normal);
        }
        self.tree.walk::<Q, P, K>(
            ray,
            seed,
            &walk_ray,
            |node| match node.kind() {
                ANY => {
                    let (normal, distance) = self.tree.planes[node.plane()].normal_and_distance();
                    slope(normal).cross(distance)
                }
                direction => slopes[direction as usize % SLOPE_COUNT].cross(f64::from(node.position())),
            },
            tally,
        )
    }
}
