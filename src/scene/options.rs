//! What a caller may choose about a build.

use crate::accel::{Precision, Quality, Structure};
use crate::simd::Isa;

/// What happens to a triangle or sphere with a coordinate that is not finite, and to a radius below 0.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum InvalidTriangles {
    /// The build fails and names the first one.
    #[default]
    Reject,
    /// It is left out and counted in the stats; the others keep their ids.
    Skip,
}

/// How to build a scene.
#[derive(Clone, Copy, Debug, Default)]
pub struct BuildOptions {
    /// What to build.
    pub structure: Structure,
    /// How much the build may spend.
    pub quality: Quality,
    /// How hits are decided and computed.
    pub precision: Precision,
    /// The most that queries may use.
    pub isa: Isa,
    /// 0: all that the machine has.
    pub thread_count: u32,
    /// What happens to triangles that are not finite.
    pub invalid_triangles: InvalidTriangles,
    /// What the build may hold at a time; 0: no limit.
    pub memory_limit_bytes: u64,
    /// Whether a wide BVH stores each vertex of a leaf once: a third less memory, somewhat slower queries, the same
    /// answers.
    pub is_compact: bool,
    /// How many cells a grid has for each triangle, roughly; 0 or less, or NaN: what suits the quality.
    pub grid_cells_per_triangle: f32,
}
