//! Structures that find a ray's hit without asking every triangle, one a module, and what they share.

mod all_hits;
mod along_curve;
mod any_accel;
mod around;
mod brute_force;
mod bsp_tree;
mod build_context;
mod bvh;
mod copies;
mod grid;
mod kd_tree;
mod leaf;
mod listed;
mod morton;
mod octree;
mod out_of_memory;
mod places;
mod primitive;
mod reference;
mod space_tree;
mod stats;
mod tally;
mod walk_ray;
mod wide_bvh;

pub(crate) use all_hits::AllHits;
pub(crate) use any_accel::{AnyAccel, Plan, build, choose};
pub(crate) use around::Around;
pub(crate) use build_context::{BuildContext, BuildFailure, Watch};
pub(crate) use copies::{Copied, Copies};
pub(crate) use leaf::{AnyHit, Closest, ClosestHit, Counted, Every, Kept, Query};
pub use out_of_memory::OutOfMemory;
pub(crate) use places::Places;
pub(crate) use primitive::{AnyPrimitive, AnySurface, Part, Primitive, Surface};
pub(crate) use reference::{Bounds8, PrimitiveSource, Reference};
pub(crate) use stats::Shape;
pub use stats::{Precision, Quality, Stats, Structure};
pub use tally::RayCounts;
pub(crate) use tally::Tally;
pub(crate) use wide_bvh::{LeafForm, WideBvh};

use crate::geometry::{Accurate, PrecisionMode, Ray};

/// A structure whose rays go one by one through scalar code.
pub(crate) trait Walk {
    type Primitive: Primitive;

    /// So that an empty scene answers before the ray is looked at.
    #[inline(always)]
    fn is_empty(&self) -> bool {
        false
    }

    /// What there is along a valid ray; `seed` makes what is kept of it. Should be `#[inline(never)]`, so that it is compiled
    /// once for all callers.
    fn walk<Q: Query, P: PrecisionMode, K: Kept<Self::Primitive>>(
        &self,
        ray: &Ray,
        seed: K::Seed,
        tally: &mut Q::Tally,
    ) -> Option<K>;
}

impl<W: Walk> Accel for W {
    type Found = <W::Primitive as Primitive>::Surface;

    #[inline(always)]
    fn query<Q: Query, P: PrecisionMode, R>(
        &self,
        ray: impl Into<Ray>,
        then: impl FnOnce(Option<ClosestHit<Self::Found>>, Q::Tally) -> R,
    ) -> R {
        let mut tally = Q::Tally::default();
        if self.is_empty() {
            return then(None, tally);
        }
        let found = Ray::valid(ray).and_then(|ray| {
            let hit: ClosestHit<_> = self.walk::<Q, P, _>(&ray, (), &mut tally)?;
            Some(hit.on_surface(&ray))
        });
        then(found, tally)
    }

    fn all_hits<P: PrecisionMode>(&self, ray: &Ray, most: usize, copies: &Copies) -> Result<SortedHits, OutOfMemory> {
        AllHits::<W::Primitive>::find::<P>(ray, most, copies, |all| {
            self.walk::<Every, P, &mut AllHits<_>>(ray, all, &mut ());
        })
    }

    fn look_around(&self, around: &mut Around) {
        // Nothing is measured, so it does not matter how precisely.
        self.walk::<AnyHit, Accurate, &mut Around>(&around.ray(), around, &mut ());
    }
}

/// In the order in which hits win.
pub(crate) type SortedHits = Vec<ClosestHit<AnySurface>>;

/// What a structure can be asked. The precision and the kind of query are compile-time choices, so that a kernel
/// holds no branch on either.
pub(crate) trait Accel {
    /// What its hits tell about what they hit.
    type Found: Surface;

    /// The closest hit of a ray, or any, handed to `then` with what finding it took; none for a ray that is not valid.
    ///
    /// The ray is made, and its hit used, inside the kernel: what went through memory on the way would be loaded
    /// wider than it was just stored, and would wait for the stores.
    fn query<Q: Query, P: PrecisionMode, R>(
        &self,
        ray: impl Into<Ray>,
        then: impl FnOnce(Option<ClosestHit<Self::Found>>, Q::Tally) -> R,
    ) -> R;

    /// As [`Accel::query`], for all who need not have the ray made and its hit used inside: compiled once for them.
    fn find<Q: Query, P: PrecisionMode>(&self, ray: Ray) -> (Option<ClosestHit<Self::Found>>, Q::Tally) {
        self.query::<Q, P, _>(ray, |found, tally| (found, tally))
    }

    /// The first `most` hits of a valid ray in their order, each primitive's copies too.
    fn all_hits<P: PrecisionMode>(&self, ray: &Ray, most: usize, copies: &Copies) -> Result<SortedHits, OutOfMemory>;

    /// Shows all that the half-line along +x from a point may cross.
    fn look_around(&self, around: &mut Around);

    /// As [`Accel::query`] for the rays of each run, with the same answers in the same places.
    fn query_runs<'r, Q, P, R, T>(
        &self,
        next_run: impl FnMut() -> Option<(&'r [R], &'r mut [T])>,
        answer: impl Fn(&mut T, Option<ClosestHit<Self::Found>>),
    ) where
        Q: Query,
        P: PrecisionMode,
        for<'a> &'a R: Into<Ray>,
        R: 'r,
        T: 'r,
    {
        query_one_by_one::<Self, Q, P, R, T>(self, next_run, answer);
    }
}

/// See [`Accel::query_runs`].
fn query_one_by_one<'r, A, Q, P, R, T>(
    accel: &A,
    mut next_run: impl FnMut() -> Option<(&'r [R], &'r mut [T])>,
    answer: impl Fn(&mut T, Option<ClosestHit<A::Found>>),
) where
    A: Accel + ?Sized,
    Q: Query,
    P: PrecisionMode,
    for<'a> &'a R: Into<Ray>,
    R: 'r,
    T: 'r,
{
    while let Some((rays, places)) = next_run() {
        for (ray, place) in rays.iter().zip(places) {
            answer(place, accel.find::<Q, P>(ray.into()).0);
        }
    }
}
