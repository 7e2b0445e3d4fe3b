//! The one routine by which every structure tests its triangles, and the order in which hits win.

use crate::geometry::{INVALID_ID, Interval, PrecisionMode, Ray, Triangle, TriangleHit, TriangleRay};

/// What a query wants, chosen at compile time.
pub(crate) trait Query {
    /// Whether the first hit found ends the search.
    const FIRST_HIT_ENDS: bool;
}

/// The hit with the least `t`, and of equal ones the lowest `(geometry_id, primitive_id)`.
pub(crate) struct Closest;

/// Whether there is a hit.
pub(crate) struct AnyHit;

impl Query for Closest {
    const FIRST_HIT_ENDS: bool = false;
}

impl Query for AnyHit {
    const FIRST_HIT_ENDS: bool = true;
}

/// The best hit so far.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ClosestHit {
    pub(crate) t: f32,
    pub(crate) u: f32,
    pub(crate) v: f32,
    pub(crate) geometry_id: u32,
    pub(crate) primitive_id: u32,
    /// Where the structure stores the triangle.
    pub(crate) index: u32,
}

impl ClosestHit {
    /// Nothing yet: whatever lies in the interval is better, a hit at `t_max` itself too.
    pub(crate) fn none(ray: &Ray) -> Self {
        Self { t: ray.t_max, u: 0.0, v: 0.0, geometry_id: INVALID_ID, primitive_id: INVALID_ID, index: INVALID_ID }
    }

    pub(crate) fn found(self) -> Option<Self> {
        (self.geometry_id != INVALID_ID).then_some(self)
    }

    fn is_beaten_by(&self, hit: &TriangleHit, triangle: &Triangle) -> bool {
        hit.t < self.t
            || (hit.t == self.t
                && (triangle.geometry_id, triangle.primitive_id) < (self.geometry_id, self.primitive_id))
    }
}

/// Tests the triangles, the first of which the structure stores at `first_index`, and keeps the best hit. True ends
/// the query.
#[inline(always)]
pub(crate) fn test_triangles<Q: Query, P: PrecisionMode>(
    triangles: &[Triangle],
    first_index: u32,
    ray: &TriangleRay,
    t_min: f32,
    best: &mut ClosestHit,
) -> bool {
    for (index, triangle) in (first_index..).zip(triangles) {
        let interval = Interval { t_min, t_max: best.t };
        let Some(hit) = ray.hit::<P>(triangle, interval) else { continue };
        if best.is_beaten_by(&hit, triangle) {
            *best = ClosestHit {
                t: hit.t,
                u: hit.u,
                v: hit.v,
                geometry_id: triangle.geometry_id,
                primitive_id: triangle.primitive_id,
                index,
            };
            if Q::FIRST_HIT_ENDS {
                return true;
            }
        }
    }
    false
}
