//! The scene builder: meshes and spheres come in.

use std::slice;

use super::pointers::{output, required};
use super::status::{Failure, GnomonStatus, caught, guard, report};
use super::types::{GNOMON_INDEX_U16, GNOMON_INDEX_U32, GnomonSpheres, GnomonTriangles};
use crate::geometry::{IndexBytes, IndexView, PositionView, SphereView, TriangleView, span_bytes};
use crate::scene::SceneBuilder;

/// Collects meshes and spheres; belongs to one thread at a time.
pub struct GnomonSceneBuilder(pub(super) SceneBuilder);

/// An empty builder, to be freed with `gnomon_scene_builder_free`. NULL if memory ran out.
#[unsafe(no_mangle)]
pub extern "C-unwind" fn gnomon_scene_builder_new() -> *mut GnomonSceneBuilder {
    match caught(|| Ok(Box::into_raw(Box::new(GnomonSceneBuilder(SceneBuilder::new()))))) {
        Ok(builder) => builder,
        Err(failure) => {
            report(failure);
            std::ptr::null_mut()
        }
    }
}

/// Copies a mesh into the builder; the caller's arrays may go afterwards.
///
/// `geometry_id_out` gets the mesh's id: 0 for the first, 1 for the second, and so on. It may be NULL. Coordinates
/// are not looked at before the build, which decides by `invalid_triangles` about those that are not finite.
///
/// Errors: `GNOMON_ERROR_INVALID_ARGUMENT` for a null pointer, an unknown index format, a stride that is too small,
/// counts that no memory can hold, or an index out of range (the message names the geometry, the triangle, the index,
/// and how many vertices there are); `GNOMON_ERROR_OUT_OF_MEMORY`. On an error the builder is as it was.
///
/// # Safety
/// `builder` is null or from `gnomon_scene_builder_new`, and no other thread uses it; `triangles` is null or describes
/// readable memory; `geometry_id_out` is null or writable.
#[unsafe(no_mangle)]
pub unsafe extern "C-unwind" fn gnomon_scene_builder_add_triangles(
    builder: *mut GnomonSceneBuilder,
    triangles: *const GnomonTriangles,
    geometry_id_out: *mut u32,
) -> GnomonStatus {
    guard(|| {
        // SAFETY: the caller's promise; the builder is his alone.
        let builder = unsafe { builder.as_mut() }.ok_or_else(|| Failure::invalid("builder is null"))?;
        // SAFETY: the caller's promise.
        let triangles = unsafe { required(triangles, "triangles") }?;
        // SAFETY: the caller's promise.
        let view = unsafe { triangle_view(triangles) }?;
        let geometry_id = builder.0.add_triangles(&view)?;
        if !geometry_id_out.is_null() {
            // SAFETY: the caller's promise.
            unsafe { output(geometry_id_out, "geometry_id_out") }?.write(geometry_id);
        }
        Ok(())
    })
}

/// Copies spheres into the builder; the caller's arrays may go afterwards.
///
/// `geometry_id_out` gets their id, from the same count as those of meshes; it may be NULL. Spheres are surfaces: a ray
/// from inside hits the far side. Hits are decided exactly, in every precision; `t` is within 0.51 ulp; `u` and `v` are 0; the
/// normal points from the centre to the hit and is as long as the radius. Centres and radii are not looked at before the
/// build, which decides by `invalid_triangles` about those that are not finite, and about radii below 0. A sphere of
/// radius 0 is valid and never hit. A scene without spheres pays nothing for them.
///
/// Source: Haines, Guenther, Akenine-Moeller 2019, "Precision improvements for ray/sphere intersection", Ray Tracing Gems,
/// chapter 7.
///
/// Errors: `GNOMON_ERROR_INVALID_ARGUMENT` for a null pointer, a stride that is too small, or a count that no memory can
/// hold; `GNOMON_ERROR_OUT_OF_MEMORY`. On an error the builder is as it was.
///
/// # Safety
/// `builder` is null or from `gnomon_scene_builder_new`, and no other thread uses it; `spheres` is null or describes
/// readable memory; `geometry_id_out` is null or writable.
#[unsafe(no_mangle)]
pub unsafe extern "C-unwind" fn gnomon_scene_builder_add_spheres(
    builder: *mut GnomonSceneBuilder,
    spheres: *const GnomonSpheres,
    geometry_id_out: *mut u32,
) -> GnomonStatus {
    guard(|| {
        // SAFETY: the caller's promise; the builder is his alone.
        let builder = unsafe { builder.as_mut() }.ok_or_else(|| Failure::invalid("builder is null"))?;
        // SAFETY: the caller's promise.
        let spheres = unsafe { required(spheres, "spheres") }?;
        // SAFETY: the caller's promise.
        let view = unsafe { sphere_view(spheres) }?;
        let geometry_id = builder.0.add_spheres(&view)?;
        if !geometry_id_out.is_null() {
            // SAFETY: the caller's promise.
            unsafe { output(geometry_id_out, "geometry_id_out") }?.write(geometry_id);
        }
        Ok(())
    })
}

/// Frees a builder; scenes built from it stay. NULL is fine.
///
/// # Safety
/// `builder` is null or from `gnomon_scene_builder_new` and not freed yet; no other thread uses it.
#[unsafe(no_mangle)]
pub unsafe extern "C-unwind" fn gnomon_scene_builder_free(builder: *mut GnomonSceneBuilder) {
    guard(|| {
        if !builder.is_null() {
            // SAFETY: it came from Box::into_raw in gnomon_scene_builder_new, and goes only here.
            drop(unsafe { Box::from_raw(builder) });
        }
        Ok(())
    });
}

/// # Safety
/// Where the pointers are not null, the memory that the counts and strides span is readable and stays as it is.
pub(super) unsafe fn triangle_view(mesh: &GnomonTriangles) -> Result<TriangleView<'_>, Failure> {
    let stride = stride("position_stride", mesh.position_stride, PositionView::ELEMENT_BYTES)?;
    // SAFETY: the caller's promise.
    let positions = unsafe { positions("positions", mesh.positions, mesh.vertex_count, stride) }?;
    if mesh.indices.is_null() {
        return Ok(TriangleView { positions, indices: IndexView::Consecutive { triangle_count: mesh.triangle_count } });
    }
    let indices = match mesh.index_format {
        // SAFETY: the caller's promise.
        GNOMON_INDEX_U16 => IndexView::U16(unsafe { index_bytes(mesh) }?),
        // SAFETY: the caller's promise.
        GNOMON_INDEX_U32 => IndexView::U32(unsafe { index_bytes(mesh) }?),
        other => return Err(Failure::invalid(format!("index_format is {other}, which has no meaning"))),
    };
    Ok(TriangleView { positions, indices })
}

/// # Safety
/// `pointer` is null, or the span of the positions from it on is readable and stays as it is.
unsafe fn positions<'a>(
    name: &str,
    pointer: *const f32,
    count: usize,
    stride: usize,
) -> Result<PositionView<'a>, Failure> {
    // SAFETY: the caller's promise.
    let bytes = unsafe { bytes(name, pointer.cast(), count, stride, PositionView::ELEMENT_BYTES) }?;
    Ok(PositionView::new(bytes, stride, count).expect("the bytes are the span of count and stride"))
}

/// # Safety
/// Where the pointers are not null, the memory that the count and strides span is readable and stays as it is.
unsafe fn sphere_view(spheres: &GnomonSpheres) -> Result<SphereView<'_>, Failure> {
    let (count, radius_bytes) = (spheres.sphere_count, SphereView::RADIUS_BYTES);
    let centre_stride = stride("centre_stride", spheres.centre_stride, PositionView::ELEMENT_BYTES)?;
    let radius_stride = stride("radius_stride", spheres.radius_stride, radius_bytes)?;
    // SAFETY: the caller's promise.
    let centres = unsafe { positions("centres", spheres.centres, count, centre_stride) }?;
    // SAFETY: the caller's promise.
    let radii = unsafe { bytes("radii", spheres.radii.cast(), count, radius_stride, radius_bytes) }?;
    Ok(SphereView::new(centres, radii, radius_stride).expect("the bytes are the span of count and stride"))
}

/// # Safety
/// `mesh.indices` is not null, and what the count and stride span is readable and stays as it is.
unsafe fn index_bytes<const WIDTH: usize>(mesh: &GnomonTriangles) -> Result<IndexBytes<'_, WIDTH>, Failure> {
    let element_bytes = IndexBytes::<WIDTH>::ELEMENT_BYTES;
    let stride = stride("index_stride", mesh.index_stride, element_bytes)?;
    // SAFETY: the caller's promise.
    let bytes = unsafe { bytes("indices", mesh.indices.cast(), mesh.triangle_count, stride, element_bytes) }?;
    Ok(IndexBytes::new(bytes, stride, mesh.triangle_count).expect("the bytes are the span of count and stride"))
}

fn stride(name: &str, stride: usize, element_bytes: usize) -> Result<usize, Failure> {
    match stride {
        0 => Ok(element_bytes),
        stride if stride < element_bytes => {
            Err(Failure::invalid(format!("{name} is {stride}, less than the {element_bytes} bytes of one element")))
        }
        stride => Ok(stride),
    }
}

/// # Safety
/// `pointer` is null, or the span of the elements from it on is readable and stays as it is.
unsafe fn bytes<'a>(
    name: &str,
    pointer: *const u8,
    count: usize,
    stride: usize,
    element_bytes: usize,
) -> Result<&'a [u8], Failure> {
    let Some(length) = span_bytes(count, stride, element_bytes) else {
        return Err(Failure::invalid(format!("{name}: {count} elements, {stride} bytes apart, do not fit in memory")));
    };
    if length == 0 {
        return Ok(&[]);
    }
    if pointer.is_null() {
        return Err(Failure::invalid(format!("{name} is null, but the count is {count}")));
    }
    // SAFETY: not null, at most isize::MAX bytes, and readable by the caller's promise.
    Ok(unsafe { slice::from_raw_parts(pointer, length) })
}
