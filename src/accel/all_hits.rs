//! All hits of a ray, in the order in which hits win, each primitive once.

use std::cmp::Ordering;

use super::SortedHits;
use super::copies::Copies;
use super::leaf::{ClosestHit, Kept, Query};
use super::out_of_memory::OutOfMemory;
use super::primitive::Primitive;
use crate::geometry::{Interval, PrecisionMode, Ray, TriangleHit};

/// The first hits of a ray, at most so many as are asked for.
///
/// Hits are appended as they are found. Now and then they are sorted, what was found in several leaves is dropped but
/// once, and what comes after the last that is asked for: as often as makes this `O(log n)` for each hit, and bounds `t`
/// soon.
pub(crate) struct AllHits<'a, T: Primitive> {
    ray: T::Ray,
    copies: &'a Copies,
    most: usize,
    hits: Vec<ClosestHit<T>>,
    /// With so many hits it is time to sort.
    room: usize,
    /// As many as are asked for are there, sorted, at the front: others count if they come before the last of these.
    is_full: bool,
    t_max: f32,
    out_of_memory: Option<OutOfMemory>,
}

/// Hits that are not sorted for their number alone.
const FEW: usize = 16;

impl<T: Primitive> AllHits<'_, T> {
    /// The first `most` hits of a valid ray in their order, offered by a walk.
    pub(super) fn find<P: PrecisionMode>(
        ray: &Ray,
        most: usize,
        copies: &Copies,
        walk: impl FnOnce(&mut AllHits<T>),
    ) -> Result<SortedHits, OutOfMemory> {
        let mut all = AllHits {
            ray: T::make_ready(ray),
            copies,
            most,
            hits: Vec::new(),
            room: most.min(FEW),
            is_full: false,
            t_max: ray.t_max,
            out_of_memory: None,
        };
        walk(&mut all);
        all.settle::<P>();
        match all.out_of_memory {
            Some(failure) => Err(failure),
            None => Ok(all.hits.into_iter().map(|hit| hit.on_surface(ray).on_any_surface()).collect()),
        }
    }

    /// A hit on a stored primitive is one on each of its copies.
    fn keep<P: PrecisionMode>(&mut self, TriangleHit { t, u, v }: TriangleHit, stored: &T) {
        if !self.put::<P>(ClosestHit { t, u, v, primitive: *stored }) {
            return;
        }
        for (geometry_id, primitive_id) in self.copies.of(stored.ids()) {
            if !self.put::<P>(ClosestHit { t, u, v, primitive: stored.with_ids(geometry_id, primitive_id) }) {
                return;
            }
        }
    }

    /// False where it does not count, nor does what comes after it.
    fn put<P: PrecisionMode>(&mut self, hit: ClosestHit<T>) -> bool {
        if self.is_full && order::<P, T>(&hit, &self.hits[self.most - 1], &self.ray).is_gt() {
            return false;
        }
        if self.hits.try_reserve(1).is_err() {
            self.out_of_memory = Some(OutOfMemory { bytes: (self.hits.len() + 1) * size_of::<ClosestHit<T>>() });
            return false;
        }
        self.hits.push(hit);
        if self.hits.len() == self.room {
            self.settle::<P>();
        }
        true
    }

    fn settle<P: PrecisionMode>(&mut self) {
        let ray = &self.ray;
        self.hits.sort_unstable_by(|a, b| order::<P, T>(a, b, ray));
        self.hits.dedup_by(|next, kept| next.t == kept.t && next.primitive.ids() == kept.primitive.ids());
        self.hits.truncate(self.most);
        let count = self.hits.len();
        self.is_full = count == self.most;
        if self.is_full {
            self.t_max = self.hits.last().map_or(self.t_max, |last| last.t);
            self.room = count + count / 2 + 1;
        } else {
            self.room = self.most.min(2 * count + FEW);
        }
    }
}

impl<T: Primitive> Kept<T> for &mut AllHits<'_, T> {
    type Seed = Self;

    fn begin(seed: Self, _ray: &Ray) -> Self {
        seed
    }

    #[inline(always)]
    fn t_max(&self) -> f32 {
        self.t_max
    }

    #[inline(always)]
    fn test<Q: Query, P: PrecisionMode>(&mut self, primitive: &T, ray: &T::Ray, t_min: f32) -> bool {
        let interval = Interval { t_min, t_max: self.t_max };
        primitive.each_hit::<P>(ray, interval, |hit| self.keep::<P>(hit, primitive));
        self.out_of_memory.is_some()
    }

    fn found(self) -> Option<Self> {
        Some(self)
    }
}

/// Equal for the same hit alone.
fn order<P: PrecisionMode, T: Primitive>(a: &ClosestHit<T>, b: &ClosestHit<T>, ray: &T::Ray) -> Ordering {
    let precedes = |a: &ClosestHit<T>, b: &ClosestHit<T>| {
        a.t < b.t || (a.t == b.t && a.primitive.precedes::<P>(&b.primitive, ray))
    };
    precedes(b, a).cmp(&precedes(a, b))
}
