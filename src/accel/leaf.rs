//! What queries look for and keep, the order in which hits win, and a leaf tested primitive by primitive.

use super::primitive::{AnySurface, Primitive, Surface};
use super::tally::{RayCounts, Tally};
use crate::geometry::{INVALID_ID, Interval, PrecisionMode, Ray, Triangle, TriangleHit};

/// What a query wants, chosen at compile time.
pub(crate) trait Query {
    /// Whether the first hit found ends the search.
    const FIRST_HIT_ENDS: bool;
    /// What is counted on the way.
    type Tally: Tally;
}

/// The hit with the least `t`, and of equal ones the lowest `(geometry_id, primitive_id)`.
pub(crate) struct Closest;

/// Whether there is a hit.
pub(crate) struct AnyHit;

/// As [`Closest`], and what finding it took.
pub(crate) struct Counted;

/// All that there are.
pub(crate) struct Every;

impl Query for Closest {
    const FIRST_HIT_ENDS: bool = false;
    type Tally = ();
}

impl Query for AnyHit {
    const FIRST_HIT_ENDS: bool = true;
    type Tally = ();
}

impl Query for Counted {
    const FIRST_HIT_ENDS: bool = false;
    type Tally = RayCounts;
}

impl Query for Every {
    const FIRST_HIT_ENDS: bool = false;
    type Tally = ();
}

/// What a walk keeps of what it finds.
pub(crate) trait Kept<T: Primitive>: Sized {
    /// What it is made of.
    type Seed;

    /// Nothing yet.
    fn begin(seed: Self::Seed, ray: &Ray) -> Self;

    /// Beyond this the walk need not look.
    fn t_max(&self) -> f32;

    /// Tests a primitive. True ends the walk.
    fn test<Q: Query, P: PrecisionMode>(&mut self, primitive: &T, ray: &T::Ray, t_min: f32) -> bool;

    /// `None` where nothing was found.
    fn found(self) -> Option<Self>;
}

/// The best hit so far.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ClosestHit<T = Triangle> {
    pub(crate) t: f32,
    pub(crate) u: f32,
    pub(crate) v: f32,
    pub(crate) primitive: T,
}

impl<T: Surface> ClosestHit<T> {
    /// For those who do not know what was hit.
    pub(crate) fn on_any_surface(self) -> ClosestHit<AnySurface> {
        let (geometry_id, primitive_id) = self.primitive.ids();
        let primitive = AnySurface { geometry_id, primitive_id, normal: self.primitive.normal() };
        ClosestHit { t: self.t, u: self.u, v: self.v, primitive }
    }
}

impl<T: Primitive> ClosestHit<T> {
    /// For a query that asks for no more than whether there is a hit.
    pub(crate) const UNSPECIFIED: Self = Self { t: f32::NAN, u: f32::NAN, v: f32::NAN, primitive: T::NONE };

    /// Nothing yet: whatever lies in the interval is better, a hit at `t_max` itself too.
    pub(crate) fn none(ray: &Ray) -> Self {
        Self { t: ray.t_max, u: 0.0, v: 0.0, primitive: T::NONE }
    }

    /// With what there is to tell of the hit.
    #[inline(always)]
    pub(crate) fn on_surface(self, ray: &Ray) -> ClosestHit<T::Surface> {
        ClosestHit { t: self.t, u: self.u, v: self.v, primitive: self.primitive.surface(ray, self.t) }
    }

    pub(crate) fn found(self) -> Option<Self> {
        (self.primitive.ids().0 != INVALID_ID).then_some(self)
    }

    /// Keeps a hit of the ray if it is better, and says so.
    #[inline(always)]
    pub(crate) fn improve<P: PrecisionMode>(&mut self, ray: &T::Ray, hit: &TriangleHit, primitive: &T) -> bool {
        let is_better = hit.t < self.t || (hit.t == self.t && primitive.precedes::<P>(&self.primitive, ray));
        if is_better {
            *self = Self { t: hit.t, u: hit.u, v: hit.v, primitive: *primitive };
        }
        is_better
    }
}

/// The best hit alone.
impl<T: Primitive> Kept<T> for ClosestHit<T> {
    type Seed = ();

    fn begin((): (), ray: &Ray) -> Self {
        Self::none(ray)
    }

    #[inline(always)]
    fn t_max(&self) -> f32 {
        self.t
    }

    #[inline(always)]
    fn test<Q: Query, P: PrecisionMode>(&mut self, primitive: &T, ray: &T::Ray, t_min: f32) -> bool {
        let hit = primitive.hit::<P>(ray, Interval { t_min, t_max: self.t });
        hit.is_some_and(|hit| self.improve::<P>(ray, &hit, primitive) && Q::FIRST_HIT_ENDS)
    }

    fn found(self) -> Option<Self> {
        ClosestHit::found(self)
    }
}

/// Tests the primitives one by one. True ends the query.
#[inline(always)]
pub(crate) fn test_each<'p, Q: Query, P: PrecisionMode, T: Primitive, K: Kept<T>>(
    primitives: impl IntoIterator<Item = &'p T>,
    ray: &T::Ray,
    t_min: f32,
    kept: &mut K,
) -> bool {
    for primitive in primitives {
        if kept.test::<Q, P>(primitive, ray, t_min) {
            return true;
        }
    }
    false
}
