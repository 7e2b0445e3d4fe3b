//! Random directions with their densities.

use std::f64::consts::PI;

use super::pointers::{output, required};
use super::status::{Failure, GnomonStatus, guard};
use crate::radiometry::{
    DirectionSample, finite, sample_cone, sample_cosine_hemisphere, sample_hemisphere, sample_sphere, sample_triangle,
    unit,
};

/// A direction, and how densely its neighbourhood is sampled. 16 bytes.
///
/// Made from two independent numbers u and v, uniform in [0, 1]; other numbers than those are an error. Computed in double, each
/// component rounded once; the density is that of the direction before.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct GnomonDirectionSample {
    /// Of unit length.
    pub direction: [f32; 3],
    /// In 1/sr: it integrates to 1 over all directions. 0: there is nothing to sample.
    pub density_per_sr: f32,
}

const _: () = assert!(size_of::<GnomonDirectionSample>() == 16);

/// A direction uniform over the whole sphere: its density is `1 / 4 pi`. Any thread may call this, as all of these.
///
/// Errors: `GNOMON_ERROR_INVALID_ARGUMENT` for a null pointer, and u or v outside [0, 1].
///
/// # Safety
/// `sample_out` is null or writable.
#[unsafe(no_mangle)]
pub unsafe extern "C-unwind" fn gnomon_sample_sphere(
    u: f64,
    v: f64,
    sample_out: *mut GnomonDirectionSample,
) -> GnomonStatus {
    // SAFETY: the caller's promise.
    unsafe { sample(u, v, sample_out, || Ok(sample_sphere(u, v))) }
}

/// A direction uniform over the side of a normal: its density is `1 / 2 pi`. The normal may have any length.
///
/// Errors: as `gnomon_sample_sphere`, and a normal that is zero or not finite.
///
/// # Safety
/// `normal` is null or has three floats; `sample_out` is null or writable.
/// cbindgen:ptrs-as-arrays=[[normal;3]]
#[unsafe(no_mangle)]
pub unsafe extern "C-unwind" fn gnomon_sample_hemisphere(
    normal: *const f32,
    u: f64,
    v: f64,
    sample_out: *mut GnomonDirectionSample,
) -> GnomonStatus {
    let make = || {
        // SAFETY: the caller's promise.
        let normal = unit("normal", *unsafe { required(normal.cast(), "normal") }?)?;
        Ok(sample_hemisphere(normal, u, v))
    };
    // SAFETY: the caller's promise.
    unsafe { sample(u, v, sample_out, make) }
}

/// A direction on the side of a normal with the density `cosine / pi`: as a Lambertian surface scatters. Errors: as
/// `gnomon_sample_hemisphere`.
///
/// # Safety
/// `normal` is null or has three floats; `sample_out` is null or writable.
/// cbindgen:ptrs-as-arrays=[[normal;3]]
#[unsafe(no_mangle)]
pub unsafe extern "C-unwind" fn gnomon_sample_cosine_hemisphere(
    normal: *const f32,
    u: f64,
    v: f64,
    sample_out: *mut GnomonDirectionSample,
) -> GnomonStatus {
    let make = || {
        // SAFETY: the caller's promise.
        let normal = unit("normal", *unsafe { required(normal.cast(), "normal") }?)?;
        Ok(sample_cosine_hemisphere(normal, u, v))
    };
    // SAFETY: the caller's promise.
    unsafe { sample(u, v, sample_out, make) }
}

/// A direction uniform over a cone around an axis of any length: its density is one over `gnomon_cone_solid_angle_sr`.
///
/// Errors: as `gnomon_sample_hemisphere`, and a half angle that is not in (0, pi].
///
/// # Safety
/// `axis` is null or has three floats; `sample_out` is null or writable.
/// cbindgen:ptrs-as-arrays=[[axis;3]]
#[unsafe(no_mangle)]
pub unsafe extern "C-unwind" fn gnomon_sample_cone(
    axis: *const f32,
    half_angle_rad: f64,
    u: f64,
    v: f64,
    sample_out: *mut GnomonDirectionSample,
) -> GnomonStatus {
    let make = || {
        // SAFETY: the caller's promise.
        let axis = unit("axis", *unsafe { required(axis.cast(), "axis") }?)?;
        if !(half_angle_rad > 0.0 && half_angle_rad <= PI) {
            return Err(Failure::invalid(format!("half_angle_rad is {half_angle_rad}, not in (0, pi]")));
        }
        Ok(sample_cone(axis, half_angle_rad, u, v))
    };
    // SAFETY: the caller's promise.
    unsafe { sample(u, v, sample_out, make) }
}

/// A direction from a point towards a triangle, uniform in solid angle, for small triangles too: its density is one over
/// `gnomon_triangle_solid_angle_sr`; 0 where that is 0.
///
/// Rounded to float it may pass a triangle that it meets by less than the rounding. Errors: as `gnomon_sample_sphere`, and
/// coordinates that are not finite. Source: Arvo 1995, "Stratified sampling of spherical triangles"; Peters 2021, "BRDF importance
/// sampling for polygonal lights", section 4.
///
/// # Safety
/// `point`, `a`, `b` and `c` are null or have three floats; `sample_out` is null or writable.
/// cbindgen:ptrs-as-arrays=[[point;3],[a;3],[b;3],[c;3]]
#[unsafe(no_mangle)]
pub unsafe extern "C-unwind" fn gnomon_sample_triangle(
    point: *const f32,
    a: *const f32,
    b: *const f32,
    c: *const f32,
    u: f64,
    v: f64,
    sample_out: *mut GnomonDirectionSample,
) -> GnomonStatus {
    let make = || {
        // SAFETY: the caller's promise, here and below.
        let point = finite("point", *unsafe { required(point.cast(), "point") }?)?;
        // SAFETY: see above.
        let a = finite("a", *unsafe { required(a.cast(), "a") }?)?;
        // SAFETY: see above.
        let b = finite("b", *unsafe { required(b.cast(), "b") }?)?;
        // SAFETY: see above.
        let c = finite("c", *unsafe { required(c.cast(), "c") }?)?;
        Ok(sample_triangle(point, [a, b, c], u, v))
    };
    // SAFETY: the caller's promise.
    unsafe { sample(u, v, sample_out, make) }
}

/// # Safety
/// `sample_out` is null or writable.
unsafe fn sample(
    u: f64,
    v: f64,
    sample_out: *mut GnomonDirectionSample,
    make: impl FnOnce() -> Result<DirectionSample, Failure>,
) -> GnomonStatus {
    guard(|| {
        // SAFETY: the caller's promise.
        let sample_out = unsafe { output(sample_out, "sample_out") }?;
        for (name, number) in [("u", u), ("v", v)] {
            if !(0.0..=1.0).contains(&number) {
                return Err(Failure::invalid(format!("{name} is {number}, not in [0, 1]")));
            }
        }
        let sample = make()?;
        sample_out.write(GnomonDirectionSample {
            direction: sample.direction.as_vec3().to_array(),
            density_per_sr: sample.density_per_sr as f32,
        });
        Ok(())
    })
}
