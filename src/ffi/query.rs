//! Queries: one ray, or many; a point.

use std::panic::{AssertUnwindSafe, catch_unwind};

use glam::Vec3;

use super::options::GnomonQueryOptions;
use super::pointers::{Null, output, output_slice, required, slice};
use super::scene::GnomonScene;
use super::status::{Failure, GnomonStatus, guard, panicked, report};
use super::types::{GnomonHit, GnomonRay, GnomonRayCounts};
use crate::geometry::{Hit, Ray};

/// The closest hit of a ray: true if there is one, and `hit_out` gets it; false for a miss, and `hit_out` says so.
///
/// Accuracy: see `GNOMON_PRECISION_*`; the answer is the same on every instruction set and in every structure, and
/// `gnomon_occluded` never disagrees. Any number of threads may call this on one scene. A null pointer answers false
/// and sets `gnomon_last_error`; `hit_out` then is not touched.
///
/// # Safety
/// `scene` is null or from `gnomon_scene_build`; `ray` is null or readable; `hit_out` is null or writable.
#[unsafe(no_mangle)]
pub unsafe extern "C-unwind" fn gnomon_intersect(
    scene: *const GnomonScene,
    ray: *const GnomonRay,
    hit_out: *mut GnomonHit,
) -> bool {
    answer(|| {
        // SAFETY: the caller's promise.
        let scene = unsafe { required(scene, "scene") }?;
        // SAFETY: the caller's promise.
        let ray = unsafe { required(ray, "ray") }?;
        // SAFETY: the caller's promise.
        let hit_out = unsafe { output(hit_out, "hit_out") }?;
        Ok(scene.0.intersect_then(ray, |hit| {
            GnomonHit::write(&hit, hit_out);
            hit.is_hit()
        }))
    })
}

/// As `gnomon_intersect`, with the same answer to the bit, and `counts_out` gets what finding it took: for comparing
/// structures and for finding out why rays are slow.
///
/// A ray that is not valid takes nothing. Any number of threads may call this on one scene. A null pointer answers false
/// and sets `gnomon_last_error`; `hit_out` and `counts_out` then are not touched.
///
/// # Safety
/// `scene` is null or from `gnomon_scene_build`; `ray` is null or readable; `hit_out` and `counts_out` are null or
/// writable, and do not overlap.
#[unsafe(no_mangle)]
pub unsafe extern "C-unwind" fn gnomon_intersect_counted(
    scene: *const GnomonScene,
    ray: *const GnomonRay,
    hit_out: *mut GnomonHit,
    counts_out: *mut GnomonRayCounts,
) -> bool {
    answer(|| {
        // SAFETY: the caller's promise.
        let scene = unsafe { required(scene, "scene") }?;
        // SAFETY: the caller's promise.
        let ray = unsafe { required(ray, "ray") }?;
        // SAFETY: the caller's promise.
        let hit_out = unsafe { output(hit_out, "hit_out") }?;
        // SAFETY: the caller's promise.
        let counts_out = unsafe { output(counts_out, "counts_out") }?;
        let (hit, counts) = scene.0.intersect_counted(&ray.into());
        hit_out.write(hit.into());
        counts_out.write(counts.into());
        Ok(hit.is_hit())
    })
}

/// Whether a ray hits anything at all: for shadows and visibility.
///
/// True just where `gnomon_intersect` is, and usually faster. Any number of threads may call this on one scene. A null
/// pointer answers false and sets `gnomon_last_error`.
///
/// # Safety
/// `scene` is null or from `gnomon_scene_build`; `ray` is null or readable.
#[unsafe(no_mangle)]
pub unsafe extern "C-unwind" fn gnomon_occluded(scene: *const GnomonScene, ray: *const GnomonRay) -> bool {
    answer(|| {
        // SAFETY: the caller's promise.
        let scene = unsafe { required(scene, "scene") }?;
        // SAFETY: the caller's promise.
        let ray = unsafe { required(ray, "ray") }?;
        Ok(scene.0.occluded_by(ray))
    })
}

/// As `gnomon_intersect` for each of `count` rays, with the same answers to the bit, shared out among threads.
///
/// `hits_out` gets one hit a ray, in the rays' order; the two arrays must not overlap. `options` may be NULL for the
/// defaults. `count` 0 is fine, the arrays then may be NULL.
///
/// Errors: `GNOMON_ERROR_INVALID_ARGUMENT` for a null pointer, an array that is not aligned for floats, or a count
/// that no memory can hold; nothing is written then. Any number of threads may call this on one scene.
///
/// # Safety
/// `scene` is null or from `gnomon_scene_build`; `rays` and `hits_out` are null or have `count` elements;
/// `options` is null or filled in.
#[unsafe(no_mangle)]
pub unsafe extern "C-unwind" fn gnomon_intersect_n(
    scene: *const GnomonScene,
    rays: *const GnomonRay,
    count: usize,
    hits_out: *mut GnomonHit,
    options: *const GnomonQueryOptions,
) -> GnomonStatus {
    guard(|| {
        // SAFETY: the caller's promise.
        let scene = unsafe { required(scene, "scene") }?;
        // SAFETY: the caller's promise; a Ray has a GnomonRay's layout.
        let rays = unsafe { slice(rays.cast::<Ray>(), count, "rays") }?;
        // SAFETY: the caller's promise; a Hit has a GnomonHit's layout.
        let hits_out = unsafe { output_slice(hits_out.cast::<Hit>(), count, "hits_out") }?;
        // SAFETY: the caller's promise.
        let options = unsafe { GnomonQueryOptions::read(options) }?;
        scene.0.intersect_n(rays, hits_out, options.thread_count);
        Ok(())
    })
}

/// As `gnomon_occluded` for each of `count` rays, shared out among threads.
///
/// `occluded_out` gets one byte a ray, 1 where it hits anything and 0 where not; the two arrays must not overlap. The
/// rest is as for `gnomon_intersect_n`.
///
/// # Safety
/// `scene` is null or from `gnomon_scene_build`; `rays` and `occluded_out` are null or have `count`
/// elements; `options` is null or filled in.
#[unsafe(no_mangle)]
pub unsafe extern "C-unwind" fn gnomon_occluded_n(
    scene: *const GnomonScene,
    rays: *const GnomonRay,
    count: usize,
    occluded_out: *mut u8,
    options: *const GnomonQueryOptions,
) -> GnomonStatus {
    guard(|| {
        // SAFETY: the caller's promise.
        let scene = unsafe { required(scene, "scene") }?;
        // SAFETY: the caller's promise; a Ray has a GnomonRay's layout.
        let rays = unsafe { slice(rays.cast::<Ray>(), count, "rays") }?;
        // SAFETY: the caller's promise; a bool is a byte, 0 or 1.
        let occluded_out = unsafe { output_slice(occluded_out.cast::<bool>(), count, "occluded_out") }?;
        // SAFETY: the caller's promise.
        let options = unsafe { GnomonQueryOptions::read(options) }?;
        scene.0.occluded_n(rays, occluded_out, options.thread_count);
        Ok(())
    })
}

/// The hits of a ray, as many as there is room for: those that come first, or first after one that is known.
///
/// They come in the order in which hits win: by `t`, then `geometry_id`, then `primitive_id`; in `GNOMON_PRECISION_EXACT` those
/// whose `t` differ only before they are rounded keep the order of the exact ones. `hits_out` has room for `capacity` hits,
/// and `count_out` gets how many are written: if fewer, there are no more; else call again with `&hits_out[capacity - 1]` as
/// `after` for those that follow. NULL begins with what `gnomon_intersect` gives, to the bit. There is a hit just where
/// `gnomon_occluded` is true.
///
/// Each triangle is there at most once, also where the ray passes an edge or a vertex that several share: then each of them
/// that the ray hits is there. Triangles that are the same are each there. A sphere is there where the ray enters and where
/// it leaves it, once where both have the same `t`. A ray that is not valid has no hits.
///
/// Crossings can be counted with this as long as no ray meets an edge: from inside of a closed mesh there is an odd number of
/// hits up to `INFINITY`. But a ray through a shared edge may hit both triangles, though it passes one surface, and one that
/// runs within a face hits nothing of it. `gnomon_contains_point` is right for every point.
///
/// `after` must be a hit of the same ray in the same scene. The call keeps 56 bytes for a hit, at most for three times as many
/// as are asked for; with `after`, for all that have its `t`. Any number of threads may call this on one scene.
///
/// Errors: `GNOMON_ERROR_INVALID_ARGUMENT` for a null pointer (`hits_out` may be NULL for a `capacity` of 0), an array that is
/// not aligned for floats, or a capacity that no memory can hold; `GNOMON_ERROR_OUT_OF_MEMORY`. Nothing is written then.
///
/// # Safety
/// `scene` is null or from `gnomon_scene_build`; `ray` and `after` are null or readable; `hits_out` is null or has room for
/// `capacity` hits; `count_out` is null or writable, and not among the hits.
#[unsafe(no_mangle)]
pub unsafe extern "C-unwind" fn gnomon_intersect_all(
    scene: *const GnomonScene,
    ray: *const GnomonRay,
    after: *const GnomonHit,
    capacity: usize,
    hits_out: *mut GnomonHit,
    count_out: *mut usize,
) -> GnomonStatus {
    guard(|| {
        // SAFETY: the caller's promise.
        let scene = unsafe { required(scene, "scene") }?;
        // SAFETY: the caller's promise.
        let ray = unsafe { required(ray, "ray") }?;
        // A copy, because it may be one of those that are written over.
        // SAFETY: the caller's promise; a Hit has a GnomonHit's layout.
        let after = unsafe { after.cast::<Hit>().as_ref() }.copied();
        // SAFETY: the caller's promise; as above.
        let hits_out = unsafe { output_slice(hits_out.cast::<Hit>(), capacity, "hits_out") }?;
        // SAFETY: the caller's promise.
        let count_out = unsafe { output(count_out, "count_out") }?;
        count_out.write(scene.0.intersect_all(&ray.into(), after.as_ref(), hits_out)?);
        Ok(())
    })
}

/// Whether a point is inside of closed meshes and spheres: whether a line that begins there leaves them an odd number of
/// times.
///
/// Exact for every finite point, in every structure and precision, also where lines from it run through edges and vertices
/// or along faces. A point on a triangle or a sphere counts as inside; one that is not finite is outside.
///
/// The triangles of the whole scene count as one surface. It is closed where each edge belongs to an even number of
/// triangles, with the same end points to the bit (-0 is 0), in whichever meshes these are. How triangles are wound makes
/// no difference. Where closed meshes or spheres overlap or are nested, what is inside of an even number of them is
/// outside; triangles that are there twice cancel. Triangles of zero area do not count. If the surface is not
/// closed, the answer is what the half-line towards +x crosses.
///
/// `point` has three floats (x, y, z); `inside_out` gets the answer. Errors: `GNOMON_ERROR_INVALID_ARGUMENT` for a null
/// pointer; `GNOMON_ERROR_OUT_OF_MEMORY`. Any number of threads may call this on one scene.
///
/// Source: Edelsbrunner and Muecke 1990, "Simulation of simplicity: a technique to cope with degenerate cases in geometric
/// algorithms", ACM TOG 9(1).
///
/// # Safety
/// `scene` is null or from `gnomon_scene_build`; `point` is null or has three floats; `inside_out` is null or writable.
/// cbindgen:ptrs-as-arrays=[[point;3]]
#[unsafe(no_mangle)]
pub unsafe extern "C-unwind" fn gnomon_contains_point(
    scene: *const GnomonScene,
    point: *const f32,
    inside_out: *mut bool,
) -> GnomonStatus {
    guard(|| {
        // SAFETY: the caller's promise.
        let scene = unsafe { required(scene, "scene") }?;
        // SAFETY: the caller's promise.
        let point = unsafe { slice(point, 3, "point") }?;
        // SAFETY: the caller's promise.
        let inside_out = unsafe { output(inside_out, "inside_out") }?;
        inside_out.write(scene.0.contains_point(Vec3::new(point[0], point[1], point[2]))?);
        Ok(())
    })
}

/// A query's answer; false after a failure, which is kept for `gnomon_last_error`.
#[inline(always)]
fn answer(query: impl FnOnce() -> Result<bool, Null>) -> bool {
    match catch_unwind(AssertUnwindSafe(query)) {
        Ok(Ok(answer)) => answer,
        Ok(Err(null)) => no_answer(|| null.into()),
        Err(panic) => no_answer(move || panicked(&*panic)),
    }
}

/// Out of line, so that a query that fails in nothing saves no registers for this.
#[cold]
#[inline(never)]
fn no_answer(failure: impl FnOnce() -> Failure) -> bool {
    report(failure());
    false
}
