//! Queries: one ray, or many.

use std::panic::{AssertUnwindSafe, catch_unwind};

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
