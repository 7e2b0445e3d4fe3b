//! Rays, boxes and triangles, and the scalar definition of every test between them.

mod aabb;
mod clip;
mod crossing;
mod evaluation;
mod evaluation_lanes;
mod exact;
mod float_hit;
mod hit_point;
mod mesh_view;
mod offset_origin;
mod overlap;
#[cfg(test)]
pub(crate) mod rational;
mod ray;
mod sphere;
mod triangle;
mod triangle_hit;

pub use aabb::Aabb;
pub(crate) use aabb::{BEHIND, ObliqueSlabs, SlabRay, band_distance};
pub(crate) use clip::Polygon;
pub(crate) use crossing::Crossing;
pub(crate) use evaluation::Evaluation;
pub(crate) use evaluation_lanes::{HITS, HitLanes, settled};
pub(crate) use float_hit::{edges, in_floats};
pub(crate) use hit_point::HitPoint;
pub use mesh_view::{IndexBytes, IndexView, PositionView, SphereView, TriangleView, span_bytes};
pub use ray::{Hit, INVALID_ID, Ray};
pub(crate) use sphere::{Sphere, SpherePart, SphereRay};
pub(crate) use triangle::Triangle;
pub(crate) use triangle_hit::{
    Accurate, Exact, Fast, Interval, PrecisionMode, TriangleHit, TriangleRay, edge_slack, least_doubt,
};
