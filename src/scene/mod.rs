//! From a caller's meshes and spheres to an immutable scene that answers queries.

mod all_hits;
mod batch;
mod both;
mod build;
mod builder;
mod error;
mod flatten;
mod options;
mod query;
mod surface_point;
mod threads;
mod watched_build;

pub use builder::SceneBuilder;
pub use error::{BuildError, SurfaceError};
pub use options::{BuildOptions, InvalidTriangles};
pub use surface_point::SurfacePoint;
pub(crate) use threads::run_workers;

use crate::accel::{AnyAccel, Copies, Places, Precision, Stats};
use crate::geometry::{Aabb, Sphere, Triangle};
use crate::simd::DetectedIsa;

/// An immutable scene; any number of threads may query it.
pub struct Scene {
    content: Content,
    copies: Copies,
    precision: Precision,
    isa: DetectedIsa,
    bounds: Aabb,
    stats: Stats,
    triangle_places: Places,
    sphere_places: Places,
}

/// One structure for each kind of primitive that there is, so that a kernel knows one kind.
enum Content {
    Triangles(AnyAccel<Triangle>),
    Spheres(AnyAccel<Sphere>),
    Both(Box<(AnyAccel<Triangle>, AnyAccel<Sphere>)>),
}

impl Scene {
    /// The box of all triangles and spheres that are not skipped, those of zero area among them; [`Aabb::EMPTY`] without any.
    pub fn bounds(&self) -> Aabb {
        self.bounds
    }

    /// What decides hits.
    pub fn precision(&self) -> Precision {
        self.precision
    }

    /// What the build made, and what the scene holds now.
    pub fn stats(&self) -> Stats {
        let place_bytes = self.triangle_places.bytes() + self.sphere_places.bytes();
        Stats { bytes: self.stats.bytes + place_bytes as u64, ..self.stats }
    }
}
