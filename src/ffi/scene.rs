//! Scenes: built, asked about themselves, freed.

use super::builder::GnomonSceneBuilder;
use super::options::{GnomonBuildOptions, isa_number, precision_number, structure_number};
use super::pointers::{output, output_slice, required};
use super::status::{Failure, GNOMON_OK, GnomonStatus, caught, guard, report};
use super::types::GnomonSceneStats;
use crate::scene::Scene;

/// An immutable scene; any number of threads may query it at a time.
pub struct GnomonScene(pub(super) Scene);

/// Builds a scene from all meshes and spheres of a builder; the builder stays as it is and may build again. Without any
/// the scene is empty: every ray misses.
///
/// `options` may be NULL for the defaults. `scene_out` gets the scene, to be freed with `gnomon_scene_free`; it is
/// not touched on an error. Threads: see `thread_count`. Other threads may build other scenes, and query this
/// builder's earlier ones, meanwhile.
///
/// Errors: `GNOMON_ERROR_INVALID_ARGUMENT` for a null pointer, an unknown number in the options, or a triangle that
/// is not finite (unless it is to be skipped; the message names the geometry, the triangle and the vertex), or such a
/// sphere;
/// `GNOMON_ERROR_OUT_OF_MEMORY`; `GNOMON_ERROR_CANCELLED`; `GNOMON_ERROR_INTERNAL`.
///
/// # Safety
/// `builder` is null or from `gnomon_scene_builder_new`, and no other thread changes it; `options` is null
/// or filled in; `scene_out` is null or writable.
#[unsafe(no_mangle)]
pub unsafe extern "C-unwind" fn gnomon_scene_build(
    builder: *const GnomonSceneBuilder,
    options: *const GnomonBuildOptions,
    scene_out: *mut *mut GnomonScene,
) -> GnomonStatus {
    let prepared = caught(|| {
        // SAFETY: the caller's promise.
        let builder = unsafe { required(builder, "builder") }?;
        // SAFETY: the caller's promise.
        let scene_out = unsafe { output(scene_out, "scene_out") }?;
        // SAFETY: the caller's promise.
        let options = unsafe { GnomonBuildOptions::read(options) }?;
        Ok((builder, options.parse()?, options.progress, options.progress_user, scene_out))
    });
    let built = prepared.and_then(|(builder, options, progress, user, scene_out)| {
        let scene = match progress {
            None => caught(|| Ok(builder.0.build(&options)?))?,
            // Not inside caught(): a C++ exception from the callback must meet no frame that catches.
            Some(progress) => builder.0.build_watched(&options, &mut |done| progress(user, done))?,
        };
        scene_out.write(Box::into_raw(Box::new(GnomonScene(scene))));
        Ok(())
    });
    built.map_or_else(report, |()| GNOMON_OK)
}

/// Frees a scene. NULL is fine.
///
/// # Safety
/// `scene` is null or from `gnomon_scene_build` and not freed yet; no thread queries it.
#[unsafe(no_mangle)]
pub unsafe extern "C-unwind" fn gnomon_scene_free(scene: *mut GnomonScene) {
    guard(|| {
        if !scene.is_null() {
            // SAFETY: it came from Box::into_raw in gnomon_scene_build, and goes only here.
            drop(unsafe { Box::from_raw(scene) });
        }
        Ok(())
    });
}

/// The box of all triangles and spheres that were not skipped, those of zero area among them; a sphere's rounded outward. Without any, lower is `INFINITY`
/// and upper `-INFINITY`.
///
/// `lower_out` and `upper_out` get three floats each (x, y, z), exact. Errors: `GNOMON_ERROR_INVALID_ARGUMENT` for a
/// null pointer. Any thread may call this.
///
/// # Safety
/// `scene` is null or from `gnomon_scene_build`; the outputs are null or have room for three floats each.
/// cbindgen:ptrs-as-arrays=[[lower_out;3],[upper_out;3]]
#[unsafe(no_mangle)]
pub unsafe extern "C-unwind" fn gnomon_scene_bounds(
    scene: *const GnomonScene,
    lower_out: *mut f32,
    upper_out: *mut f32,
) -> GnomonStatus {
    guard(|| {
        // SAFETY: the caller's promise.
        let scene = unsafe { required(scene, "scene") }?;
        // SAFETY: the caller's promise.
        let lower_out = unsafe { output_slice(lower_out, 3, "lower_out") }?;
        // SAFETY: the caller's promise.
        let upper_out = unsafe { output_slice(upper_out, 3, "upper_out") }?;
        let bounds = scene.0.bounds();
        for axis in 0..3 {
            lower_out[axis].write(bounds.lower[axis]);
            upper_out[axis].write(bounds.upper[axis]);
        }
        Ok(())
    })
}

/// What a scene is made of and what its build took.
///
/// Writes the first `stats_bytes` bytes: pass `sizeof(GnomonSceneStats)`, and a program compiled against an older
/// header gets the fields that it knows; bytes beyond those that this library knows become 0. Errors:
/// `GNOMON_ERROR_INVALID_ARGUMENT` for a null pointer. Any thread may call this.
///
/// # Safety
/// `scene` is null or from `gnomon_scene_build`; `stats_out` is null or has room for `stats_bytes` bytes.
#[unsafe(no_mangle)]
pub unsafe extern "C-unwind" fn gnomon_scene_stats(
    scene: *const GnomonScene,
    stats_bytes: usize,
    stats_out: *mut GnomonSceneStats,
) -> GnomonStatus {
    guard(|| {
        // SAFETY: the caller's promise.
        let scene = unsafe { required(scene, "scene") }?;
        if stats_out.is_null() {
            return Err(Failure::invalid("stats_out is null"));
        }
        // SAFETY: the caller's promise; bytes may be written to any address.
        let bytes_out = unsafe { output_slice(stats_out.cast::<u8>(), stats_bytes, "stats_out") }?;
        let stats = GnomonSceneStats::from(&scene.0.stats());
        let known = stats_bytes.min(size_of::<GnomonSceneStats>());
        for place in &mut bytes_out[known..] {
            place.write(0);
        }
        // SAFETY: `known` bytes are readable in the one and writable in the other; the struct has no padding.
        unsafe { std::ptr::copy_nonoverlapping((&raw const stats).cast(), bytes_out.as_mut_ptr().cast::<u8>(), known) };
        Ok(())
    })
}

impl From<&crate::accel::Stats> for GnomonSceneStats {
    fn from(stats: &crate::accel::Stats) -> Self {
        Self {
            triangle_count: stats.triangle_count,
            node_count: stats.node_count,
            leaf_count: stats.leaf_count,
            reference_count: stats.reference_count,
            skipped_count: stats.skipped_count,
            depth: stats.depth,
            structure: structure_number(stats.structure),
            precision: precision_number(stats.precision),
            isa: isa_number(stats.isa),
            bytes: stats.bytes,
            node_bytes: stats.node_bytes,
            leaf_bytes: stats.leaf_bytes,
            peak_build_bytes: stats.peak_build_bytes,
            build_seconds: stats.build_seconds,
            sah_cost: stats.sah_cost,
            sphere_count: stats.sphere_count,
        }
    }
}
