//! Triangles and spheres in one scene: each kind in a structure of its own, the second asked for what is better than the
//! first one's answer.

use super::Scene;
use super::query::{Find, Kernel};
use crate::accel::{Accel, AnyAccel, AnySurface, ClosestHit, Primitive, Query, Surface, Tally};
use crate::geometry::{PrecisionMode, Ray, Sphere, Triangle};

pub(super) struct Both<'a> {
    pub(super) scene: &'a Scene,
    pub(super) triangles: &'a AnyAccel<Triangle>,
    pub(super) spheres: &'a AnyAccel<Sphere>,
}

impl Both<'_> {
    #[inline(always)]
    fn find<Q: Query, T: Primitive>(&self, ray: Ray, accel: &AnyAccel<T>) -> <Find<Q> as Kernel>::Output {
        self.scene.dispatch_to(Find::<Q>::new(ray), accel)
    }
}

impl Accel for Both<'_> {
    type Found = AnySurface;

    #[inline(always)]
    fn query<Q: Query, P: PrecisionMode, R>(
        &self,
        ray: impl Into<Ray>,
        then: impl FnOnce(Option<ClosestHit<AnySurface>>, Q::Tally) -> R,
    ) -> R {
        let ray = ray.into();
        let (first, first_tally) = self.find::<Q, _>(ray, self.triangles);
        if Q::FIRST_HIT_ENDS && first.is_some() {
            return then(first, first_tally);
        }
        // A hit at the same t is asked for too: its ids may be lower.
        let rest = Ray { t_max: first.map_or(ray.t_max, |hit| hit.t), ..ray };
        let (second, second_tally) = self.find::<Q, _>(rest, self.spheres);
        let best = match (first, second) {
            (Some(first), Some(second)) => Some(better(first, second)),
            (first, second) => first.or(second),
        };
        then(best, first_tally.plus(second_tally))
    }
}

fn better(first: ClosestHit<AnySurface>, second: ClosestHit<AnySurface>) -> ClosestHit<AnySurface> {
    let is_second = second.t < first.t || (second.t == first.t && second.primitive.ids() < first.primitive.ids());
    if is_second { second } else { first }
}
