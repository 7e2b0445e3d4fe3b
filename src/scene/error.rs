//! Why there is no scene, or no point of it.

use thiserror::Error;

use crate::accel::{BuildFailure, OutOfMemory};

/// Each variant says the cause, its fields the values; its text is one sentence.
#[derive(Clone, Debug, Error, PartialEq)]
#[expect(missing_docs, reason = "the texts say it, and the fields are named in them")]
pub enum BuildError {
    #[error(
        "geometry {geometry_id}, triangle {primitive_id}: index {index} is out of range, there are {vertex_count} vertices"
    )]
    IndexOutOfRange { geometry_id: u32, primitive_id: usize, index: u32, vertex_count: usize },

    #[error("geometry {geometry_id}: {triangle_count} triangles without indices need {} vertices, there are {vertex_count}",
            3 * *triangle_count as u128)]
    TooFewVertices { geometry_id: u32, triangle_count: usize, vertex_count: usize },

    #[error("geometry {geometry_id}: {count} {what} are more than the {limit} that an id can tell apart")]
    TooMany { geometry_id: u32, what: &'static str, count: usize, limit: usize },

    #[error("the scene has {count} {what}, more than the {limit} that an id can tell apart")]
    TooManyInScene { what: &'static str, count: usize, limit: usize },

    #[error(
        "geometry {geometry_id}, triangle {primitive_id}: the coordinates ({}, {}, {}) of vertex {vertex} are not all finite",
        position[0], position[1], position[2]
    )]
    NotFinite { geometry_id: u32, primitive_id: u32, vertex: u32, position: [f32; 3] },

    #[error(
        "geometry {geometry_id}, sphere {primitive_id}: centre ({}, {}, {}) and radius {radius} must be finite, the radius not below 0",
        centre[0], centre[1], centre[2]
    )]
    InvalidSphere { geometry_id: u32, primitive_id: u32, centre: [f32; 3], radius: f32 },

    #[error("the build was cancelled by the progress callback")]
    Cancelled,

    #[error("the build would hold {needed} bytes, more than the limit of {limit}")]
    OverMemoryLimit { needed: usize, limit: usize },

    #[error("the allocation of {bytes} bytes failed")]
    OutOfMemory { bytes: usize },

    #[error("the threads of the build could not be started: {0}")]
    Threads(String),

    #[error("the build stopped by a bug in the library: {0}")]
    Internal(String),
}

impl From<BuildFailure> for BuildError {
    fn from(failure: BuildFailure) -> Self {
        match failure {
            BuildFailure::Cancelled => Self::Cancelled,
            BuildFailure::OverLimit { needed, limit } => Self::OverMemoryLimit { needed, limit },
            BuildFailure::TooManyTriangles { count, limit } => Self::TooManyInScene { what: "triangles", count, limit },
            BuildFailure::OutOfMemory { bytes } => Self::OutOfMemory { bytes },
        }
    }
}

/// Why there is no point of a surface, or no origin to leave it from; as [`BuildError`].
#[derive(Clone, Debug, Error, PartialEq)]
#[expect(missing_docs, reason = "the texts say it, and the fields are named in them")]
pub enum SurfaceError {
    #[error("hit is a miss, and names no surface")]
    Miss,

    #[error("ray is not valid, so that it hits nothing")]
    InvalidRay,

    #[error("geometry {geometry_id}, primitive {primitive_id}: the scene has none that a ray could hit")]
    NotInScene { geometry_id: u32, primitive_id: u32 },

    #[error("geometry {geometry_id}, primitive {primitive_id}: the ray passes it, so hit is not this ray's")]
    Passed { geometry_id: u32, primitive_id: u32 },

    #[error("direction ({}, {}, {}) is not finite, or zero", direction[0], direction[1], direction[2])]
    NoDirection { direction: [f32; 3] },

    #[error("point is not as gnomon_surface_point gives it, or lies where floats end")]
    NoOrigin,

    #[error(transparent)]
    OutOfMemory(#[from] OutOfMemory),
}
