//! One list of the triangles that a ray can hit, with their ids, in the order of the ids.

use std::sync::Arc;

use glam::Vec3;
use rayon::prelude::*;

use super::builder::Geometry;
use super::{BuildError, InvalidTriangles};
use crate::accel::{BuildContext, BuildFailure};
use crate::geometry::{Aabb, Triangle};

pub(super) struct Flat {
    pub(super) triangles: Vec<Triangle>,
    pub(super) bounds: Aabb,
    pub(super) skipped_count: usize,
}

#[derive(Clone, Copy, PartialEq)]
enum Kind {
    Hittable,
    /// A valid triangle that nothing hits.
    ZeroArea,
    NotFinite,
}

impl Kind {
    fn of(triangle: &Triangle) -> Self {
        if !triangle.axes.iter().flatten().all(|coordinate| coordinate.is_finite()) {
            Self::NotFinite
        } else if triangle.has_zero_area() {
            Self::ZeroArea
        } else {
            Self::Hittable
        }
    }
}

pub(super) fn flatten(
    geometries: &[Arc<Geometry>],
    invalid_triangles: InvalidTriangles,
    context: &BuildContext,
) -> Result<Flat, BuildError> {
    // A structure's references are u32, and so is the count of them.
    const LIMIT: usize = u32::MAX as usize;
    let count = geometries.iter().map(|geometry| geometry.triangles.len()).sum();
    if count > LIMIT {
        return Err(BuildError::TooManyInScene { what: "triangles", count, limit: LIMIT });
    }
    let mut triangles = gather(geometries, count, context)?;
    let kinds = classify(&triangles, context)?;

    let skipped_count = kinds.iter().filter(|&&kind| kind == Kind::NotFinite).count();
    if invalid_triangles == InvalidTriangles::Reject
        && let Some(first) = kinds.iter().position(|&kind| kind == Kind::NotFinite)
    {
        return Err(not_finite(geometries, &triangles[first]));
    }
    let bounds = bounds(&triangles, &kinds, context);
    let mut kinds_left = kinds.iter();
    triangles.retain(|_| kinds_left.next() == Some(&Kind::Hittable));
    context.release(kinds);
    Ok(Flat { triangles, bounds, skipped_count })
}

fn gather(geometries: &[Arc<Geometry>], count: usize, context: &BuildContext) -> Result<Vec<Triangle>, BuildFailure> {
    /// Below this a geometry is not worth a task.
    const LEAST_PARALLEL: usize = 1 << 14;
    let mut triangles = context.reserve(count)?;
    for (geometry_id, geometry) in (0u32..).zip(geometries) {
        let triangle = |(primitive_id, &indices): (usize, &[u32; 3])| {
            Triangle::new(geometry.vertices(indices), geometry_id, primitive_id as u32)
        };
        if context.is_parallel() && geometry.triangles.len() >= LEAST_PARALLEL {
            triangles.par_extend(geometry.triangles.par_iter().enumerate().map(triangle));
        } else {
            triangles.extend(geometry.triangles.iter().enumerate().map(triangle));
        }
    }
    Ok(triangles)
}

fn classify(triangles: &[Triangle], context: &BuildContext) -> Result<Vec<Kind>, BuildFailure> {
    let mut kinds = context.reserve(triangles.len())?;
    if context.is_parallel() {
        kinds.par_extend(triangles.par_iter().map(Kind::of));
    } else {
        kinds.extend(triangles.iter().map(Kind::of));
    }
    Ok(kinds)
}

fn bounds(triangles: &[Triangle], kinds: &[Kind], context: &BuildContext) -> Aabb {
    let box_of = |(triangle, &kind): (&Triangle, &Kind)| match kind {
        Kind::NotFinite => Aabb::EMPTY,
        Kind::Hittable | Kind::ZeroArea => triangle.bounds(),
    };
    if context.is_parallel() {
        triangles.par_iter().zip(kinds).map(box_of).reduce(|| Aabb::EMPTY, Aabb::union)
    } else {
        triangles.iter().zip(kinds).map(box_of).fold(Aabb::EMPTY, Aabb::union)
    }
}

fn not_finite(geometries: &[Arc<Geometry>], triangle: &Triangle) -> BuildError {
    let geometry = &geometries[triangle.geometry_id as usize];
    let indices = geometry.triangles[triangle.primitive_id as usize];
    let vertex = indices
        .into_iter()
        .find(|&index| !Vec3::from_array(geometry.positions[index as usize]).is_finite())
        .expect("a triangle that is not finite has such a vertex");
    BuildError::NotFinite {
        geometry_id: triangle.geometry_id,
        primitive_id: triangle.primitive_id,
        vertex,
        position: geometry.positions[vertex as usize],
    }
}
