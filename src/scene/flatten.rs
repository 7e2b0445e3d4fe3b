//! References to the triangles that a ray can hit, in the order of their ids.

use std::sync::Arc;

use glam::Vec3;

use super::builder::Geometry;
use super::{BuildError, InvalidTriangles};
use crate::accel::{Bounds8, BuildContext, PrimitiveSource, Reference};
use crate::geometry::{Aabb, INVALID_ID, Triangle};
use crate::simd::{Simd, SimdKernel};

/// All meshes as one list of triangles.
pub(super) struct Meshes<'a> {
    geometries: &'a [Arc<Geometry>],
    starts: Vec<u32>,
}

pub(super) struct Flat {
    pub(super) references: Vec<Reference>,
    pub(super) bounds: Aabb,
    pub(super) skipped_count: usize,
}

impl<'a> Meshes<'a> {
    pub(super) fn new(geometries: &'a [Arc<Geometry>]) -> Result<Self, BuildError> {
        // A structure's references are u32, and so is the count of them.
        const LIMIT: usize = u32::MAX as usize;
        let count = geometries.iter().map(|geometry| geometry.triangles.len()).sum();
        if count > LIMIT {
            return Err(BuildError::TooManyInScene { what: "triangles", count, limit: LIMIT });
        }
        let mut starts = vec![0];
        for geometry in geometries {
            starts.push(starts[starts.len() - 1] + geometry.triangles.len() as u32);
        }
        Ok(Self { geometries, starts })
    }

    pub(super) fn triangle_count(&self) -> usize {
        self.starts[self.geometries.len()] as usize
    }

    /// The geometry that has the triangle of that number in the list.
    fn geometry_of(&self, number: u32) -> Cursor<'a> {
        let id = self.starts.partition_point(|&start| start <= number) - 1;
        Cursor { geometry_id: id as u32, start: self.starts[id], geometry: &self.geometries[id] }
    }
}

impl PrimitiveSource for Meshes<'_> {
    type Primitive = Triangle;

    #[inline(always)]
    fn primitive(&self, geometry_id: u32, primitive_id: u32) -> Triangle {
        let geometry = &self.geometries[geometry_id as usize];
        let vertices = geometry.vertices(geometry.triangles[primitive_id as usize]);
        Triangle::new(vertices, geometry_id, primitive_id)
    }

    fn starts(&self) -> &[u32] {
        &self.starts
    }
}

/// A geometry and the number of its first triangle.
#[derive(Clone, Copy)]
struct Cursor<'a> {
    geometry_id: u32,
    start: u32,
    geometry: &'a Geometry,
}

/// The reference to a triangle that a ray can hit, else one of those that [`Census`] counts.
#[inline(always)]
fn reference(cursor: &Cursor, primitive_id: u32) -> Reference {
    let vertices = cursor.geometry.vertices(cursor.geometry.triangles[primitive_id as usize]);
    let triangle = Triangle::new(vertices, cursor.geometry_id, primitive_id);
    let bounds = triangle.bounds();
    // A NaN as soon as one coordinate is not finite.
    let zero: f32 = triangle.axes.iter().flatten().map(|coordinate| coordinate * 0.0).sum();
    if zero != 0.0 {
        Reference::new(&Aabb::EMPTY, INVALID_ID, primitive_id)
    } else if triangle.has_zero_area() {
        Reference::new(&bounds, INVALID_ID, primitive_id)
    } else {
        Reference::new(&bounds, cursor.geometry_id, primitive_id)
    }
}

/// What there is among references; those with an invalid geometry refer to triangles of zero area, or, where their
/// boxes are empty, to such as are not finite.
#[derive(Clone, Copy)]
struct Census {
    bounds: Bounds8,
    zero_area_count: usize,
    not_finite_count: usize,
}

impl Census {
    const NONE: Self = Self { bounds: Bounds8::EMPTY, zero_area_count: 0, not_finite_count: 0 };

    fn union(mut self, other: Self) -> Self {
        self.bounds.grow(crate::simd::Scalar, &other.bounds);
        self.zero_area_count += other.zero_area_count;
        self.not_finite_count += other.not_finite_count;
        self
    }
}

struct Count<'a>(&'a [Reference]);

impl SimdKernel for Count<'_> {
    type Output = Census;

    #[inline(always)]
    fn run<S: Simd>(self, simd: S) -> Census {
        let mut census = Census::NONE;
        for reference in self.0 {
            census.bounds.grow(simd, reference.bounds());
            if reference.geometry_id() == INVALID_ID {
                let is_empty = is_not_finite(reference);
                census.not_finite_count += usize::from(is_empty);
                census.zero_area_count += usize::from(!is_empty);
            }
        }
        census
    }
}

fn is_not_finite(reference: &Reference) -> bool {
    reference.bounds().to_aabb() == Aabb::EMPTY
}

pub(super) fn flatten(
    meshes: &Meshes,
    invalid_triangles: InvalidTriangles,
    context: &BuildContext,
) -> Result<Flat, BuildError> {
    let mut references = context.reserve(meshes.triangle_count())?;
    context.collect_with(
        &mut references,
        meshes.starts[meshes.geometries.len()],
        |number| meshes.geometry_of(number),
        |cursor: &mut Cursor, number| {
            if number.wrapping_sub(cursor.start) as usize >= cursor.geometry.triangles.len() {
                *cursor = meshes.geometry_of(number);
            }
            reference(cursor, number - cursor.start)
        },
    );
    context.check()?;
    let census = context.reduce_chunks(&references, |chunk| context.vectorize(Count(chunk)), Census::union);
    let census = census.unwrap_or(Census::NONE);
    let skipped_count = census.not_finite_count;
    if invalid_triangles == InvalidTriangles::Reject
        && skipped_count > 0
        && let Some(first) = references.iter().position(is_not_finite)
    {
        return Err(not_finite(&meshes.geometry_of(first as u32), first as u32));
    }
    if census.zero_area_count + census.not_finite_count > 0 {
        references.retain(|reference| reference.geometry_id() != INVALID_ID);
    }
    Ok(Flat { references, bounds: census.bounds.to_aabb(), skipped_count })
}

fn not_finite(cursor: &Cursor, number: u32) -> BuildError {
    let primitive_id = number - cursor.start;
    let positions = &cursor.geometry.positions;
    let vertex = cursor.geometry.triangles[primitive_id as usize]
        .into_iter()
        .find(|&index| !Vec3::from_array(positions[index as usize]).is_finite())
        .expect("a triangle that is not finite has such a vertex");
    BuildError::NotFinite {
        geometry_id: cursor.geometry_id,
        primitive_id,
        vertex,
        position: positions[vertex as usize],
    }
}
