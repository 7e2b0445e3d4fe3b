//! Collects a caller's meshes and spheres, copied and with their indices checked.

use std::sync::Arc;

use super::{BuildError, BuildOptions, Scene, build, watched_build};
use crate::accel::Watch;
use crate::geometry::{INVALID_ID, IndexView, SphereView, TriangleView};

/// What one id stands for.
pub(super) enum Geometry {
    Mesh(Mesh),
    /// Centres and radii, which may be anything.
    Spheres(Vec<([f32; 3], f32)>),
}

/// A mesh as the builder keeps it: every index is in range. Coordinates may be anything.
pub(super) struct Mesh {
    pub(super) positions: Vec<[f32; 3]>,
    pub(super) triangles: Vec<[u32; 3]>,
}

/// Meshes and spheres on their way to a [`Scene`]; can be built any number of times.
#[derive(Default)]
pub struct SceneBuilder {
    geometries: Vec<Arc<Geometry>>,
}

impl SceneBuilder {
    /// Without any geometry.
    pub fn new() -> Self {
        Self::default()
    }

    /// Copies a mesh and returns its `geometry_id`, the number of geometries before it. On an error the builder is as it
    /// was.
    pub fn add_triangles(&mut self, mesh: &TriangleView) -> Result<u32, BuildError> {
        self.add(|geometry_id| Mesh::copy(geometry_id, mesh).map(Geometry::Mesh))
    }

    /// As [`SceneBuilder::add_triangles`] for spheres. One of radius 0 is hit by nothing.
    pub fn add_spheres(&mut self, spheres: &SphereView) -> Result<u32, BuildError> {
        self.add(|geometry_id| copy_spheres(geometry_id, spheres).map(Geometry::Spheres))
    }

    fn add(&mut self, copy: impl FnOnce(u32) -> Result<Geometry, BuildError>) -> Result<u32, BuildError> {
        let limit = INVALID_ID as usize;
        let count = self.geometries.len();
        if count >= limit {
            return Err(BuildError::TooManyInScene { what: "geometries", count: count + 1, limit });
        }
        let geometry_id = count as u32;
        let geometry = copy(geometry_id)?;
        self.geometries
            .try_reserve(1)
            .map_err(|_| BuildError::OutOfMemory { bytes: (count + 1) * size_of::<Arc<Geometry>>() })?;
        self.geometries.push(Arc::new(geometry));
        Ok(geometry_id)
    }

    /// Builds a scene; the builder stays as it is.
    pub fn build(&self, options: &BuildOptions) -> Result<Scene, BuildError> {
        build::build(&self.geometries, options, &Watch::default())
    }

    /// Builds on another thread while the calling one reports the share that is done, in `[0, 1]` and never falling,
    /// to `on_progress`; `false` from it cancels the build. An unwinding `on_progress` cancels the build as well and
    /// passes through.
    pub fn build_watched(
        &self,
        options: &BuildOptions,
        on_progress: &mut dyn FnMut(f64) -> bool,
    ) -> Result<Scene, BuildError> {
        watched_build::build_watched(self.geometries.clone(), *options, on_progress)
    }
}

impl Geometry {
    /// None among spheres.
    pub(super) fn mesh(&self) -> Option<&Mesh> {
        match self {
            Self::Mesh(mesh) => Some(mesh),
            Self::Spheres(_) => None,
        }
    }

    /// None in a mesh.
    pub(super) fn spheres(&self) -> &[([f32; 3], f32)] {
        match self {
            Self::Mesh(_) => &[],
            Self::Spheres(spheres) => spheres,
        }
    }

    pub(super) fn triangle_count(&self) -> usize {
        self.mesh().map_or(0, |mesh| mesh.triangles.len())
    }
}

fn copy_spheres(geometry_id: u32, spheres: &SphereView) -> Result<Vec<([f32; 3], f32)>, BuildError> {
    let (count, limit) = (spheres.count(), INVALID_ID as usize);
    if count > limit {
        return Err(BuildError::TooMany { geometry_id, what: "spheres", count, limit });
    }
    let mut copies = reserve(count)?;
    copies.extend(spheres.iter());
    Ok(copies)
}

impl Mesh {
    fn copy(geometry_id: u32, mesh: &TriangleView) -> Result<Self, BuildError> {
        let limit = INVALID_ID as usize;
        let (vertex_count, triangle_count) = (mesh.positions.count(), mesh.indices.triangle_count());
        for (what, count) in [("vertices", vertex_count), ("triangles", triangle_count)] {
            if count > limit {
                return Err(BuildError::TooMany { geometry_id, what, count, limit });
            }
        }
        if let IndexView::Consecutive { .. } = mesh.indices
            && vertex_count / 3 < triangle_count
        {
            return Err(BuildError::TooFewVertices { geometry_id, triangle_count, vertex_count });
        }
        let mut positions = reserve(vertex_count)?;
        let mut triangles = reserve(triangle_count)?;
        positions.extend(mesh.positions.iter());
        for primitive_id in 0..triangle_count {
            let triangle = mesh.indices.triangle(primitive_id);
            if let Some(&index) = triangle.iter().find(|&&index| index as usize >= vertex_count) {
                return Err(BuildError::IndexOutOfRange { geometry_id, primitive_id, index, vertex_count });
            }
            triangles.push(triangle);
        }
        Ok(Self { positions, triangles })
    }

    pub(super) fn vertices(&self, triangle: [u32; 3]) -> [[f32; 3]; 3] {
        triangle.map(|index| self.positions[index as usize])
    }
}

fn reserve<T>(count: usize) -> Result<Vec<T>, BuildError> {
    let mut vector = Vec::new();
    vector
        .try_reserve_exact(count)
        .map_err(|_| BuildError::OutOfMemory { bytes: count.saturating_mul(size_of::<T>()) })?;
    Ok(vector)
}
