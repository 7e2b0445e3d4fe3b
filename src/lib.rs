//! Ray queries against a scene of triangles and spheres, with the same answer from every structure.
//!
//! Conventions, stated once:
//! - Coordinates are `f32`, right-handed or left-handed as the caller likes; nothing here depends on it.
//! - A ray is `origin + t * direction` for `t` in the closed interval `[t_min, t_max]`; `t` counts in lengths of the
//!   direction, which need not be a unit vector.
//! - A triangle is closed: its edges and vertices belong to it, and both its sides are hit.
//! - Of two hits with the same `t`, the lower `(geometry_id, primitive_id)` wins.
//! - `u` and `v` are the weights of the second and third vertex; of a sphere they are 0.
//!
//! The C interface in [`ffi`] is the product; the Rust types below it are what it is made of.
//! The layers, each using only those to its right: `ffi -> radiometry -> scene -> accel -> geometry -> math`.

pub mod ffi;
pub mod radiometry;

mod accel;
mod geometry;
mod math;
mod memory;
mod scene;
mod simd;

pub use accel::{OutOfMemory, Precision, Quality, RayCounts, Stats, Structure};
pub use geometry::{
    Aabb, Hit, INVALID_ID, IndexBytes, IndexView, PositionView, Ray, SphereView, TriangleView, span_bytes,
};
pub use scene::{BuildError, BuildOptions, InvalidTriangles, Scene, SceneBuilder, SurfaceError, SurfacePoint};
pub use simd::Isa;
