//! What queries look for, the order in which hits win, and a leaf tested triangle by triangle.

use super::tally::{RayCounts, Tally};
use crate::geometry::{INVALID_ID, Interval, PrecisionMode, Ray, Triangle, TriangleHit, TriangleRay};

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

/// The best hit so far.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ClosestHit {
    pub(crate) t: f32,
    pub(crate) u: f32,
    pub(crate) v: f32,
    pub(crate) triangle: Triangle,
}

impl ClosestHit {
    /// For a query that asks for no more than whether there is a hit.
    pub(crate) const UNSPECIFIED: Self = Self {
        t: f32::NAN,
        u: f32::NAN,
        v: f32::NAN,
        triangle: Triangle { axes: [[f32::NAN; 3]; 3], geometry_id: INVALID_ID, primitive_id: INVALID_ID },
    };

    /// Nothing yet: whatever lies in the interval is better, a hit at `t_max` itself too.
    pub(crate) fn none(ray: &Ray) -> Self {
        Self { t: ray.t_max, u: 0.0, v: 0.0, triangle: Triangle::new([[0.0; 3]; 3], INVALID_ID, INVALID_ID) }
    }

    pub(crate) fn found(self) -> Option<Self> {
        (self.triangle.geometry_id != INVALID_ID).then_some(self)
    }

    /// Keeps the hit if it is better, and says so.
    #[inline(always)]
    pub(crate) fn improve(&mut self, hit: &TriangleHit, triangle: &Triangle) -> bool {
        let ids = |triangle: &Triangle| (triangle.geometry_id, triangle.primitive_id);
        let is_better = hit.t < self.t || (hit.t == self.t && ids(triangle) < ids(&self.triangle));
        if is_better {
            *self = Self { t: hit.t, u: hit.u, v: hit.v, triangle: *triangle };
        }
        is_better
    }
}

/// Tests the triangles and keeps the best hit. True ends the query.
#[inline(always)]
pub(crate) fn test_triangles<Q: Query, P: PrecisionMode>(
    triangles: &[Triangle],
    ray: &TriangleRay,
    t_min: f32,
    best: &mut ClosestHit,
) -> bool {
    for triangle in triangles {
        if let Some(hit) = ray.hit::<P>(triangle, Interval { t_min, t_max: best.t })
            && best.improve(&hit, triangle)
            && Q::FIRST_HIT_ENDS
        {
            return true;
        }
    }
    false
}
