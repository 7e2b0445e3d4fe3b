//! Where rays hit, and where others leave from.

use super::options::{precision, precision_number, unknown};
use super::pointers::{output, required};
use super::scene::GnomonScene;
use super::status::{Failure, GnomonStatus, guard};
use super::types::{GNOMON_SURFACE_SPHERE, GNOMON_SURFACE_TRIANGLE, GnomonHit, GnomonRay, GnomonSurfacePoint};
use crate::accel::AnyPrimitive;
use crate::geometry::{Hit, INVALID_ID, Sphere, Triangle};
use crate::scene::SurfacePoint;

/// Where a ray hit: the point, a bound on its error, and the normal. `hit` is what this scene answered to `ray`.
///
/// The point is computed anew from the ray and the surface, not from `hit`, of which the ids count, and `t` to tell a sphere's
/// two sides apart. The scene does not look for them: the first call makes a table of 4 bytes for each triangle and sphere,
/// which stays with the scene and counts among its `bytes`; a scene that is never asked has none.
///
/// Errors: `GNOMON_ERROR_INVALID_ARGUMENT` for a null pointer, a hit that is a miss, a ray that is not valid, ids of what this
/// scene does not have or no ray can hit, and a ray that does not hit what they name; `GNOMON_ERROR_OUT_OF_MEMORY` where there
/// is no room for the table. Accuracy: see `GnomonSurfacePoint`; the same in every structure, precision and instruction set.
/// Any number of threads may call this on one scene, the first call among them.
///
/// # Safety
/// `scene` is null or from `gnomon_scene_build`; `ray` and `hit` are null or readable; `point_out` is null or writable.
#[unsafe(no_mangle)]
pub unsafe extern "C-unwind" fn gnomon_surface_point(
    scene: *const GnomonScene,
    ray: *const GnomonRay,
    hit: *const GnomonHit,
    point_out: *mut GnomonSurfacePoint,
) -> GnomonStatus {
    guard(|| {
        // SAFETY: the caller's promise.
        let scene = unsafe { required(scene, "scene") }?;
        // SAFETY: the caller's promise.
        let ray = unsafe { required(ray, "ray") }?;
        // SAFETY: the caller's promise; a Hit has a GnomonHit's layout.
        let hit = unsafe { required(hit.cast::<Hit>(), "hit") }?;
        // SAFETY: the caller's promise.
        let point_out = unsafe { output(point_out, "point_out") }?;
        point_out.write((&scene.0.surface_point(&ray.into(), hit)?).into());
        Ok(())
    })
}

/// The origin of a ray that leaves a surface with that direction and `t_min` 0, and does not hit it again.
///
/// `origin_out` gets three floats (x, y, z) strictly on that side of the exact surface that `direction` leads to: its plane's
/// for a triangle, inside or outside for a sphere. A direction exactly along the surface leads to the side of the normal, or out
/// of the sphere. The origin is off the surface by `error`, with 2^-40 of the surface's size and a rounding, and by more only
/// where a triangle's own test, of the scene's precision, would still take the ray for a hit, because the ray passes an edge by less
/// than the test's rounding: then by as much as it takes.
///
/// What is promised: the ray from `origin_out` with this `direction`, to the bit, `t_min` 0 and any `t_max` does not hit the
/// surface that it leaves; into a sphere it hits it once, where it leaves the sphere. A direction that is computed from the
/// origin, towards a light for example, is as good in EXACT as long as it leads to the same side. Of other surfaces nothing
/// is known here: one that touches or crosses this one nearer than the step may be hit at once, or lie behind the origin. Near
/// inner edges of huge triangles, where ACCURATE may take the neighbour, that can lead out of a closed mesh; FAST may pass a surface
/// that is nearer than its t rounds. In EXACT no ray did either.
///
/// Errors: `GNOMON_ERROR_INVALID_ARGUMENT` for a null pointer, a direction that is zero or not finite, a point that is not as
/// `gnomon_surface_point` gives it, or one so far out that no float lies beyond it. Needs no scene. Any thread may call this.
///
/// Sources: Waechter and Binder 2019, "A fast and robust method for avoiding self-intersection", Ray Tracing Gems, chapter 6;
/// Pharr, Jakob, Humphreys, "Physically Based Rendering", 4th edition, section 6.8.
///
/// # Safety
/// `point` is null or readable; `direction` is null or has three floats; `origin_out` is null or has room for three.
/// cbindgen:ptrs-as-arrays=[[direction;3],[origin_out;3]]
#[unsafe(no_mangle)]
pub unsafe extern "C-unwind" fn gnomon_offset_origin(
    point: *const GnomonSurfacePoint,
    direction: *const f32,
    origin_out: *mut f32,
) -> GnomonStatus {
    guard(|| {
        // SAFETY: the caller's promise.
        let point = unsafe { required(point, "point") }?;
        // SAFETY: the caller's promise.
        let direction = unsafe { required(direction.cast::<[f32; 3]>(), "direction") }?;
        // SAFETY: the caller's promise.
        let origin_out = unsafe { output(origin_out.cast::<[f32; 3]>(), "origin_out") }?;
        let origin = point.parse()?.offset_origin((*direction).into())?;
        origin_out.write(origin.to_array());
        Ok(())
    })
}

impl From<&SurfacePoint> for GnomonSurfacePoint {
    fn from(point: &SurfacePoint) -> Self {
        let (surface, shape) = match &point.surface {
            AnyPrimitive::Triangle(triangle) => {
                let mut vertices = [0.0; 9];
                vertices.copy_from_slice(triangle.vertices().as_flattened());
                (GNOMON_SURFACE_TRIANGLE, vertices)
            }
            &AnyPrimitive::Sphere(Sphere { centre: [x, y, z], radius, .. }) => {
                (GNOMON_SURFACE_SPHERE, [x, y, z, radius, 0.0, 0.0, 0.0, 0.0, 0.0])
            }
        };
        Self {
            position: point.position.to_array(),
            error: point.error.to_array(),
            normal: point.normal.to_array(),
            surface,
            precision: precision_number(point.precision),
            shape,
        }
    }
}

impl GnomonSurfacePoint {
    fn parse(&self) -> Result<SurfacePoint, Failure> {
        let [x, y, z, radius, ..] = self.shape;
        let surface = match self.surface {
            GNOMON_SURFACE_TRIANGLE => {
                let [a, b, c] = [0, 3, 6].map(|first| [0, 1, 2].map(|axis| self.shape[first + axis]));
                AnyPrimitive::Triangle(Triangle::new([a, b, c], INVALID_ID, INVALID_ID))
            }
            GNOMON_SURFACE_SPHERE => AnyPrimitive::Sphere(Sphere {
                centre: [x, y, z],
                radius,
                geometry_id: INVALID_ID,
                primitive_id: INVALID_ID,
            }),
            other => return Err(unknown("surface", other)),
        };
        Ok(SurfacePoint {
            position: self.position.into(),
            error: self.error.into(),
            normal: self.normal.into(),
            surface,
            precision: precision(self.precision)?,
        })
    }
}
