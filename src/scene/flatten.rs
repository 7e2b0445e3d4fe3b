//! References to what a ray can hit, in the order of the ids.

use std::sync::Arc;

use glam::Vec3;

use super::builder::{Geometry, Mesh};
use super::{BuildError, InvalidTriangles};
use crate::accel::{Bounds8, BuildContext, PrimitiveSource, Reference};
use crate::geometry::{Aabb, INVALID_ID, Sphere, Triangle};
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
        let starts = starts(geometries, "triangles", Geometry::triangle_count)?;
        Ok(Self { geometries, starts })
    }

    pub(super) fn triangle_count(&self) -> usize {
        self.starts[self.geometries.len()] as usize
    }

    /// The geometry that has the triangle of that number in the list.
    fn geometry_of(&self, number: u32) -> Cursor<'a> {
        let id = self.starts.partition_point(|&start| start <= number) - 1;
        let mesh = self.geometries[id].mesh().expect("only meshes have triangles");
        Cursor { geometry_id: id as u32, start: self.starts[id], mesh }
    }
}

/// For each geometry how many there are in those before it; then in all.
fn starts(
    geometries: &[Arc<Geometry>],
    what: &'static str,
    count: impl Fn(&Geometry) -> usize,
) -> Result<Vec<u32>, BuildError> {
    // A structure's references are u32, and so is the count of them.
    const LIMIT: usize = u32::MAX as usize;
    let mut starts = vec![0];
    let mut total = 0usize;
    for geometry in geometries {
        total = total.saturating_add(count(geometry));
        starts.push(total as u32);
    }
    if total > LIMIT { Err(BuildError::TooManyInScene { what, count: total, limit: LIMIT }) } else { Ok(starts) }
}

impl PrimitiveSource for Meshes<'_> {
    type Primitive = Triangle;

    #[inline(always)]
    fn primitive(&self, geometry_id: u32, primitive_id: u32) -> Triangle {
        let mesh = self.geometries[geometry_id as usize].mesh().expect("only meshes have triangles");
        let vertices = mesh.vertices(mesh.triangles[primitive_id as usize]);
        Triangle::new(vertices, geometry_id, primitive_id)
    }

    fn starts(&self) -> &[u32] {
        &self.starts
    }
}

/// A mesh and the number of its first triangle.
#[derive(Clone, Copy)]
struct Cursor<'a> {
    geometry_id: u32,
    start: u32,
    mesh: &'a Mesh,
}

/// The reference to a triangle that a ray can hit, else one of those that [`Census`] counts.
#[inline(always)]
fn reference(cursor: &Cursor, primitive_id: u32) -> Reference {
    let vertices = cursor.mesh.vertices(cursor.mesh.triangles[primitive_id as usize]);
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
    if meshes.triangle_count() == 0 {
        return Ok(Flat { references, bounds: Aabb::EMPTY, skipped_count: 0 });
    }
    context.collect_with(
        &mut references,
        meshes.starts[meshes.geometries.len()],
        |number| meshes.geometry_of(number),
        |cursor: &mut Cursor, number| {
            if number.wrapping_sub(cursor.start) as usize >= cursor.mesh.triangles.len() {
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
    let positions = &cursor.mesh.positions;
    let vertex = cursor.mesh.triangles[primitive_id as usize]
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

/// All spheres.
pub(super) struct Balls<'a> {
    geometries: &'a [Arc<Geometry>],
    starts: Vec<u32>,
}

impl<'a> Balls<'a> {
    pub(super) fn new(geometries: &'a [Arc<Geometry>]) -> Result<Self, BuildError> {
        let starts = starts(geometries, "spheres", |geometry| geometry.spheres().len())?;
        Ok(Self { geometries, starts })
    }

    pub(super) fn count(&self) -> usize {
        self.starts[self.geometries.len()] as usize
    }

    /// References to the spheres that a ray can hit; those of radius 0 are none. A radius below 0 is as one that is not
    /// finite.
    pub(super) fn flatten(&self, invalid: InvalidTriangles, context: &BuildContext) -> Result<Flat, BuildError> {
        let mut references = context.reserve(self.count())?;
        let (mut bounds, mut skipped_count) = (Aabb::EMPTY, 0);
        for (geometry_id, geometry) in (0..).zip(self.geometries) {
            context.check()?;
            for (primitive_id, &(centre, radius)) in (0..).zip(geometry.spheres()) {
                let sphere = Sphere { centre, radius, geometry_id, primitive_id };
                if !sphere.is_valid() {
                    if invalid == InvalidTriangles::Reject {
                        return Err(BuildError::InvalidSphere { geometry_id, primitive_id, centre, radius });
                    }
                    skipped_count += 1;
                    continue;
                }
                let inside = sphere.bounds();
                bounds = bounds.union(inside);
                if radius > 0.0 {
                    references.push(Reference::new(&inside, geometry_id, primitive_id));
                }
            }
        }
        Ok(Flat { references, bounds, skipped_count })
    }
}

impl PrimitiveSource for Balls<'_> {
    type Primitive = Sphere;

    fn primitive(&self, geometry_id: u32, primitive_id: u32) -> Sphere {
        let (centre, radius) = self.geometries[geometry_id as usize].spheres()[primitive_id as usize];
        Sphere { centre, radius, geometry_id, primitive_id }
    }

    fn starts(&self) -> &[u32] {
        &self.starts
    }
}
