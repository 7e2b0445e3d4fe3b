//! A ray made ready for structures that divide space: grid, octree, kd-tree, BSP tree.

use glam::DVec3;

use crate::geometry::{Aabb, Ray, band_distance};

/// A ray in `f64`, in which distances to planes and cells are computed, and how far from it what it may hit can lie.
///
/// A structure that divides space stores a triangle in each cell that the triangle overlaps. A hit lies on its triangle
/// at a point `P`, which is in some cell, and `|P - R(t)| <= band` along each axis for the `t` that is reported. So a walk
/// that visits each cell which the ray passes within the band, from the `t` on at which it comes so near, finds all hits;
/// and a cell that it comes near to only beyond the best `t` holds no better one. `f64` rounds by 2^-29 of the band,
/// which has room for that (see [`band_distance`]).
#[derive(Clone, Copy, Debug)]
pub(crate) struct WalkRay {
    pub(crate) origin: DVec3,
    pub(crate) direction: DVec3,
    /// `1 / direction`, with a signed infinity where a component is 0.
    pub(crate) inverse: DVec3,
    /// In units of length.
    pub(crate) band: f64,
}

/// Part of a ray, in its own `t`; empty where `begin > end`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Span {
    pub(crate) begin: f64,
    pub(crate) end: f64,
}

impl WalkRay {
    /// `bounds` are those of the scene.
    #[inline(always)]
    pub(crate) fn new(ray: &Ray, bounds: &Aabb) -> Self {
        let direction = ray.direction.as_dvec3();
        Self {
            origin: ray.origin.as_dvec3(),
            direction,
            inverse: direction.recip(),
            band: f64::from(band_distance(ray.origin, bounds)),
        }
    }

    /// Where along the ray `[t_min, t_max]` it may hit what lies in the box; `None` where nowhere. A NaN, of an origin
    /// in the plane of a side that the ray runs along, decides nothing.
    #[inline(always)]
    pub(crate) fn span_in(&self, bounds: &Aabb, t_min: f32, t_max: f32) -> Option<Span> {
        let mut span = Span { begin: f64::from(t_min), end: f64::from(t_max) };
        let lower = (bounds.lower.as_dvec3() - self.band - self.origin) * self.inverse;
        let upper = (bounds.upper.as_dvec3() + self.band - self.origin) * self.inverse;
        for axis in 0..3 {
            let (near, far) = if self.inverse[axis].is_sign_negative() {
                (upper[axis], lower[axis])
            } else {
                (lower[axis], upper[axis])
            };
            span.begin = if near > span.begin { near } else { span.begin };
            span.end = if far < span.end { far } else { span.end };
        }
        (span.begin <= span.end).then_some(span)
    }
}
