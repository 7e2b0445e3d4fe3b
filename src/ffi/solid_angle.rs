//! How much of the sphere of directions a shape covers.

use super::pointers::{output, required, slice};
use super::status::{Failure, GnomonStatus, guard, number_or_nan};
use crate::radiometry::{
    box_sr, cap_sr, cone_sr, differential_sr, finite, patch_sr, polygon_sr, sphere_sr, triangle_sr,
};

/// `sin(theta) dtheta dphi`, the solid angle of a small patch at the angle theta from the pole [sr]. Any thread may call this, as
/// all of these.
#[unsafe(no_mangle)]
pub extern "C-unwind" fn gnomon_differential_solid_angle_sr(theta_rad: f64, dtheta_rad: f64, dphi_rad: f64) -> f64 {
    differential_sr(theta_rad, dtheta_rad, dphi_rad)
}

/// The integral of that over a patch of latitude and longitude [sr]; as precise for thin patches as for wide ones.
#[unsafe(no_mangle)]
pub extern "C-unwind" fn gnomon_patch_solid_angle_sr(
    theta_min_rad: f64,
    theta_max_rad: f64,
    phi_min_rad: f64,
    phi_max_rad: f64,
) -> f64 {
    patch_sr(theta_min_rad, theta_max_rad, phi_min_rad, phi_max_rad)
}

/// Of a circular cone around an axis: `2 pi (1 - cos)`, without cancellation [sr]; a NaN unless the half angle is in [0, pi].
#[unsafe(no_mangle)]
pub extern "C-unwind" fn gnomon_cone_solid_angle_sr(half_angle_rad: f64) -> f64 {
    cone_sr(half_angle_rad)
}

/// Of a cap of a sphere, seen from the sphere's centre: `2 pi height / radius` [sr]; a NaN unless the height is in [0, 2 radius].
#[unsafe(no_mangle)]
pub extern "C-unwind" fn gnomon_cap_solid_angle_sr(height: f64, radius: f64) -> f64 {
    cap_sr(height, radius)
}

/// Of a sphere whose centre is that far away [sr]: 4 pi from inside, 2 pi from its surface; a NaN where either is negative or a NaN.
#[unsafe(no_mangle)]
pub extern "C-unwind" fn gnomon_sphere_solid_angle_sr(distance: f64, radius: f64) -> f64 {
    sphere_sr(distance, radius)
}

/// Of a triangle, seen from a point [sr]: 0 to 2 pi, whichever way round its vertices a, b, c go; 2 pi from a point inside it, 0 from one of
/// its plane outside it.
///
/// Relative error some 2^-50; within a distance d of an edge, the vertices r away, an absolute one of 2^-50 r / d. A null pointer or
/// a coordinate that is not finite gives a NaN and sets `gnomon_last_error`.
///
/// Source: Van Oosterom and Strackee 1983, "The solid angle of a plane triangle", equation 8.
///
/// # Safety
/// Each pointer is null or has three floats.
/// cbindgen:ptrs-as-arrays=[[point;3],[a;3],[b;3],[c;3]]
#[unsafe(no_mangle)]
pub unsafe extern "C-unwind" fn gnomon_triangle_solid_angle_sr(
    point: *const f32,
    a: *const f32,
    b: *const f32,
    c: *const f32,
) -> f64 {
    number_or_nan(|| {
        // SAFETY: the caller's promise, here and below.
        let point = finite("point", *unsafe { required(point.cast(), "point") }?)?;
        // SAFETY: see above.
        let a = finite("a", *unsafe { required(a.cast(), "a") }?)?;
        // SAFETY: see above.
        let b = finite("b", *unsafe { required(b.cast(), "b") }?)?;
        // SAFETY: see above.
        let c = finite("c", *unsafe { required(c.cast(), "c") }?)?;
        Ok(triangle_sr(point, [a, b, c]))
    })
}

/// Of a planar polygon, which may be concave, seen from a point [sr].
///
/// `vertices` has three floats (x, y, z) for each of the `vertex_count` vertices, in order around the border; fewer than three cover
/// nothing. A border that is not planar counts each direction as often as it goes around it, up to multiples of 4 pi. Accuracy: as a fan
/// of triangles, see `gnomon_triangle_solid_angle_sr`.
///
/// Errors: `GNOMON_ERROR_INVALID_ARGUMENT` for a null pointer, a coordinate that is not finite, or a count that no memory can hold;
/// `GNOMON_ERROR_OUT_OF_MEMORY`.
///
/// # Safety
/// `point` is null or has three floats; `vertices` is null or has three floats a vertex; `solid_angle_sr_out` is null or writable.
/// cbindgen:ptrs-as-arrays=[[point;3]]
#[unsafe(no_mangle)]
pub unsafe extern "C-unwind" fn gnomon_polygon_solid_angle_sr(
    point: *const f32,
    vertices: *const f32,
    vertex_count: usize,
    solid_angle_sr_out: *mut f64,
) -> GnomonStatus {
    guard(|| {
        // SAFETY: the caller's promise.
        let point = finite("point", *unsafe { required(point.cast(), "point") }?)?;
        // SAFETY: the caller's promise.
        let vertices = unsafe { slice(vertices.cast::<[f32; 3]>(), vertex_count, "vertices") }?;
        // SAFETY: the caller's promise.
        let solid_angle_sr_out = unsafe { output(solid_angle_sr_out, "solid_angle_sr_out") }?;
        let mut wide = Vec::new();
        wide.try_reserve_exact(vertex_count)
            .map_err(|_| Failure::out_of_memory(format!("there is no memory for {vertex_count} vertices")))?;
        for (index, &vertex) in vertices.iter().enumerate() {
            let vertex =
                finite("position", vertex).map_err(|cause| Failure::from(cause).within(&format!("vertex {index}")))?;
            wide.push(vertex);
        }
        solid_angle_sr_out.write(polygon_sr(point, &wide));
        Ok(())
    })
}

/// Of an axis-aligned box, seen from a point [sr]: 4 pi from inside, 2 pi from a face, pi from an edge, pi / 2 from a corner. A box with
/// `lower` above `upper` on an axis covers nothing. Accuracy and bad input: as `gnomon_triangle_solid_angle_sr`.
///
/// # Safety
/// Each pointer is null or has three floats.
/// cbindgen:ptrs-as-arrays=[[point;3],[lower;3],[upper;3]]
#[unsafe(no_mangle)]
pub unsafe extern "C-unwind" fn gnomon_box_solid_angle_sr(
    point: *const f32,
    lower: *const f32,
    upper: *const f32,
) -> f64 {
    number_or_nan(|| {
        // SAFETY: the caller's promise, here and below.
        let point = finite("point", *unsafe { required(point.cast(), "point") }?)?;
        // SAFETY: see above.
        let lower = finite("lower", *unsafe { required(lower.cast(), "lower") }?)?;
        // SAFETY: see above.
        let upper = finite("upper", *unsafe { required(upper.cast(), "upper") }?)?;
        Ok(box_sr(point, lower, upper))
    })
}
