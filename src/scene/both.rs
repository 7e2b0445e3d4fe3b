//! Triangles and spheres in one scene: each kind in a structure of its own, the second asked for what is better than the
//! first one's answer.

use super::Scene;
use super::all_hits::{FirstHits, LookAround};
use super::query::{Find, Kernel};
use crate::accel::{
    Accel, AnyAccel, AnySurface, Around, ClosestHit, Copies, OutOfMemory, Primitive, Query, SortedHits, Surface, Tally,
};
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

    fn all_hits<P: PrecisionMode>(&self, ray: &Ray, most: usize, _copies: &Copies) -> Result<SortedHits, OutOfMemory> {
        let scene = self.scene;
        let first = scene.dispatch_to(FirstHits { scene, ray, most }, self.triangles)?;
        let t_max = if first.len() == most { first.last().map_or(ray.t_max, |last| last.t) } else { ray.t_max };
        let second = scene.dispatch_to(FirstHits { scene, ray: &Ray { t_max, ..*ray }, most }, self.spheres)?;
        let (mut first, mut second) = (first.into_iter().peekable(), second.into_iter().peekable());
        let merged = std::iter::from_fn(|| match (first.peek(), second.peek()) {
            (Some(a), Some(b)) if precedes(b, a) => second.next(),
            (None, _) => second.next(),
            _ => first.next(),
        });
        Ok(merged.take(most).collect())
    }

    fn look_around(&self, around: &mut Around) {
        self.scene.dispatch_to(LookAround(around), self.triangles);
        self.scene.dispatch_to(LookAround(around), self.spheres);
    }
}

fn better(first: ClosestHit<AnySurface>, second: ClosestHit<AnySurface>) -> ClosestHit<AnySurface> {
    if precedes(&second, &first) { second } else { first }
}

fn precedes(a: &ClosestHit<AnySurface>, b: &ClosestHit<AnySurface>) -> bool {
    a.t < b.t || (a.t == b.t && a.primitive.ids() < b.primitive.ids())
}
