//! The pieces of spheres and triangles that a receiver sees shine: how much each sends, were nothing in the way, and a random way there.

use arrayvec::ArrayVec;
use glam::DVec3;

use super::direction::finite;
use super::error::RadiometryError;
use super::lambert::{above_horizon, projected_polygon_sr, projected_sphere_sr};
use super::quantity::Luminance;
use super::sampling::{DirectionSample, sample_cone, sample_triangle};
use super::source::{AreaSource, Receiver, Sources, SphereSource, not_negative};
use crate::geometry::IndexView;

/// All that shines upon a receiver and has an extent. Positions are relative to the receiver.
pub(super) struct Patches {
    normal: DVec3,
    patches: Vec<Patch>,
    total: f64,
}

struct Patch {
    shape: Shape,
    luminance: Luminance,
    /// What it sends where nothing hides it [lx], and with all before it.
    illuminance_lx: f64,
    sum_lx: f64,
}

enum Shape {
    Triangle([DVec3; 3]),
    Sphere { centre: DVec3, radius: f64 },
}

/// A random way towards a source.
pub(super) struct PatchSample {
    /// From the receiver, of unit length.
    pub(super) to_source: DVec3,
    /// How far the source is in that direction.
    pub(super) distance: f64,
    /// Its mean over all samples is the total [lx].
    pub(super) weight: f64,
    /// Not of a sphere.
    pub(super) is_of_triangle: bool,
}

impl Patches {
    pub(super) fn of(sources: &Sources, receiver: &Receiver) -> Result<Self, RadiometryError> {
        let mut patches = Self { normal: receiver.normal, patches: Vec::new(), total: 0.0 };
        for (index, sphere) in sources.spheres.iter().enumerate() {
            patches.add_sphere(sphere, receiver).map_err(|cause| cause.of_source("sphere", index))?;
        }
        for (index, area) in sources.areas.iter().enumerate() {
            patches.add_area(area, receiver).map_err(|cause| cause.of_source("area", index))?;
        }
        Ok(patches)
    }

    /// What all send, were nothing in the way [lx].
    pub(super) fn total(&self) -> f64 {
        self.total
    }

    fn add_sphere(&mut self, sphere: &SphereSource, receiver: &Receiver) -> Result<(), RadiometryError> {
        let luminance = Luminance::new(not_negative("luminance_nt", sphere.luminance_nt)?);
        let radius = not_negative("radius", sphere.radius)?;
        let centre = finite("centre", sphere.centre.to_array())? - receiver.point;
        let projected_sr = projected_sphere_sr(DVec3::ZERO, self.normal, centre, radius);
        self.add(Shape::Sphere { centre, radius }, luminance, projected_sr)
    }

    fn add_area(&mut self, area: &AreaSource, receiver: &Receiver) -> Result<(), RadiometryError> {
        let luminance = Luminance::new(not_negative("luminance_nt", area.luminance_nt)?);
        let (vertex_count, triangle_count) =
            (area.triangles.positions.count(), area.triangles.indices.triangle_count());
        if let IndexView::Consecutive { .. } = area.triangles.indices
            && vertex_count / 3 < triangle_count
        {
            return Err(RadiometryError::TooFewVertices { triangle_count, vertex_count });
        }
        for triangle in 0..triangle_count {
            let vertices = vertices(area, triangle).map_err(|cause| cause.of_triangle(triangle))?;
            self.add_triangle(vertices.map(|vertex| vertex - receiver.point), area.is_two_sided, luminance)?;
        }
        Ok(())
    }

    /// Its part above the horizon, where that shines this way.
    fn add_triangle(
        &mut self,
        vertices: [DVec3; 3],
        is_two_sided: bool,
        luminance: Luminance,
    ) -> Result<(), RadiometryError> {
        let [a, b, c] = vertices;
        // 0 where it is seen end on, or has no area.
        let height = -(b - a).cross(c - a).dot(a);
        if !(height > 0.0 || is_two_sided && height < 0.0) {
            return Ok(());
        }
        let part: ArrayVec<DVec3, 4> = above_horizon(self.normal, vertices);
        for corner in 2..part.len() {
            let piece = [part[0], part[corner - 1], part[corner]];
            let projected_sr = projected_polygon_sr(DVec3::ZERO, self.normal, &piece);
            self.add(Shape::Triangle(piece), luminance, projected_sr)?;
        }
        Ok(())
    }

    fn add(&mut self, shape: Shape, luminance: Luminance, projected_sr: f64) -> Result<(), RadiometryError> {
        let illuminance_lx = luminance.irradiance(projected_sr).value();
        let sends = illuminance_lx > 0.0; // false for a NaN
        if !sends {
            return Ok(());
        }
        let count = self.patches.len() + 1;
        self.patches
            .try_reserve(1)
            .map_err(|_| RadiometryError::OutOfMemory { what: "triangles of sources", count })?;
        self.total += illuminance_lx;
        self.patches.push(Patch { shape, luminance, illuminance_lx, sum_lx: self.total });
        Ok(())
    }

    /// From three numbers, uniform in [0, 1). There must be a patch.
    pub(super) fn sample(&self, [choice, u, v]: [f64; 3]) -> PatchSample {
        let sum_lx = choice * self.total;
        let index = self.patches.partition_point(|patch| patch.sum_lx <= sum_lx).min(self.patches.len() - 1);
        let patch = &self.patches[index];
        let sample = patch.shape.sample(u, v);
        let cosine = self.normal.dot(sample.direction).max(0.0);
        let sent = patch.luminance.irradiance(cosine / sample.density_per_sr).value();
        PatchSample {
            to_source: sample.direction,
            distance: patch.shape.distance(sample.direction.as_vec3().as_dvec3()),
            weight: sent / patch.illuminance_lx * self.total,
            is_of_triangle: matches!(patch.shape, Shape::Triangle(_)),
        }
    }
}

impl Shape {
    fn sample(&self, u: f64, v: f64) -> DirectionSample {
        match *self {
            Self::Triangle(vertices) => sample_triangle(DVec3::ZERO, vertices, u, v),
            Self::Sphere { centre, radius } => {
                let distance = centre.length();
                sample_cone(centre / distance, (radius / distance).asin(), u, v)
            }
        }
    }

    /// Where a ray of that direction meets it, or passes it nearest, in lengths of the direction.
    fn distance(&self, direction: DVec3) -> f64 {
        match *self {
            Self::Triangle([a, b, c]) => {
                let normal = (b - a).cross(c - a);
                normal.dot(a) / normal.dot(direction)
            }
            Self::Sphere { centre, radius } => {
                let square = direction.length_squared();
                let nearest = centre.dot(direction) / square;
                let beside = centre - nearest * direction;
                let depth = ((radius * radius - beside.length_squared()) / square).max(0.0).sqrt();
                nearest - depth
            }
        }
    }
}

fn vertices(area: &AreaSource, triangle: usize) -> Result<[DVec3; 3], RadiometryError> {
    let vertex_count = area.triangles.positions.count();
    let [a, b, c] = area.triangles.indices.triangle(triangle).map(|index| {
        let position = area.triangles.positions.get(index as usize);
        position.ok_or(RadiometryError::IndexOutOfRange { index, vertex_count }).and_then(|at| finite("vertex", at))
    });
    Ok([a?, b?, c?])
}
